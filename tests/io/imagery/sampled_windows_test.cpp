#include "engine/io/imagery/rgb_image.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include <cpl_string.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/grid.h"
#include "engine/io/imagery/imagery_set.h"
#include "engine/io/raster/gdal_dataset.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;

TEST(SampledWindows, AreSmallAndFewWhateverTheBlocks) {
    for (const glm::ivec2 size : {glm::ivec2(1),
                                  {7, 30000},
                                  {30000, 7},
                                  {30000, 30000},
                                  {2000000000, 3},
                                  {400000, 400000}}) {
        for (const glm::ivec2 block : {glm::ivec2(1),
                                       {256, 256},
                                       {1024, 1024},
                                       {size.x, 1},
                                       {1, size.y},
                                       size,
                                       {2000000000, 2000000000}}) {
            double pixels = 0.0;
            for (const PixelWindow& window : sampled_windows(size, block)) {
                const double area = static_cast<double>(window.size.x) * window.size.y;
                ASSERT_GE(std::min(window.size.x, window.size.y), 1);
                ASSERT_LE(area, max_window_pixels);
                ASSERT_LE(window.first.x, size.x - window.size.x);
                ASSERT_LE(window.first.y, size.y - window.size.y);
                pixels += area;
            }
            EXPECT_GE(pixels, 1.0);
            EXPECT_LE(pixels, max_sampled_pixels + max_window_pixels);
        }
    }
}

TEST(SampledWindows, AreAllOfASmallImage) {
    const glm::ivec2 size(170, 150);
    for (const glm::ivec2 block : {glm::ivec2(64), {170, 1}, {170, 150}, {64, 150}, {3, 5}}) {
        Grid<int> seen(size.x, size.y);
        for (const PixelWindow& window : sampled_windows(size, block)) {
            for (int row = 0; row < window.size.y; ++row) {
                for (int col = 0; col < window.size.x; ++col) {
                    ++seen(window.first.x + col, window.first.y + row);
                }
            }
        }
        EXPECT_THAT(seen.samples(), ::testing::Each(1)) << block.x;
    }
}

/// One value everywhere; counts the pixels that are read.
class CountedBand : public GDALRasterBand {
public:
    CountedBand(GDALDataset& image, GDALColorInterp meaning, std::size_t& pixels)
        : meaning_(meaning), pixels_(pixels) {
        poDS = &image;
        eDataType = GDT_UInt16;
        nRasterXSize = image.GetRasterXSize();
        nRasterYSize = image.GetRasterYSize();
        nBlockXSize = side;
        nBlockYSize = side;
    }
    GDALColorInterp GetColorInterpretation() override { return meaning_; }

protected:
    CPLErr IReadBlock(int /*col*/, int /*row*/, void* pixels) override {
        std::fill_n(static_cast<std::uint16_t*>(pixels), side * side, std::uint16_t{255});
        pixels_ += static_cast<std::size_t>(side) * side;
        return CE_None;
    }

private:
    static constexpr int side = 256; // of a block, pixels

    GDALColorInterp meaning_;
    std::size_t& pixels_;
};

class CountedImage : public GDALDataset {
public:
    explicit CountedImage(int side) {
        nRasterXSize = side;
        nRasterYSize = side;
        for (const auto meaning : {GCI_RedBand, GCI_GreenBand, GCI_BlueBand}) {
            SetBand(GetRasterCount() + 1, new CountedBand(*this, meaning, pixels)); // GDAL's
        }
    }

    std::size_t pixels = 0; ///< read so far
};

TEST(SampledWindows, AreAllThatIsReadForTheWhiteOfAHugeImageInDeepColours) {
    CountedImage vast(400'000);
    EXPECT_EQ(white_of(vast), 255.0);
    EXPECT_GT(vast.pixels, 3U * max_sampled_pixels / 2U);
    EXPECT_LE(vast.pixels, 3U * (max_sampled_pixels + max_window_pixels));
}

// 1.8 GB a block, out of a few hundred bytes.
TEST(ImagerySet, LeavesOutAnImageOfHugeBlocksWithoutReadingThem) {
    test::TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "huge.tif";
    register_drivers();
    CPLStringList options;
    for (const char* option : {"SPARSE_OK=TRUE", "INTERLEAVE=BAND", "BLOCKYSIZE=30000"}) {
        options.AddString(option);
    }
    Dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(path.c_str(), 30000, 30000, 3,
                                                                     GDT_UInt16, options.List()));
    ASSERT_LT(std::filesystem::file_size(path), 10000U);
    const auto set = ImagerySet::open(std::vector{path}, {"", {}, {9, 9}});
    ASSERT_FALSE(set);
    EXPECT_THAT(set.error().message, HasSubstr("blocks of 30000×30000"));
}

} // namespace
} // namespace reljef::io
