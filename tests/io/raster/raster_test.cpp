#include "engine/io/raster/raster.h"
#include "engine/io/terrain_file.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using test::joined;
using test::made_raster;
using test::MadeRaster;
using test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::Not;

double wave(int col, int row) {
    return 100.0 + 3.0 * col - 7.0 * row + ((col * 31 + row * 17) % 11);
}

class Raster : public ::testing::Test {
protected:
    [[nodiscard]] std::filesystem::path made(const MadeRaster& raster,
                                             const std::string& name = "made.tif") const {
        EXPECT_TRUE(test::write(raster, folder_.path() / name));
        return folder_.path() / name;
    }
    [[nodiscard]] terrain::Terrain read(const MadeRaster& raster,
                                        const RasterOptions& options = {}) const {
        auto terrain = read_terrain(made(raster), options);
        EXPECT_TRUE(terrain) << (terrain ? "" : terrain.error().message);
        return terrain ? std::move(*terrain) : terrain::Terrain{};
    }

    TemporaryFolder folder_;
};

TEST_F(Raster, EveryTypeOfNumberIsReadExactly) {
    for (const GDALDataType type :
         {GDT_Byte, GDT_Int16, GDT_UInt16, GDT_Int32, GDT_UInt32, GDT_Float32, GDT_Float64}) {
        MadeRaster raster = made_raster(7, 5, [](int col, int row) { return 10 * row + col; });
        raster.type = type;
        const terrain::Terrain terrain = read(raster);
        ASSERT_EQ(terrain.heightfield.heights.cols(), 7);
        ASSERT_EQ(terrain.heightfield.heights.rows(), 5);
        for (int row = 0; row < 5; ++row) {
            for (int col = 0; col < 7; ++col) {
                ASSERT_EQ(terrain.heightfield.heights(col, row),
                          static_cast<float>(10 * row + col));
            }
        }
        EXPECT_EQ(terrain.heightfield.range.low, 0.0);
        EXPECT_EQ(terrain.heightfield.range.high, 46.0);
        EXPECT_TRUE(terrain.heightfield.void_mask.empty());
        EXPECT_EQ(terrain.name, "made.tif");
    }
}

TEST_F(Raster, ComplexNumbersAreNoHeights) {
    MadeRaster raster = made_raster(4, 4, wave);
    raster.type = GDT_CFloat32;
    const auto terrain = read_terrain(made(raster));
    ASSERT_FALSE(terrain);
    EXPECT_THAT(terrain.error().message, HasSubstr("real numbers were expected"));
}

TEST_F(Raster, ScaleOffsetAndUnitLeadToMetres) {
    MadeRaster raster = made_raster(4, 4, wave);
    raster.scale = 0.5;
    raster.offset = 20.0;
    raster.unit = "ft";
    const terrain::Terrain terrain = read(raster);
    EXPECT_FLOAT_EQ(terrain.heightfield.heights(2, 1),
                    static_cast<float>((wave(2, 1) * 0.5 + 20.0) * 0.3048));
}

TEST_F(Raster, UnitsOfHeightAreKnownByTheirNames) {
    const std::vector<std::pair<std::string, double>> units{
        {"m", 1.0},       {"metre", 1.0},
        {"ft", 0.3048},   {"US survey foot", 1200.0 / 3937.0},
        {"Feet", 0.3048}, {"ftUS", 1200.0 / 3937.0},
        {"cm", 0.01}};
    for (const auto& [name, metres] : units) {
        MadeRaster raster = made_raster(2, 2, [](int, int) { return 5000.0; });
        raster.unit = name;
        EXPECT_FLOAT_EQ(read(raster).heightfield.heights(0, 0), static_cast<float>(5000.0 * metres))
            << name;
    }
}

TEST_F(Raster, AnUnknownUnitIsTold) {
    MadeRaster raster = made_raster(2, 2, [](int, int) { return 5.0; });
    raster.unit = "furlong";
    const terrain::Terrain terrain = read(raster);
    EXPECT_EQ(terrain.heightfield.heights(0, 0), 5.0F);
    EXPECT_THAT(joined(terrain.notes), HasSubstr("\"furlong\" is unknown"));
}

TEST_F(Raster, HeightScaleAndOffsetAreApplied) {
    RasterOptions options;
    options.height_scale = 0.1;
    options.height_offset = -50.0;
    options.spacing = 12.5;
    const terrain::Terrain terrain = read(made_raster(4, 4, wave), options);
    EXPECT_FLOAT_EQ(terrain.heightfield.heights(3, 2), static_cast<float>(wave(3, 2) * 0.1 - 50.0));
    EXPECT_EQ(terrain.heightfield.spacing, glm::dvec2(12.5));
}

TEST_F(Raster, WithoutAPlaceSpacingIsAMetreAndTold) {
    const terrain::Terrain terrain =
        read(made_raster(21, 9, [](int col, int) { return 0.5 * col; }));
    EXPECT_EQ(terrain.heightfield.spacing, glm::dvec2(1.0));
    EXPECT_FALSE(terrain.heightfield.georeference);
    EXPECT_THAT(joined(terrain.notes), HasSubstr("no coordinate system: 1 m spacing assumed"));
}

TEST_F(Raster, SpacingThatIsNoneIsRefused) {
    for (const double spacing : {1e-300, 0.0, -1.0, 1e300, std::nan("")}) {
        RasterOptions options;
        options.spacing = spacing;
        ASSERT_TRUE(test::write(made_raster(4, 4, wave), folder_.path() / "a.tif"));
        EXPECT_FALSE(read_terrain(folder_.path() / "a.tif", options)) << spacing;
    }
}

TEST_F(Raster, WithoutAPlaceReliefIsNoSpike) {
    const MadeRaster steep = made_raster(21, 9, [](int col, int) { return 123.4 * col; });
    const terrain::Terrain terrain = read(steep);
    EXPECT_DOUBLE_EQ(terrain.heightfield.spacing.x, 1200.0);
    EXPECT_DOUBLE_EQ(terrain.heightfield.spacing.y, 1200.0);
    EXPECT_THAT(joined(terrain.notes), HasSubstr("1200 m spacing assumed, which makes the relief "
                                                 "of 2468 m a tenth of the width"));
    RasterOptions told;
    told.spacing = 1.0;
    EXPECT_EQ(read(steep, told).heightfield.spacing, glm::dvec2(1.0));
}

TEST_F(Raster, DeclaredVoidsAreMaskedFilledAndCountedWithoutAWord) {
    for (const double nodata : {-9999.0, 0.1, -3.4028234663852886e38, std::nan("")}) {
        MadeRaster raster = made_raster(20, 20, [](int, int) { return 500.0; });
        raster.nodata = nodata;
        raster.values[5 * 20 + 7] = nodata;
        raster.values[5 * 20 + 8] = nodata;
        const terrain::Terrain terrain = read(raster);
        EXPECT_EQ(terrain.heightfield.void_count, 2U);
        EXPECT_EQ(terrain.heightfield.void_mask(7, 5), 1);
        EXPECT_EQ(terrain.heightfield.void_mask(6, 5), 0);
        EXPECT_NEAR(terrain.heightfield.heights(7, 5), 500.0F, 0.01F);
        EXPECT_EQ(terrain.heightfield.range.low, 500.0);
        EXPECT_EQ(joined(terrain.notes).find("void"), std::string::npos) << nodata;
    }
}

TEST_F(Raster, UndeclaredVoidsAreFoundAndTold) {
    MadeRaster raster = made_raster(20, 20, wave);
    raster.values[3] = -32768.0;
    raster.values[4] = -32767.0;
    raster.values[5] = std::nan("");
    raster.values[6] = std::numeric_limits<double>::infinity();
    raster.values[7] = -std::numeric_limits<double>::infinity();
    const terrain::Terrain terrain = read(raster);
    EXPECT_EQ(terrain.heightfield.void_count, 5U);
    EXPECT_THAT(joined(terrain.notes), HasSubstr("1 sample is -32768 and 1 sample is -32767"));
    EXPECT_THAT(joined(terrain.notes), HasSubstr("3 samples are NaN or infinite"));
    for (const float height : terrain.heightfield.heights.samples()) {
        ASSERT_TRUE(std::isfinite(height));
        ASSERT_GT(height, -500.0F);
    }
}

TEST_F(Raster, NanInAnAsciiGridOfWholeNumbersIsAVoid) {
    const auto terrain = read_terrain(folder_.write(
        "nan.asc", "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2 3\n4 nan 6"));
    ASSERT_TRUE(terrain) << terrain.error().message;
    EXPECT_EQ(terrain->heightfield.void_count, 1U);
    EXPECT_EQ(terrain->heightfield.void_mask(1, 1), 1);
    EXPECT_EQ(terrain->heightfield.heights(2, 1), 6.0F);
    EXPECT_EQ(terrain->heightfield.range.low, 1.0);
}

TEST_F(Raster, HeightsThatNothingHasAreVoids) {
    MadeRaster raster = made_raster(20, 20, wave);
    raster.values[3] = -3.4028234663852886e38;
    raster.values[4] = 3.4e38;
    raster.values[5] = 1e9;
    const terrain::Terrain terrain = read(raster);
    EXPECT_EQ(terrain.heightfield.void_count, 3U);
    EXPECT_THAT(joined(terrain.notes), HasSubstr("3 samples are beyond"));
    EXPECT_LT(terrain.heightfield.range.high, 1e4);
}

TEST_F(Raster, TheUsualVoidThatNobodyDeclaresIsAVoidFarBelowTheLand) {
    MadeRaster raster = made_raster(20, 20, wave);
    raster.values[3] = -9999.0;
    const terrain::Terrain undeclared = read(raster);
    EXPECT_THAT(joined(undeclared.notes),
                HasSubstr("1 sample is -9999, which " + (folder_.path() / "made.tif").string() +
                          " does not declare: taken for voids"));
    EXPECT_EQ(undeclared.heightfield.void_count, 1U);
    EXPECT_GT(undeclared.heightfield.range.low, -1000.0);
    raster.nodata = -9999.0;
    EXPECT_THAT(joined(read(raster).notes), Not(HasSubstr("-9999")));
}

TEST_F(Raster, OnTheSlopeOfATrenchTheUsualVoidIsAHeight) {
    const MadeRaster raster =
        made_raster(20, 20, [](int col, int row) { return -9990.0 - 3.0 * (col + row); });
    const terrain::Terrain terrain = read(raster);
    EXPECT_EQ(terrain.heightfield.void_count, 0U);
    EXPECT_EQ(terrain.heightfield.heights(3, 0), -9999.0F);
    EXPECT_THAT(joined(terrain.notes), HasSubstr("4 samples are -9999"));
    EXPECT_THAT(joined(terrain.notes), HasSubstr("not declare as void: taken for heights"));
}

TEST_F(Raster, ScaledValuesHaveNoUndeclaredVoids) {
    MadeRaster raster = made_raster(4, 4, [](int, int) { return -32768.0; });
    raster.type = GDT_Int16;
    raster.scale = 0.01;
    raster.offset = 1000.0;
    const terrain::Terrain terrain = read(raster);
    EXPECT_EQ(terrain.heightfield.void_count, 0U);
    EXPECT_NEAR(terrain.heightfield.heights(0, 0), 672.32F, 1e-3F);
}

TEST_F(Raster, FarBelowAndAboveAreHeightsLikeOthers) {
    MadeRaster raster = made_raster(4, 4, wave);
    raster.values[0] = -2.5e6;
    raster.values[1] = 3.0e7;
    const terrain::Terrain terrain = read(raster);
    EXPECT_EQ(terrain.heightfield.void_count, 0U);
    EXPECT_EQ(terrain.heightfield.heights(0, 0), -2.5e6F);
    EXPECT_EQ(terrain.heightfield.heights(1, 0), 3.0e7F);
}

TEST_F(Raster, TransparentSamplesAreVoids) {
    MadeRaster raster = made_raster(5, 4, wave);
    raster.bands = 2;
    raster.type = GDT_Byte;
    raster.colors = {GCI_GrayIndex, GCI_AlphaBand};
    for (int i = 0; i < 20; ++i) {
        raster.values.push_back(i == 6 ? 0.0 : 255.0);
    }
    const terrain::Terrain terrain = read(raster);
    EXPECT_EQ(terrain.heightfield.void_count, 1U);
    EXPECT_EQ(terrain.heightfield.void_mask(1, 1), 1);
}

TEST_F(Raster, APaletteGivesItsLuminance) {
    MadeRaster raster = made_raster(3, 2, [](int col, int) { return col; });
    raster.type = GDT_Byte;
    raster.palette = {{0, 0, 0, 255}, {200, 200, 200, 255}, {255, 0, 0, 255}};
    const terrain::Terrain terrain = read(raster);
    EXPECT_EQ(terrain.heightfield.heights(0, 0), 0.0F);
    EXPECT_EQ(terrain.heightfield.heights(1, 0), 200.0F);
    EXPECT_FLOAT_EQ(terrain.heightfield.heights(2, 1), 255.0F * 0.299F);
    EXPECT_THAT(joined(terrain.notes), HasSubstr("palette"));
}

TEST_F(Raster, AGreyPaletteIsItsIndices) {
    MadeRaster raster = made_raster(3, 2, [](int col, int row) { return 100 * row + col; });
    raster.type = GDT_Byte;
    for (short i = 0; i < 256; ++i) {
        raster.palette.push_back({i, i, i, 255});
    }
    const terrain::Terrain terrain = read(raster);
    EXPECT_EQ(terrain.heightfield.heights(2, 1), 102.0F);
    EXPECT_EQ(joined(terrain.notes).find("palette"), std::string::npos);
}

TEST_F(Raster, ColoursGiveTheirLuminanceAndGreysThemselves) {
    MadeRaster raster = made_raster(2, 2, [](int, int) { return 77.0; });
    raster.type = GDT_Byte;
    raster.bands = 3;
    raster.values = {77, 255, 0, 0, 77, 0, 255, 0, 77, 0, 0, 255};
    raster.colors = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand};
    const terrain::Terrain terrain = read(raster);
    EXPECT_EQ(terrain.heightfield.heights(0, 0), 77.0F);
    EXPECT_FLOAT_EQ(terrain.heightfield.heights(1, 0), 255.0F * 0.299F);
    EXPECT_FLOAT_EQ(terrain.heightfield.heights(0, 1), 255.0F * 0.587F);
    EXPECT_FLOAT_EQ(terrain.heightfield.heights(1, 1), 255.0F * 0.114F);
}

TEST_F(Raster, WindowsAreThatPartOfTheRaster) {
    RasterOptions options;
    options.window = RasterOptions::Window{10, 4, 6, 5};
    const terrain::Terrain terrain = read(made_raster(30, 20, wave), options);
    ASSERT_EQ(terrain.heightfield.heights.cols(), 6);
    ASSERT_EQ(terrain.heightfield.heights.rows(), 5);
    for (int row = 0; row < 5; ++row) {
        for (int col = 0; col < 6; ++col) {
            ASSERT_EQ(terrain.heightfield.heights(col, row),
                      static_cast<float>(wave(col + 10, row + 4)));
        }
    }
}

TEST_F(Raster, AWindowOutsideIsAnError) {
    const auto path = made(made_raster(30, 20, wave));
    constexpr int most = std::numeric_limits<int>::max();
    for (const RasterOptions::Window window : {RasterOptions::Window{-1, 0, 5, 5},
                                               {26, 0, 5, 5},
                                               {0, 18, 5, 3},
                                               {0, 0, 1, 5},
                                               {0, 0, 0, 0},
                                               {0, 0, -4, 4},
                                               {5, 5, most, most},
                                               {most, most, 2, 2}}) {
        RasterOptions options;
        options.window = window;
        const auto terrain = read_terrain(path, options);
        ASSERT_FALSE(terrain);
        EXPECT_THAT(terrain.error().message, HasSubstr("window"));
        EXPECT_THAT(terrain.error().message, HasSubstr("30×20"));
    }
}

TEST_F(Raster, OverBudgetItIsTheAverageAtTheFinestReductionThatFits) {
    RasterOptions options;
    options.memory_budget = 21 * 14 * bytes_per_sample; // 64×43 samples: 1/3 is 21×14
    options.spacing = 1.0;
    const terrain::Terrain terrain = read(made_raster(64, 43, wave), options);
    ASSERT_EQ(terrain.heightfield.heights.cols(), 21);
    ASSERT_EQ(terrain.heightfield.heights.rows(), 14);
    EXPECT_EQ(terrain.heightfield.spacing, glm::dvec2(3.0));
    EXPECT_THAT(joined(terrain.notes), HasSubstr("64×43"));
    EXPECT_THAT(joined(terrain.notes), HasSubstr("read at 1/3 (21×14)"));
    for (int row = 0; row < 14; ++row) {
        for (int col = 0; col < 21; ++col) {
            double sum = 0.0;
            for (int i = 0; i < 9; ++i) {
                sum += wave(3 * col + i % 3, 3 * row + i / 3);
            }
            ASSERT_NEAR(terrain.heightfield.heights(col, row), sum / 9.0, 1e-4);
        }
    }
}

TEST_F(Raster, ReductionLeavesVoidsOutOfItsAverages) {
    MadeRaster raster = made_raster(40, 40, [](int, int) { return 1000.0; });
    std::mt19937 random(3);
    for (double& value : raster.values) {
        if (random() % 2 == 0) {
            value = random() % 2 == 0 ? -32768.0 : -9999.0;
        }
    }
    raster.nodata = -9999.0;
    RasterOptions options;
    options.memory_budget = 20 * 20 * bytes_per_sample;
    const terrain::Terrain terrain = read(raster, options);
    ASSERT_EQ(terrain.heightfield.heights.cols(), 20);
    EXPECT_GT(terrain.heightfield.void_count, 0U);
    for (const float height : terrain.heightfield.heights.samples()) {
        ASSERT_NEAR(height, 1000.0F, 0.01F);
    }
}

TEST_F(Raster, OverviewsAreUsedAndKeepTheirPlace) {
    MadeRaster raster = made_raster(256, 256, [](int col, int row) { return col + 2.0 * row; });
    raster.options = {"TILED=YES", "BLOCKXSIZE=64", "BLOCKYSIZE=64"};
    raster.overviews = {2, 4};
    raster.crs = "EPSG:32631";
    raster.geotransform = {500000.0, 10.0, 0.0, 5100000.0, 0.0, -10.0};
    RasterOptions options;
    options.memory_budget = 64 * 64 * bytes_per_sample;
    const terrain::Terrain terrain = read(raster, options);
    ASSERT_EQ(terrain.heightfield.heights.cols(), 64);
    EXPECT_EQ(terrain.heightfield.spacing, glm::dvec2(40.0));
    const geo::PixelAffine& affine = terrain.heightfield.georeference->crs_from_pixel;
    EXPECT_DOUBLE_EQ(affine.x0, 500020.0);
    EXPECT_DOUBLE_EQ(affine.y0, 5099980.0);
    EXPECT_DOUBLE_EQ(affine.x_col, 40.0);
    for (int row = 0; row < 64; ++row) {
        for (int col = 0; col < 64; ++col) {
            ASSERT_NEAR(terrain.heightfield.heights(col, row),
                        4.0 * col + 1.5 + 2.0 * (4.0 * row + 1.5), 1e-3);
        }
    }
}

TEST_F(Raster, OverviewsOfAWindowKeepTheirPlace) {
    MadeRaster raster = made_raster(256, 256, [](int col, int row) { return col + 2.0 * row; });
    raster.overviews = {2, 4};
    RasterOptions options;
    options.memory_budget = 32 * 32 * bytes_per_sample;
    options.window = RasterOptions::Window{99, 50, 130, 129};
    options.spacing = 1.0;
    const terrain::Terrain terrain = read(raster, options);
    EXPECT_LE(terrain.heightfield.heights.size(), 32U * 32U);
    // sample (0,0) is the middle of the first whole 4×4 block at or after (99, 50)
    EXPECT_NEAR(terrain.heightfield.heights(0, 0), 101.5 + 2.0 * 53.5, 1e-3);
    EXPECT_NEAR(terrain.heightfield.heights(1, 0) - terrain.heightfield.heights(0, 0), 4.0, 1e-3);
}

TEST_F(Raster, ATinyBudgetIsAnError) {
    RasterOptions options;
    options.memory_budget = 3 * bytes_per_sample;
    const auto terrain = read_terrain(made(made_raster(64, 43, wave)), options);
    ASSERT_FALSE(terrain);
    EXPECT_THAT(terrain.error().message, HasSubstr("64×43"));
}

TEST_F(Raster, ProgressGrowsToTheEnd) {
    std::vector<double> seen;
    RasterOptions options;
    options.progress = [&](double fraction) { seen.push_back(fraction); };
    static_cast<void>(read(made_raster(2100, 2100, [](int col, int) { return col; }), options));
    ASSERT_GT(seen.size(), 1U);
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_DOUBLE_EQ(seen.back(), 1.0);
}

TEST_F(Raster, AStopIsObeyed) {
    const auto path = made(made_raster(300, 200, wave));
    std::stop_source source;
    source.request_stop();
    RasterOptions options;
    options.stop = source.get_token();
    const auto terrain = read_terrain(path, options);
    ASSERT_FALSE(terrain);
    EXPECT_THAT(terrain.error().message, HasSubstr("stopped"));
}

TEST_F(Raster, NothingIsWrittenBesideTheFile) {
    MadeRaster raster = made_raster(300, 300, wave);
    raster.format = "PNG";
    raster.type = GDT_UInt16;
    const auto path = made(raster, "made.png");
    std::filesystem::remove(path.string() + ".aux.xml");
    ASSERT_EQ(folder_.names(), std::vector<std::string>{"made.png"});
    RasterOptions options;
    options.imagery = {path};
    options.memory_budget = 1 << 20;
    ASSERT_TRUE(read_terrain(path, options));
    ASSERT_TRUE(read_raster_info(path));
    EXPECT_EQ(folder_.names(), std::vector<std::string>{"made.png"});
}

TEST_F(Raster, NothingIsPrinted) {
    folder_.write("cut.tif", std::string("II*\0\x08\0\0\0\x01", 9));
    ::testing::internal::CaptureStderr();
    EXPECT_FALSE(read_terrain(folder_.path() / "cut.tif"));
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(Raster, ManyThreadsReadAtOnce) {
    const auto path = made(made_raster(200, 100, wave));
    std::vector<std::jthread> threads;
    std::array<bool, 8> good{};
    threads.reserve(good.size());
    for (bool& result : good) {
        threads.emplace_back([&path, &result] {
            const auto terrain = read_terrain(path);
            result = terrain &&
                     terrain->heightfield.heights(150, 50) == static_cast<float>(wave(150, 50));
        });
    }
    threads.clear();
    for (const bool result : good) {
        EXPECT_TRUE(result);
    }
}

TEST_F(Raster, InfoTellsWhatTheFileSays) {
    MadeRaster raster = made_raster(9, 6, wave);
    raster.type = GDT_Int32;
    raster.crs = "EPSG:2253";
    raster.geotransform = {13292817.31, 2.0, 0.0, 283377.05, 0.0, -2.0};
    const auto info = read_raster_info(made(raster));
    ASSERT_TRUE(info);
    EXPECT_EQ(info->cols, 9);
    EXPECT_EQ(info->rows, 6);
    EXPECT_EQ(info->format, "GTiff");
    EXPECT_EQ(info->type, "Int32");
    EXPECT_EQ(info->crs_name, "NAD83 / Michigan South (ft)");
}

} // namespace
} // namespace reljef::io
