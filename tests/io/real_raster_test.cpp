#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/raster/raster.h"
#include "engine/io/terrain_file.h"
#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef::io {
namespace {

constexpr double survey_foot = 1200.0 / 3937.0;

/// What a file of the test data is known to hold; heights in metres.
struct Known {
    std::string file;
    int cols = 0;
    int rows = 0;
    double low = 0.0;
    double high = 0.0;
    std::size_t voids = 0;
    std::string crs_code;    ///< empty: no place
    glm::dvec2 spacing{0.0}; ///< 0: degrees
    std::string inner;       ///< name within a .zip
};

std::ostream& operator<<(std::ostream& stream, const Known& known) {
    return stream << known.file;
}

const std::vector<Known> known_files{
    {"natural/srtm3/N44E006.hgt", 1201, 1201, 405, 3997, 0, "EPSG:4326", {}, ""},
    {"natural/srtm3/N44E007.hgt", 1201, 1201, 128, 3795, 0, "EPSG:4326", {}, ""},
    {"natural/srtm3/N45E006.hgt", 1201, 1201, 236, 4672, 0, "EPSG:4326", {}, ""},
    {"natural/srtm3/N45E007.hgt", 1201, 1201, 156, 4530, 0, "EPSG:4326", {}, ""},
    {"natural/srtm3/N49E001.hgt", 1201, 1201, -16, 256, 19088, "EPSG:4326", {}, ""},
    {"natural/srtm3/N22W160v2.3a.hgt.zip",
     1201,
     1201,
     -34,
     1579,
     4279,
     "EPSG:4326",
     {},
     "N22W160.hgt"},
    {"natural/mt_rainier_90m.tif", 1201, 1201, 263, 4371, 9033, "EPSG:4326", {}, ""},
    {"natural/derived/mt_rainier_90m_cog.tif", 1201, 1201, 263, 4371, 9033, "EPSG:4326", {}, ""},
    {"natural/craterlake-elev-16bit-30m.tif", 429, 279, 1289, 1880, 39489, "EPSG:4326", {}, ""},
    {"natural/sba_elev32_wgs84_512x512.tif", 512, 512, 2.53, 20.73, 0, "EPSG:4326", {}, ""},
    {"natural/SainteHelens.dem", 327, 468, 682, 2543, 4151, "EPSG:26710", {30, 30}, ""},
    {"natural/derived/sthelens.ter", 200, 340, 858, 2543, 0, "", {30, 30}, ""},
    {"natural/derived/sthelens.hf2", 200, 340, 858, 2543, 0, "EPSG:26710", {30, 30}, ""},
    {"natural/derived/sthelens_ftUS_compound_crs.tif",
     200,
     340,
     2814.95 * survey_foot,
     8343.15 * survey_foot,
     0,
     "EPSG:26710",
     {30, 30},
     ""},
    {"natural/springcreek_30m.asc", 272, 260, 1875.27, 2611.01, 40899, "", {30, 30}, ""},
    {"natural/n00_e006_3arc_v2.dt1", 1201, 1201, -7, 1979, 4072, "EPSG:4326", {}, ""},
    {"natural/luxembourg_elev.tif", 95, 90, 141, 547, 3942, "EPSG:4326", {}, ""},
    {"natural/png16_height_1024.png", 1024, 1024, 0, 65535, 0, "", {640, 640}, ""},
    {"natural/derived/n45e006_513_metres.pgm", 513, 513, 236, 3003, 0, "", {54, 54}, ""},
    {"natural/irrlicht_terrain-heightmap.bmp", 256, 256, 1, 251, 0, "", {9.8, 9.8}, ""},
    {"urban/delft/tud-dsm-5m.tif", 722, 386, -5.39, 92.08, 0, "EPSG:28992", {5, 5}, ""},
    {"urban/delft/tud-dtm-5m.tif", 722, 386, -5.895, 16.28, 0, "EPSG:28992", {5, 5}, ""},
    {"urban/annarbor/test_dsm.tif", 786, 868, 254, 300.34, 0, "EPSG:2253", {0.6096, 0.6096}, ""},
    {"urban/annarbor/test_dtm.tif", 786, 868, 254, 268, 0, "EPSG:2253", {0.6096, 0.6096}, ""},
};

struct Closer {
    void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using OpenDataset = std::unique_ptr<GDALDataset, Closer>;

OpenDataset open(const Known& known) {
    GDALAllRegister();
    std::string path = test::data_path(known.file).string();
    if (!known.inner.empty()) {
        path = "/vsizip/{" + path + "}/" + known.inner;
    }
    return OpenDataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
}

class RealRaster : public ::testing::TestWithParam<Known> {
protected:
    const test::QuietGdal quiet_;
};

TEST_P(RealRaster, HasItsKnownSizeRangeVoidsAndSpacing) {
    const Known& known = GetParam();
    RELJEF_NEED_DATA(known.file);
    const auto terrain = read_terrain(test::data_path(known.file));
    ASSERT_TRUE(terrain) << terrain.error().message;
    const terrain::Heightfield& heightfield = terrain->heightfield;
    EXPECT_EQ(heightfield.heights.cols(), known.cols);
    EXPECT_EQ(heightfield.heights.rows(), known.rows);
    EXPECT_NEAR(heightfield.range.low, known.low, 0.03);
    EXPECT_NEAR(heightfield.range.high, known.high, 0.03);
    EXPECT_EQ(heightfield.void_count, known.voids);
    EXPECT_EQ(heightfield.georeference ? heightfield.georeference->crs_code : "", known.crs_code);
    if (known.spacing.x > 0.0) {
        EXPECT_NEAR(heightfield.spacing.x, known.spacing.x, 1e-9);
        EXPECT_NEAR(heightfield.spacing.y, known.spacing.y, 1e-9);
    }
    for (const float height : heightfield.heights.samples()) { // no spikes where voids are filled
        ASSERT_GE(height, heightfield.range.low - 1e-3);
        ASSERT_LE(height, heightfield.range.high + 1e-3);
    }
}

TEST_P(RealRaster, HeightsAreGdalsAtRandomPlaces) {
    const Known& known = GetParam();
    RELJEF_NEED_DATA(known.file);
    const auto terrain = read_terrain(test::data_path(known.file));
    ASSERT_TRUE(terrain);
    const OpenDataset dataset = open(known);
    ASSERT_NE(dataset, nullptr);
    GDALRasterBand& band = *dataset->GetRasterBand(1);
    const double unit = std::string(band.GetUnitType()) == "US survey foot" ? survey_foot : 1.0;
    std::vector<double> values(static_cast<std::size_t>(known.cols) *
                               static_cast<std::size_t>(known.rows));
    ASSERT_EQ(band.RasterIO(GF_Read, 0, 0, known.cols, known.rows, values.data(), known.cols,
                            known.rows, GDT_Float64, 0, 0, nullptr),
              CE_None);
    std::mt19937 random(1);
    for (int i = 0; i < 10000; ++i) {
        const std::size_t index = random() % values.size();
        const double value = values[index];
        const int col = static_cast<int>(index % static_cast<std::size_t>(known.cols));
        const int row = static_cast<int>(index / static_cast<std::size_t>(known.cols));
        const terrain::Heightfield& heightfield = terrain->heightfield;
        const bool is_void = value == -32768 || value == -32767 || value == -9999;
        ASSERT_EQ(!heightfield.void_mask.empty() && heightfield.void_mask(col, row) != 0, is_void)
            << col << "," << row;
        if (!is_void) {
            const double metres = (value * band.GetScale() + band.GetOffset()) * unit;
            ASSERT_EQ(heightfield.heights(col, row), static_cast<float>(metres));
        }
    }
}

class PlacedRaster : public RealRaster {};

TEST_P(PlacedRaster, CornersAreWhereGdaltransformPutsThem) {
    const Known& known = GetParam();
    RELJEF_NEED_DATA(known.file);
    const auto terrain = read_terrain(test::data_path(known.file));
    ASSERT_TRUE(terrain);
    const OpenDataset dataset = open(known);
    ASSERT_NE(dataset, nullptr);
    ASSERT_TRUE(terrain->heightfield.georeference);
    CPLStringList options;
    options.SetNameValue("DST_SRS", "EPSG:4326");
    const std::unique_ptr<void, decltype(&GDALDestroyGenImgProjTransformer)> transformer(
        GDALCreateGenImgProjTransformer2(dataset.get(), nullptr, options.List()),
        &GDALDestroyGenImgProjTransformer);
    ASSERT_NE(transformer, nullptr);
    const geo::GeodeticMap& map = terrain->heightfield.georeference->geodetic;
    for (const glm::dvec2 corner :
         {glm::dvec2(0.0, 0.0), glm::dvec2(known.cols, 0.0), glm::dvec2(0.0, known.rows),
          glm::dvec2(known.cols, known.rows), glm::dvec2(0.37 * known.cols, 0.61 * known.rows)}) {
        double x = corner.x;
        double y = corner.y;
        double z = 0.0;
        int done = 0;
        ASSERT_TRUE(GDALGenImgProjTransform(transformer.get(), FALSE, 1, &x, &y, &z, &done));
        const glm::dvec2 found = map.latitude_longitude(corner - 0.5);
        EXPECT_LT(geo::geodesic_distance({found.x, found.y, 0.0}, {y, x, 0.0}), 1e-3)
            << corner.x << "," << corner.y;
    }
}

std::string name_of(const ::testing::TestParamInfo<Known>& parameter) {
    std::string name = std::filesystem::path(parameter.param.file).filename().string();
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
}

/// Those whose CRS GDAL reads; that of Santa Barbara's heights is broken.
std::vector<Known> placed_files() {
    std::vector<Known> files;
    std::copy_if(
        known_files.begin(), known_files.end(), std::back_inserter(files), [](const Known& known) {
            return !known.crs_code.empty() && known.file.find("sba_elev32") == std::string::npos;
        });
    return files;
}

INSTANTIATE_TEST_SUITE_P(Files, RealRaster, ::testing::ValuesIn(known_files), name_of);
INSTANTIATE_TEST_SUITE_P(Files, PlacedRaster, ::testing::ValuesIn(placed_files()), name_of);

TEST(RealRasters, MontBlancStandsWhereItShould) {
    RELJEF_NEED_DATA("natural/srtm3/N45E006.hgt");
    const auto terrain = read_terrain(test::data_path("natural/srtm3/N45E006.hgt"));
    ASSERT_TRUE(terrain);
    const auto sample = terrain->heightfield.georeference->geodetic.sample(45.8326, 6.8652);
    ASSERT_TRUE(sample);
    double highest = 0.0;
    for (int i = -3; i <= 3; ++i) {
        for (int j = -3; j <= 3; ++j) {
            highest =
                std::max(highest, terrain::bilinear_height(terrain->heightfield.heights.view(),
                                                           *sample + glm::dvec2(i, j)));
        }
    }
    EXPECT_GT(highest, 4600.0);
    EXPECT_EQ(terrain->heightfield.georeference->vertical_datum, "EGM96 height");
}

TEST(RealRasters, SharedEdgesOfTheAlpineBlockLieOnEachOther) {
    const std::string west = "natural/srtm3/N45E006.hgt";
    const std::string east = "natural/srtm3/N45E007.hgt";
    RELJEF_NEED_DATA(west);
    RELJEF_NEED_DATA(east);
    const auto left = read_terrain(test::data_path(west));
    const auto right = read_terrain(test::data_path(east));
    ASSERT_TRUE(left && right);
    for (int row = 0; row < 1201; ++row) {
        ASSERT_EQ(left->heightfield.heights(1200, row), right->heightfield.heights(0, row));
        const glm::dvec2 a =
            left->heightfield.georeference->geodetic.latitude_longitude({1200.0, row});
        const glm::dvec2 b =
            right->heightfield.georeference->geodetic.latitude_longitude({0.0, row});
        ASSERT_LT(geo::geodesic_distance({a.x, a.y, 0.0}, {b.x, b.y, 0.0}), 1e-6);
    }
}

TEST(RealRasters, FormatsOfOneMountainAgree) {
    for (const std::string file : {"natural/derived/sthelens.ter", "natural/derived/sthelens.hf2",
                                   "natural/derived/sthelens_ftUS_compound_crs.tif"}) {
        RELJEF_NEED_DATA("natural/SainteHelens.dem");
        RELJEF_NEED_DATA(file);
        const auto whole = read_terrain(test::data_path("natural/SainteHelens.dem"));
        const auto part = read_terrain(test::data_path(file));
        ASSERT_TRUE(whole && part);
        for (int row = 0; row < 340; ++row) {
            for (int col = 0; col < 200; ++col) {
                ASSERT_NEAR(part->heightfield.heights(col, row),
                            whole->heightfield.heights(col + 60, row + 60), 0.05)
                    << file;
            }
        }
    }
}

TEST(RealRasters, AZippedTileIsTheTile) {
    RELJEF_NEED_DATA("natural/srtm3/N22W160v2.3a.hgt.zip");
    const auto info = read_raster_info(test::data_path("natural/srtm3/N22W160v2.3a.hgt.zip"));
    ASSERT_TRUE(info);
    EXPECT_EQ(info->format, "SRTMHGT");
}

TEST(RealRasters, TheTestDataIsLeftAsItWas) {
    const std::filesystem::path folder = test::data_path("natural");
    RELJEF_NEED_DATA("natural");
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        EXPECT_NE(entry.path().extension(), ".xml") << entry.path();
    }
}

} // namespace
} // namespace reljef::io
