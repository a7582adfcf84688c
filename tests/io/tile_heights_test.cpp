// Heights of places against what the files hold, format by format.
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include "engine/io/tile_set.h"
#include "tests/io/made_raster.h"
#include "tests/support/test_data.h"

namespace reljef::io {
namespace {

/// A file's stored values and the way from its pixels to latitude and longitude, through GDAL.
class Stored {
public:
    explicit Stored(const std::filesystem::path& path) {
        GDALAllRegister();
        dataset_.reset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
        if (dataset_ == nullptr) {
            return;
        }
        cols = dataset_->GetRasterXSize();
        rows = dataset_->GetRasterYSize();
        values_.resize(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
        GDALRasterBand* band = dataset_->GetRasterBand(1);
        EXPECT_EQ(band->RasterIO(GF_Read, 0, 0, cols, rows, values_.data(), cols, rows, GDT_Float64,
                                 0, 0, nullptr),
                  CE_None);
        dataset_->GetGeoTransform(affine_.data());
        OGRSpatialReference from(*dataset_->GetSpatialRef());
        from.StripVertical();
        from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        OGRSpatialReference to;
        to.importFromEPSG(4326);
        to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        transform_.reset(OGRCreateCoordinateTransformation(&from, &to));
    }
    [[nodiscard]] bool good() const { return transform_ != nullptr; }
    [[nodiscard]] double value(int col, int row) const {
        return values_[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) +
                       static_cast<std::size_t>(col)];
    }
    /// Latitude and longitude of a pixel coordinate, (0.5, 0.5) the first centre.
    [[nodiscard]] glm::dvec2 place(double x, double y) const {
        double east = affine_[0] + x * affine_[1] + y * affine_[2];
        double north = affine_[3] + x * affine_[4] + y * affine_[5];
        transform_->Transform(1, &east, &north);
        return {north, east};
    }

    int cols = 0;
    int rows = 0;

private:
    struct Closer {
        void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
    };
    std::unique_ptr<GDALDataset, Closer> dataset_;
    std::vector<double> values_;
    std::array<double, 6> affine_{};
    std::unique_ptr<OGRCoordinateTransformation> transform_;
};

struct RealFile {
    const char* file;
    double metres; ///< in a unit of the stored values
    double nodata;
};
constexpr double us_foot = 1200.0 / 3937.0;
constexpr std::array real_files{
    RealFile{"natural/srtm3/N45E006.hgt", 1.0, -32768.0},
    RealFile{"natural/mt_rainier_90m.tif", 1.0, -32768.0},
    RealFile{"natural/derived/mt_rainier_90m_cog.tif", 1.0, -32768.0},
    RealFile{"natural/SainteHelens.dem", 1.0, -32767.0},
    RealFile{"natural/derived/sthelens_ftUS_compound_crs.tif", us_foot, -32767.0},
    RealFile{"natural/n00_e006_3arc_v2.dt1", 1.0, -32767.0},
    RealFile{"natural/luxembourg_elev.tif", 1.0, -32768.0},
    RealFile{"urban/delft/tud-dsm-5m.tif", 1.0, -9999.0},
    RealFile{"urban/annarbor/test_dsm.tif", 1.0, std::nan("")}};

bool is_void(const RealFile& file, double value) {
    return std::isnan(value) || value == file.nodata || value == -32767.0 || value == -32768.0;
}

constexpr int points_a_format = 10000;

TEST(TileHeights, AtASampleAreItsOwnValueToTheLastBit) {
    int files = 0;
    for (const RealFile& file : real_files) {
        if (!test::has_data(file.file)) {
            continue;
        }
        const Stored stored(test::data_path(file.file));
        ASSERT_TRUE(stored.good()) << file.file;
        std::mt19937 random(1);
        std::vector<glm::ivec2> samples;
        std::vector<glm::dvec2> places;
        for (int i = 0; i < points_a_format; ++i) {
            samples.emplace_back(static_cast<int>(random() % static_cast<unsigned>(stored.cols)),
                                 static_cast<int>(random() % static_cast<unsigned>(stored.rows)));
            places.push_back(stored.place(samples.back().x + 0.5, samples.back().y + 0.5));
        }
        const auto tiles = TileSet::open(test::data_path(file.file));
        ASSERT_TRUE(tiles) << tiles.error().message;
        const auto found = tiles->heights(places);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const double value = stored.value(samples[i].x, samples[i].y);
            ASSERT_EQ(found.answers[i].kind, is_void(file, value) ? HeightSample::Kind::in_void
                                                                  : HeightSample::Kind::height)
                << file.file << " " << samples[i].x << "," << samples[i].y << " " << value;
            ASSERT_EQ(found.answers[i].height, is_void(file, value) ? 0.0 : value * file.metres)
                << file.file << " " << samples[i].x << "," << samples[i].y;
        }
        ++files;
    }
    if (files == 0) {
        GTEST_SKIP() << "no test data";
    }
}

TEST(TileHeights, ManyPlacesOfTheAlpineBlockReadEachSampleOnce) {
    RELJEF_NEED_DATA("natural/srtm3/N45E006.hgt");
    const auto tiles = TileSet::open(test::data_path("natural/srtm3/N45E006.hgt"));
    ASSERT_TRUE(tiles) << tiles.error().message;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> part(0.0, 1.0);
    std::vector<glm::dvec2> places(200'000);
    for (glm::dvec2& place : places) {
        place = {45.0 + part(random), 6.0 + part(random)};
    }
    const TileSet::Heights heights = tiles->heights(places);
    EXPECT_TRUE(heights.errors.empty());
    constexpr std::size_t bytes = std::size_t{2} * 1201 * 1201;
    EXPECT_GT(heights.bytes_read, bytes / 2);
    EXPECT_LE(heights.bytes_read, bytes + bytes / 50); // and those where two blocks meet
}

TEST(TileHeights, BetweenSamplesAreBilinearToAMicrometre) {
    for (const RealFile& file : real_files) {
        if (!test::has_data(file.file)) {
            continue;
        }
        const Stored stored(test::data_path(file.file));
        std::mt19937 random(2);
        std::uniform_real_distribution<double> cols(0.5, stored.cols - 0.5);
        std::uniform_real_distribution<double> rows(0.5, stored.rows - 0.5);
        std::vector<glm::dvec2> pixels;
        std::vector<glm::dvec2> places;
        for (int i = 0; i < points_a_format; ++i) {
            pixels.emplace_back(cols(random), rows(random));
            places.push_back(stored.place(pixels.back().x, pixels.back().y));
        }
        const auto tiles = TileSet::open(test::data_path(file.file));
        ASSERT_TRUE(tiles) << tiles.error().message;
        const auto found = tiles->heights(places);
        int compared = 0;
        for (std::size_t i = 0; i < places.size(); ++i) {
            const glm::dvec2 at = pixels[i] - 0.5;
            const int col = static_cast<int>(at.x);
            const int row = static_cast<int>(at.y);
            const std::array<double, 4> values{stored.value(col, row), stored.value(col + 1, row),
                                               stored.value(col, row + 1),
                                               stored.value(col + 1, row + 1)};
            if (std::any_of(values.begin(), values.end(),
                            [&](double value) { return is_void(file, value); })) {
                continue;
            }
            const double u = at.x - col;
            const double v = at.y - row;
            const double expected = (1.0 - v) * ((1.0 - u) * values[0] + u * values[1]) +
                                    v * ((1.0 - u) * values[2] + u * values[3]);
            ASSERT_NEAR(found.answers[i].height, expected * file.metres, 1e-6) << file.file;
            ++compared;
        }
        EXPECT_GT(compared, points_a_format / 2) << file.file;
    }
}

} // namespace
} // namespace reljef::io
