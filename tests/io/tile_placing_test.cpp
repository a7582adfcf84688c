// Tiles with nonsense for a place or a size, beside good ones.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/georeferencing.h"
#include "engine/io/tile_layer.h"
#include "engine/io/tile_set.h"
#include "engine/terrain/tree/tile_tree.h"
#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;

constexpr const char* metres_crs = "EPSG:32631";
constexpr const char* degrees_crs = "EPSG:4326";

/// A virtual raster without samples; `affine` is GDAL's geotransform as text.
std::string empty_vrt(int cols, int rows, const std::string& crs, const std::string& affine) {
    return fmt::format("<VRTDataset rasterXSize=\"{}\" rasterYSize=\"{}\"><SRS>{}</SRS>"
                       "<GeoTransform>{}</GeoTransform>"
                       "<VRTRasterBand dataType=\"Int16\" band=\"1\"/></VRTDataset>",
                       cols, rows, crs, affine);
}

struct Nonsense {
    const char* what;
    std::string crs;
    std::string affine;
    const char* reason;
    int cols = 8;
};

const std::array nonsense_files{
    Nonsense{"origin 1e300", metres_crs, "1e300,10,0,5000000,0,-10", "geotransform"},
    Nonsense{"origin NaN", metres_crs, "nan,10,0,5000000,0,-10", "geotransform"},
    Nonsense{"spacing NaN", metres_crs, "500000,nan,0,5000000,0,nan", "geotransform"},
    Nonsense{"spacing infinite", metres_crs, "500000,inf,0,5000000,0,-10", "geotransform"},
    Nonsense{"spacing 0", metres_crs, "500000,0,0,5000000,0,0", "geotransform"},
    Nonsense{"spacing 1e-300", metres_crs, "500000,1e-300,0,5000000,0,-1e-300", "geotransform"},
    Nonsense{"spacing 1e-100", metres_crs, "500000,1e-100,0,5000000,0,-1e-100", "m apart"},
    Nonsense{"one spacing 1e-9", metres_crs, "500000,1e-9,0,5000000,0,-10", "m apart"},
    Nonsense{"spacing 2e6 times finer", metres_crs, "500000,5e-6,0,5000000,0,-5e-6",
             "within a factor"},
    Nonsense{"spacing 1e9 times coarser", metres_crs, "500000,1e10,0,5000000,0,-1e10",
             "coordinate"},
    Nonsense{"flat samples", metres_crs, "500000,1e-4,0,5000000,0,-10", "times the other"},
    Nonsense{"needles", metres_crs, "500000,10,10,5000000,10,10.0000001", "geotransform"},
    Nonsense{"far east", metres_crs, "1e9,10,0,5000000,0,-10", "at coordinate 1e+09"},
    Nonsense{"geocentric", "EPSG:4978", "4000000,10,0,5000000,0,-10", "Earth's centre"},
    Nonsense{"off the projection", metres_crs, "9e7,10,0,5000000,0,-10", "no position on Earth"},
    Nonsense{"Mercator's far east", "EPSG:3857", "1e11,10,0,5000000,0,-10", "at coordinate 1e+11"},
    Nonsense{"longitude 1e9", degrees_crs, "1e9,0.001,0,45,0,-0.001", "at coordinate 1e+09"},
    Nonsense{"many turns", degrees_crs, "0,1e5,0,45,0,-0.001", "at coordinate 750000"},
    Nonsense{"beyond the pole", degrees_crs, "3,0.001,0,95,0,-0.001", "no position on Earth"},
    Nonsense{"2^31 - 1 columns", metres_crs, "500000,1e-3,0,5000000,0,-10", "2147483647×8 samples",
             2147483647},
};

class NonsenseFile : public ::testing::Test {
protected:
    /// Two neighbours, 10 m apart.
    void write_good_files() const {
        for (const int i : {0, 1}) {
            auto raster = test::made_raster(
                8, 8, [&](int col, int row) { return 100 + 8 * i + col + 20 * row; });
            raster.crs = metres_crs;
            raster.geotransform = {500000.0 + 80.0 * i, 10.0, 0.0, 5000000.0, 0.0, -10.0};
            ASSERT_TRUE(test::write(raster, folder_.path() / fmt::format("good{}.tif", i)));
        }
    }
    [[nodiscard]] terrain::Terrain drawn() const {
        const auto tiles = TileSet::open(folder_.path());
        EXPECT_TRUE(tiles) << (tiles ? "" : tiles.error().message);
        auto terrain =
            tiles ? tiles->terrain() : Result<terrain::Terrain>(Error{"nothing is open"});
        EXPECT_TRUE(terrain) << (terrain ? "" : terrain.error().message);
        return terrain ? std::move(*terrain) : terrain::Terrain{};
    }

    const test::TemporaryFolder folder_;
    const test::QuietGdal quiet_;
};

TEST_F(NonsenseFile, IsLeftOutAndNamedOnceWhileTheRestIsDrawn) {
    write_good_files();
    const terrain::Terrain good = drawn();
    EXPECT_TRUE(good.errors.empty());
    EXPECT_EQ(good.heightfield.heights.cols(), 16);
    for (const Nonsense& file : nonsense_files) {
        SCOPED_TRACE(file.what);
        folder_.write("wrong.vrt", empty_vrt(file.cols, 8, file.crs, file.affine));
        const terrain::Terrain terrain = drawn();
        EXPECT_EQ(terrain.heightfield.heights, good.heightfield.heights);
        ASSERT_EQ(terrain.errors.size(), 1U) << test::joined(terrain.errors);
        EXPECT_THAT(terrain.errors[0], HasSubstr("wrong.vrt: "));
        EXPECT_THAT(terrain.errors[0], HasSubstr(file.reason));
        EXPECT_THAT(terrain.errors[0], HasSubstr("expected"));
        const std::string told = test::joined(terrain.notes);
        EXPECT_EQ(told.find("wrong.vrt"), std::string::npos) << told;
    }
}

/// A number of any size, some of them exactly 0, NaN or infinite.
class AnyNumber {
public:
    explicit AnyNumber(unsigned seed) : random_(seed) {}

    /// Of a decimal exponent up to ±`digits`.
    double number(double digits) {
        const double kind = unit();
        if (kind < 0.02) {
            return kind < 0.01 ? 0.0 : std::nan("");
        }
        if (kind < 0.04) {
            return kind < 0.03 ? HUGE_VAL : -HUGE_VAL;
        }
        const double size = std::pow(10.0, digits * (2.0 * unit() - 1.0));
        return unit() < 0.5 ? -size : size;
    }
    int side() { return static_cast<int>(std::pow(2.0, 1.0 + 29.0 * unit() * unit())); }
    bool one_of(double share) { return unit() < share; }

private:
    double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

    std::mt19937 random_;
};

IndexedFile any_file(AnyNumber& any, int number) {
    IndexedFile file;
    file.path = fmt::format("{}.tif", number);
    file.crs = number % 3;
    file.cols = any.side();
    file.rows = any.side();
    const bool extreme = any.one_of(0.5); // else of sizes that may be on Earth
    file.crs_from_pixel = {any.number(extreme ? 300 : 6),
                           any.number(extreme ? 300 : 3),
                           any.one_of(0.7) ? 0.0 : any.number(extreme ? 300 : 3),
                           any.number(extreme ? 300 : 6),
                           any.one_of(0.7) ? 0.0 : any.number(extreme ? 300 : 3),
                           any.number(extreme ? 300 : 3)};
    file.use = is_usable(file.crs_from_pixel) ? FileKind::heights : FileKind::error;
    return file;
}

TEST(AnyGeoreference, IsLeftOutOrGivesSaneLayers) {
    std::vector<std::string> systems;
    for (const char* name : {degrees_crs, metres_crs, "EPSG:3857"}) {
        systems.push_back(wkt_of(crs_from_text(name)));
    }
    std::size_t placed_files = 0;
    for (unsigned seed = 1; seed <= 10; ++seed) {
        AnyNumber any(seed);
        FileIndex index{systems, {}};
        for (int i = 0; i < 500; ++i) {
            index.files.push_back(any_file(any, i));
        }
        const test::QuietGdal quiet;
        std::vector<FileError> errors;
        const auto placed = place_files(index, "folder", errors);
        ASSERT_EQ(placed.size() + errors.size(), index.files.size());
        for (const PlacedFile& file : placed) {
            ASSERT_GE(std::min(file.spacing.x, file.spacing.y), terrain::min_spacing);
            ASSERT_LE(std::max(file.spacing.x, file.spacing.y), terrain::max_spacing);
        }
        for (const TileLayer& layer : layers_of(placed, index.files)) {
            ASSERT_TRUE(layer.cols >= 2 && layer.cols <= terrain::max_tree_samples);
            ASSERT_TRUE(layer.rows >= 2 && layer.rows <= terrain::max_tree_samples);
            for (const LayerTile& tile : layer.tiles) {
                ASSERT_TRUE(tile.is_wrapped ||
                            (tile.col >= 0 && tile.row >= 0 && tile.cols <= layer.cols - tile.col &&
                             tile.rows <= layer.rows - tile.row));
            }
        }
        placed_files += placed.size();
    }
    EXPECT_GT(placed_files, 200U); // the numbers are not all nonsense
}

TEST_F(NonsenseFile, OfAnyPlaceAndSizeIsReadWithoutHarm) {
    write_good_files();
    AnyNumber any(1);
    for (int i = 0; i < 60; ++i) {
        const IndexedFile file = any_file(any, i);
        const auto& affine = file.crs_from_pixel;
        const std::array numbers{affine.x0, affine.x_col, affine.x_row,
                                 affine.y0, affine.y_col, affine.y_row};
        folder_.write("any.vrt",
                      empty_vrt(file.cols, file.rows, i % 2 == 0 ? metres_crs : degrees_crs,
                                fmt::format("{}", fmt::join(numbers, ","))));
        const auto tiles = TileSet::open(folder_.path());
        ASSERT_TRUE(tiles) << tiles.error().message;
        const TileGrid whole = tiles->grid();
        ASSERT_TRUE(whole.cols >= 1 && whole.cols <= terrain::max_tree_samples);
        ASSERT_TRUE(whole.rows >= 1 && whole.rows <= terrain::max_tree_samples);
        const auto good = tiles->heights(std::array{glm::dvec2(45.15346, 3.0006)});
        ASSERT_EQ(good.answers.size(), 1U);
        const bool in_metres = tiles->crs() != wgs84_degrees;
        const TileGrid part = in_metres ? TileGrid{{500005.0, 4999995.0}, {10.0, -10.0}, 16, 8}
                                        : TileGrid{{3.0, 45.154}, {1e-4, -1e-4}, 16, 8};
        ASSERT_EQ(tiles->read(part, Gaps::sea).heights.cols(), 16);
    }
}

} // namespace
} // namespace reljef::io
