#include "engine/io/image/picture_writer.h"

#include <filesystem>
#include <string>

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "engine/io/raster/gdal_dataset.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

Image made_rows(glm::ivec2 size, int first_row) {
    Image rows(size.x, size.y);
    for (int row = 0; row < size.y; ++row) {
        for (int col = 0; col < size.x; ++col) {
            const auto value = [&](int by) {
                return static_cast<std::uint8_t>((col * by + (first_row + row) * 7) % 256);
            };
            rows(col, row) = {value(1), value(3), value(5), 255};
        }
    }
    return rows;
}

class PictureWriterTest : public ::testing::TestWithParam<const char*> {
protected:
    [[nodiscard]] fs::path file() const { return folder_.path() / GetParam(); }

    test::TemporaryFolder folder_;
};

TEST_P(PictureWriterTest, WritesInBandsWhatIsReadAsOnePicture) {
    constexpr glm::ivec2 size{300, 700};
    auto writer = PictureWriter::create(file(), size);
    ASSERT_TRUE(writer) << writer.error().message;
    for (int row = 0; row < size.y; row += PictureWriter::tile.y) {
        const int rows = std::min(PictureWriter::tile.y, size.y - row);
        ASSERT_TRUE(writer->write(made_rows({size.x, rows}, row)));
    }
    EXPECT_FALSE(fs::exists(file()));
    auto finished = writer->finish();
    ASSERT_TRUE(finished) << finished.error().message;
    ASSERT_TRUE(finished->commit());
    const auto read = read_image(file());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_TRUE(std::ranges::equal(read->samples(), made_rows(size, 0).samples()));
}

TEST_P(PictureWriterTest, LeavesNothingOfAnUnfinishedPicture) {
    {
        auto writer = PictureWriter::create(file(), {300, 700});
        ASSERT_TRUE(writer);
        ASSERT_TRUE(writer->write(made_rows({300, 256}, 0)));
    }
    EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_P(PictureWriterTest, AFolderThatIsNotThereIsAnError) {
    const auto writer = PictureWriter::create(folder_.path() / "none" / GetParam(), {3, 3});
    ASSERT_FALSE(writer);
    EXPECT_THAT(writer.error().message, HasSubstr("none"));
}

INSTANTIATE_TEST_SUITE_P(Formats, PictureWriterTest, ::testing::Values("a.png", "a.tif", "A.TIFF"),
                         [](const auto& instance) {
                             std::string name = instance.param;
                             name[1] = '_';
                             return name;
                         });

TEST(PictureWriter, SizesThatAFormatCannotHoldAreErrors) {
    const test::TemporaryFolder folder;
    const auto error_of = [&](const char* name, glm::ivec2 size) {
        const auto writer = PictureWriter::create(folder.path() / name, size);
        return writer ? "" : writer.error().message;
    };
    EXPECT_THAT(error_of("a.png", {1'000'001, 1}), HasSubstr("a PNG of at most 1000000 a side"));
    EXPECT_THAT(error_of("a.tif", {2'000'000'000, 2'000'000'000}), HasSubstr("fewer tiles"));
    EXPECT_THAT(error_of("a.jpg", {10, 10}), HasSubstr(".png or .tif was expected"));
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

// The first bytes tell: 43 instead of 42.
TEST(PictureWriter, ATiffThatMayExceedFourGigabytesIsABigTiff) {
    const test::TemporaryFolder folder;
    for (const auto& [side, version] : {std::pair{512, 42}, std::pair{40'000, 43}}) {
        auto writer = PictureWriter::create(folder.path() / "a.tif", {side, side});
        ASSERT_TRUE(writer);
        ASSERT_TRUE(writer->write(Image(side, 256)));
        for (const auto& entry : fs::directory_iterator(folder.path())) {
            EXPECT_EQ(test::read_bytes(entry.path()).substr(0, 3),
                      std::string("II") + static_cast<char>(version));
        }
    }
}

} // namespace
} // namespace reljef::io
