// Rasters that go all around the Earth are whole: across the antimeridian and at both poles.
#include "engine/io/raster/globe.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/imagery/imagery_set.h"
#include "engine/io/terrain_file.h"
#include "engine/io/tree_tile.h"
#include "engine/terrain/field/gradient.h"
#include "engine/terrain/field/placement.h"
#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

double globe_height(double latitude, double longitude) {
    const double x = longitude * std::numbers::pi / 180.0;
    const double y = latitude * std::numbers::pi / 180.0;
    return 1500.0 + 900.0 * std::cos(x + 1.0) * std::cos(y) +
           300.0 * std::sin(7.0 * x) * std::cos(9.0 * y);
}

/// Where a raster begins and how it is spaced: the centre of its first sample.
struct Globe {
    int cols = 72;
    int rows = 36;
    double west = -177.5;
    double north = 87.5;
    double step = 5.0;
};

class WholeGlobe : public ::testing::Test {
protected:
    void write(const Globe& globe, const std::vector<int>& overviews = {}) const {
        auto raster = test::made_raster(globe.cols, globe.rows, [&](int col, int row) {
            return globe_height(globe.north - row * globe.step, globe.west + col * globe.step);
        });
        raster.crs = "EPSG:4326";
        raster.geotransform = {globe.west - 0.5 * globe.step,  globe.step, 0.0,
                               globe.north + 0.5 * globe.step, 0.0,        -globe.step};
        raster.overviews = overviews;
        ASSERT_TRUE(test::write(raster, path()));
    }
    [[nodiscard]] terrain::Heightfield read(const RasterOptions& options = {}) const {
        auto terrain = read_terrain(path(), options);
        EXPECT_TRUE(terrain) << (terrain ? "" : terrain.error().message);
        return terrain ? std::move(terrain->heightfield) : terrain::Heightfield{};
    }
    [[nodiscard]] TileSet tiles() const {
        auto tiles = TileSet::open(path());
        EXPECT_TRUE(tiles) << (tiles ? "" : tiles.error().message);
        return std::move(*tiles);
    }
    [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "globe.tif"; }

    static void expect_whole(const terrain::Heightfield& heightfield) {
        const Grid<float>& heights = heightfield.heights;
        const int last_col = heights.cols() - 1;
        const int last_row = heights.rows() - 1;
        ASSERT_TRUE(heightfield.georeference);
        const geo::GeodeticMap& map = heightfield.georeference->geodetic;
        for (int row = 0; row <= last_row; ++row) {
            ASSERT_EQ(heights(0, row), heights(last_col, row)) << row;
        }
        for (int col = 0; col <= last_col; ++col) {
            ASSERT_EQ(heights(col, 0), heights(0, 0)) << col;
            ASSERT_EQ(heights(col, last_row), heights(0, last_row)) << col;
        }
        const glm::dvec2 first = map.latitude_longitude({0.0, 0.0});
        const glm::dvec2 last = map.latitude_longitude({last_col, last_row});
        EXPECT_NEAR(first.x, 90.0, 1e-9);
        EXPECT_NEAR(last.x, -90.0, 1e-9);
        EXPECT_NEAR(last.y - first.y, 360.0, 1e-9);
    }

    test::TemporaryFolder folder_;
};

TEST_F(WholeGlobe, HasAColumnMoreAndARowAtEachPole) {
    write({});
    const terrain::Heightfield heightfield = read();
    ASSERT_EQ(heightfield.heights.cols(), 73);
    ASSERT_EQ(heightfield.heights.rows(), 38);
    expect_whole(heightfield);
    double mean = 0.0;
    for (int col = 0; col < 72; ++col) {
        mean += static_cast<float>(globe_height(87.5, -177.5 + 5.0 * col)) / 72.0;
        for (int row = 0; row < 36; ++row) {
            ASSERT_EQ(heightfield.heights(col, row + 1),
                      static_cast<float>(globe_height(87.5 - 5.0 * row, -177.5 + 5.0 * col)));
        }
    }
    EXPECT_EQ(heightfield.heights(5, 0), static_cast<float>(mean));
}

TEST_F(WholeGlobe, PlacesAndSamplesAgreeInEveryCell) {
    for (const double west : {-177.5, 2.5}) {
        write({.west = west});
        const terrain::Heightfield heightfield = read();
        const geo::GeodeticMap& map = heightfield.georeference->geodetic;
        for (const double row : {0.25, 0.5, 1.0, 1.25, 17.5, 36.0, 36.75}) {
            for (const double col : {0.0, 0.25, 71.5, 71.999}) {
                const glm::dvec2 place = map.latitude_longitude({col, row});
                const auto sample = map.sample(place.x, place.y - 360.0);
                ASSERT_TRUE(sample);
                EXPECT_NEAR(std::remainder(sample->x - col, 72.0), 0.0, 1e-9);
                EXPECT_NEAR(sample->y, row, 1e-9);
            }
        }
        for (const double longitude : {-180.0, 180.0, 179.9, -179.9, 0.0}) {
            const auto sample = map.sample(3.0, longitude);
            ASSERT_TRUE(sample);
            EXPECT_GE(sample->x, -1e-9) << longitude;
            EXPECT_LE(sample->x, 72.0 + 1e-9) << longitude;
        }
        // Half a cell lies between the pole and the outermost samples.
        EXPECT_NEAR(map.latitude_longitude({9.0, 0.5}).x, 88.75, 1e-9);
        EXPECT_NEAR(map.latitude_longitude({9.0, 36.5}).x, -88.75, 1e-9);
    }
}

TEST_F(WholeGlobe, OnTheGridLinesIsClosedAlready) {
    write({.cols = 73, .rows = 37, .west = -180.0, .north = 90.0});
    const terrain::Heightfield heightfield = read();
    EXPECT_EQ(heightfield.heights.cols(), 73);
    EXPECT_EQ(heightfield.heights.rows(), 37);
    const geo::GlobalWrap wrap = heightfield.georeference->geodetic.rows().wrap();
    EXPECT_TRUE(wrap.around);
    EXPECT_FALSE(wrap.east);
}

TEST_F(WholeGlobe, WhatGoesNotAllAroundStaysAsItIs) {
    write({.cols = 71});
    EXPECT_EQ(read().heights.cols(), 71);
    EXPECT_EQ(read().heights.rows(), 36);
    write({});
    RasterOptions part;
    part.window = RasterOptions::Window{0, 4, 71, 20};
    EXPECT_EQ(read(part).heights.cols(), 71);
    part.window = RasterOptions::Window{0, 4, 72, 20};
    EXPECT_EQ(read(part).heights.cols(), 73);
    EXPECT_EQ(read(part).heights.rows(), 20);
}

TEST_F(WholeGlobe, IsWholeWhereItIsReducedToFitTheMemory) {
    for (const bool grid_lines : {false, true}) {
        write(grid_lines ? Globe{721, 361, -180.0, 90.0, 0.5}
                         : Globe{720, 360, -179.75, 89.75, 0.5});
        for (const std::size_t samples : {60000U, 18000U, 5000U}) {
            RasterOptions options;
            options.memory_budget = samples * bytes_per_sample;
            const terrain::Heightfield heightfield = read(options);
            EXPECT_LT(heightfield.heights.cols(), 700);
            expect_whole(heightfield);
        }
    }
}

TEST_F(WholeGlobe, AVoidAtTheBorderIsOneOnBothSides) {
    auto raster = test::made_raster(72, 36, [](int col, int row) {
        return col == 0 && row == 9 ? -9999.0 : row == 35 ? -9999.0 : 10.0 * row + col;
    });
    raster.crs = "EPSG:4326";
    raster.geotransform = {-180.0, 5.0, 0.0, 90.0, 0.0, -5.0};
    raster.nodata = -9999.0;
    ASSERT_TRUE(test::write(raster, path()));
    const terrain::Heightfield heightfield = read();
    expect_whole(heightfield);
    EXPECT_EQ(heightfield.void_mask(0, 10), 1);
    EXPECT_EQ(heightfield.void_mask(72, 10), 1);
    EXPECT_EQ(heightfield.void_mask(7, 37), 1);
    EXPECT_EQ(heightfield.void_mask(7, 0), 0);
    EXPECT_EQ(heightfield.void_count, 2U + 2U * 73U);
}

TEST_F(WholeGlobe, HeightsAreBetweenTheSamplesOnBothSides) {
    write({});
    const std::vector<glm::dvec2> places{{2.5, 179.0},  {2.5, -181.0}, {2.5, 180.0}, {2.5, -180.0},
                                         {2.5, -179.0}, {90.0, 0.0},   {90.0, 77.0}, {88.75, 2.5},
                                         {-90.0, 5.0},  {-90.0, 100.0}};
    const auto found = tiles().heights(places);
    for (const HeightSample& answer : found.answers) {
        ASSERT_EQ(answer.kind, HeightSample::Kind::height);
    }
    const auto height = [&](std::size_t i) { return found.answers[i].height; };
    const double west = static_cast<float>(globe_height(2.5, 177.5));
    const double east = static_cast<float>(globe_height(2.5, -177.5));
    EXPECT_NEAR(height(0), 0.7 * west + 0.3 * east, 1e-6);
    EXPECT_EQ(height(0), height(1));
    EXPECT_NEAR(height(2), 0.5 * (west + east), 1e-6);
    EXPECT_EQ(height(2), height(3));
    EXPECT_NEAR(height(4), 0.3 * west + 0.7 * east, 1e-6);
    EXPECT_EQ(height(5), height(6));
    EXPECT_NEAR(height(7), 0.5 * (height(5) + static_cast<float>(globe_height(87.5, 2.5))), 1e-6);
    EXPECT_EQ(height(8), height(9));
}

TEST_F(WholeGlobe, AnAreaAllAroundHasAllColumnsWhereverItBegins) {
    write({720, 360, -179.75, 89.75, 0.5}, {});
    const TileSet set = tiles();
    for (const double west : {-180.0, -179.75, 180.0}) {
        const auto part = set.part(set.grid(), {-10.0, west, 10.0, west + 360.0});
        ASSERT_TRUE(part) << part.error().message;
        EXPECT_GE(part->cols, 719) << west;
        EXPECT_EQ(part->rows, 42) << west; // a sample beyond each side
    }
    const auto part = set.part(set.grid(), {-10.0, -180.0, 10.0, -170.0});
    ASSERT_TRUE(part);
    EXPECT_EQ(part->cols, 21);
    EXPECT_NEAR(part->first.x, -179.75, 1e-9);
}

TEST_F(WholeGlobe, TilesMeetAcrossTheAntimeridianAtEveryLevel) {
    write({720, 360, -179.75, 89.75, 0.5}, {2, 4});
    const TileSet set = tiles();
    const geo::GlobalWrap wrap = set.wrap(set.grid());
    EXPECT_EQ(set.files().size(), 1U);
    EXPECT_EQ(set.grid().cols, 720);
    WrappedGrid ground = wrapped_grid(set.grid(), wrap, 1);
    ground.north_height = 1234.5;
    ground.south_height = 567.5;
    ASSERT_EQ(ground.grid.cols, 721);
    ASSERT_EQ(ground.grid.rows, 362);
    const terrain::TileTree tree(721, 362);
    for (int level = 0; level < 3; ++level) {
        const int last = 720 / (terrain::tree_tile_cells << level);
        const terrain::TreeTile west{level, 0, 0};
        const terrain::TreeTile east{level, last, 0};
        const auto first = read_tree_tile(set, ground, tree, west, Gaps::holes).heights;
        const auto again = read_tree_tile(set, ground, tree, east, Gaps::holes).heights;
        const int border = tree.cells(east).x + 1;
        for (int row = 0; row < first.rows(); ++row) {
            ASSERT_FALSE(std::isnan(first(1, row)));
            ASSERT_EQ(first(1, row), again(border, row)) << level << " at " << row;
            ASSERT_EQ(first(2, row), again(border + 1, row)) << level << " at " << row;
        }
        for (int col = 0; col < first.cols(); ++col) {
            ASSERT_EQ(first(col, 1), 1234.5);
        }
        const int bottom = 361 / (terrain::tree_tile_cells << level);
        const terrain::TreeTile south{level, 0, bottom};
        const auto polar = read_tree_tile(set, ground, tree, south, Gaps::holes).heights;
        ASSERT_EQ(polar(3, tree.cells(south).y + 1), 567.5);
        ASSERT_NE(polar(3, tree.cells(south).y), 567.5);
    }
}

TEST_F(WholeGlobe, FinerTilesRiseEvenlyToThePole) {
    write({});
    const TileSet set = tiles();
    WrappedGrid ground = wrapped_grid(set.grid(), set.wrap(set.grid()), 4);
    ground.north_height = 1000.0;
    const terrain::TileTree tree(ground.grid.cols, ground.grid.rows);
    const auto heights = read_tree_tile(set, ground, tree, {0, 0, 0}, Gaps::holes).heights;
    const double outermost = heights(9, 5);
    EXPECT_EQ(outermost, static_cast<float>(globe_height(87.5, -167.5)));
    for (int row = 0; row <= 4; ++row) {
        EXPECT_NEAR(heights(9, row + 1), 1000.0 + 0.25 * row * (outermost - 1000.0), 1e-9);
    }
}

TEST_F(WholeGlobe, APictureShowsAtThePoleWhatLiesThere) {
    // Two texels a row: texel 1 lies at the nominal pole.
    Image picture(3, 9, Rgba8{0, 0, 0, 0});
    for (int row = 1; row < 8; ++row) {
        const auto grey = static_cast<std::uint8_t>(row);
        for (int col = 0; col < 3; ++col) {
            picture(col, row) = {grey, grey, grey, 255};
        }
    }
    geo::GlobalWrap wrap;
    wrap.north = 0.5;
    wrap.south = 0.5;
    wrap_picture(picture, {wrap, 3}, 0.0, 4.0);
    EXPECT_EQ(picture(1, 0).r, 1);
    EXPECT_EQ(picture(1, 1).r, 2);
    EXPECT_EQ(picture(1, 2).r, 2);
    EXPECT_EQ(picture(1, 4).r, 4);
    EXPECT_EQ(picture(1, 7).r, 6);
    EXPECT_EQ(picture(1, 8).r, 7);
}

TEST_F(WholeGlobe, SlopesAreTheSameOnBothSidesAndAtAllOfAPole) {
    for (const Globe& globe : {Globe{}, Globe{73, 37, -180.0, 90.0, 5.0}}) {
        write(globe);
        const terrain::Heightfield heightfield = read();
        const auto placement =
            terrain::Placement::create(heightfield, terrain::PlacementKind::ellipsoid);
        ASSERT_TRUE(placement);
        const auto gradients = terrain::surface_gradients(heightfield, *placement);
        const int last = gradients.cols() - 1;
        for (int row = 0; row < gradients.rows(); ++row) {
            const float size = glm::length(gradients(0, row));
            ASSERT_LE(glm::distance(gradients(0, row), gradients(last, row)), 1e-4F * size) << row;
        }
        for (int col = 0; col <= last; ++col) {
            const float size = glm::length(gradients(0, 0));
            ASSERT_LE(glm::distance(gradients(0, 0), gradients(col, 0)), 1e-4F * size) << col;
        }
    }
}

} // namespace
} // namespace reljef::io
