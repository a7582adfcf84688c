#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/scene/streaming/tile_builder.h"
#include "tests/scene/streaming/made_plane_tiles.h"

namespace reljef::scene {
namespace {

using terrain::TileTree;
using terrain::TreeTile;
using namespace test::plane_tiles;

TEST(TileMakers, PlaceTilesOfEveryLevelOnTheSurfaceOfTheOverview) {
    const TileBuilder make = maker();
    const auto& placement = make.overview().placement();
    for (const TreeTile tile : {TreeTile{3, 0, 0}, {2, 1, 0}, {1, 3, 2}, {0, 7, 7}, {0, 0, 5}}) {
        const TerrainTile made = make.make(tile, read_plane(tile, {}).heights);
        for (int row = 0; row <= made.cells.y; row += 16) {
            for (int col = 0; col <= made.cells.x; col += 16) {
                const glm::dvec2 sample(make.tree().sample(tile, {col, row}));
                const glm::dvec3 expected =
                    placement.world_from_sample({make.on_overview(sample), height_of(sample)});
                const glm::dvec3 found = made.place({col, row});
                ASSERT_NEAR(found.x, expected.x, 1e-3);
                ASSERT_NEAR(found.y, expected.y, 1e-3);
                ASSERT_NEAR(found.z, expected.z, 1e-3);
                // Of the plane z = 0.025 x + 0.05 y.
                const glm::vec3 normal = made.normals(col, row);
                ASSERT_NEAR(normal.x / normal.z, -0.025, 1e-4);
                ASSERT_NEAR(normal.y / normal.z, -0.05, 1e-4);
            }
        }
        EXPECT_NEAR(made.error, 0.0, 1e-3); // a plane: nothing is gained by more
    }
}

TEST(TileMakers, FillVoidsWithTheOverview) {
    auto heights = read_plane({0, 3, 3}, {}).heights;
    heights(60, 60) = std::numeric_limits<float>::quiet_NaN();
    const TerrainTile made = maker().make({0, 3, 3}, std::move(heights));
    EXPECT_NEAR(made.heightfield.heights(59, 59),
                height_of(glm::dvec2(3 * terrain::tree_tile_cells + 59)), 1e-3);
    const Rgba8 beside = made.albedo(58, 59);
    EXPECT_NEAR(made.albedo(59, 59).r, beside.r, 2) << "no grey: the data lie around it";
}

// Light shows where slopes change at the samples of the overview.
TEST(TileMakers, FillVoidsWithoutBendsAtTheSamplesOfTheOverview) {
    terrain::Terrain bowl = overview()->terrain();
    Grid<float>& heights = bowl.heightfield.heights;
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            heights(col, row) = static_cast<float>(0.5 * col * col);
        }
    }
    bowl.heightfield.range = terrain::height_range(heights, {});
    const auto surface =
        TerrainSurface::create(std::make_shared<const terrain::Terrain>(std::move(bowl)));
    const TileBuilder make(std::make_shared<const TerrainSurface>(*surface), TileTree(side, side),
                           reduction);
    Grid<float> unknown(67, 67);
    std::fill(unknown.samples().begin(), unknown.samples().end(),
              std::numeric_limits<float>::quiet_NaN());
    const TerrainTile made = make.make({0, 3, 3}, std::move(unknown));
    for (int col = 1; col < 64; ++col) {
        const auto height = [&](int at) { return made.heightfield.heights(at, 32); };
        EXPECT_NEAR(height(col + 1) - 2.0F * height(col) + height(col - 1), 1.0 / 64.0, 5e-3)
            << col;
    }
}

TEST(TileMakers, ShowPicturesAndTheTintWhereTheyShowNothing) {
    const TileBuilder make(overview(), TileTree(side, side), reduction,
                           {.finest_pixel = 2.0, .refinement = 1});
    const TreeTile tile{0, 3, 3};
    EXPECT_EQ(make.picture_size(tile), glm::ivec2(257)); // 10 m a cell: at most four texels
    EXPECT_EQ(make.picture_size({3, 0, 0}), glm::ivec2(257));
    TilePicture picture{Image(257, 257, Rgba8{0, 0, 0, 0}), true, true};
    picture.texels(256, 0) = {1, 2, 3, 255};
    const TerrainTile made = make.make(tile, read_plane(tile, {}).heights, picture);
    EXPECT_EQ(made.albedo(256, 0), (Rgba8{1, 2, 3, 255}));
    EXPECT_EQ(made.albedo(255, 1), make.make(tile, read_plane(tile, {}).heights).albedo(64, 0));
    EXPECT_DOUBLE_EQ(made.coarse_texel, 2.5);
    EXPECT_GT(made.bytes(), 2 * bytes_per_tile);
    EXPECT_LE(made.bytes(), make.bytes_per_tile());
}

TEST(TileMakers, MakeTheCoarsestTilesOfTheOverview) {
    const TileBuilder make = maker();
    for (const int level : {3, 2, 0}) {
        const TreeTile tile{level, 0, 0};
        const Grid<float> found = make.overview_heights(tile);
        const Grid<float> expected = read_plane(tile, {}).heights;
        ASSERT_EQ(found.cols(), expected.cols());
        // Away from the border, where the overview ends half of its samples earlier.
        const int margin = 2 * reduction;
        for (int row = margin; row < found.rows() - margin; ++row) {
            for (int col = margin; col < found.cols() - margin; ++col) {
                ASSERT_NEAR(found(col, row), expected(col, row), 1e-3) << level;
            }
        }
    }
}

TEST(TileMakers, AveragesOfTheOverviewAreAsWideAsAStep) {
    auto terrain = std::make_shared<terrain::Terrain>(overview()->terrain());
    Grid<float>& heights = terrain->heightfield.heights;
    std::fill(heights.samples().begin(), heights.samples().end(), 0.0F);
    heights(40, 40) = 16.0F; // over samples 320 to 327
    const auto surface = TerrainSurface::create(terrain);
    ASSERT_TRUE(surface);
    // Levels whose steps are 2 and 4 of the overview's samples: vertices at 320 and 320 ± 32.
    const TileBuilder make(std::make_shared<const TerrainSurface>(*surface), TileTree(9217, 9217),
                           reduction);
    EXPECT_FLOAT_EQ(make.overview_heights({4, 0, 0})(21, 21), 16.0F / 4.0F);
    EXPECT_FLOAT_EQ(make.overview_heights({5, 0, 0})(11, 11), 16.0F / 16.0F);
    EXPECT_FLOAT_EQ(make.overview_heights({5, 0, 0})(12, 12), 0.0F);
}

TEST(TileMakers, RefinedOnesStandOnTheSameGround) {
    const TileBuilder make(overview(), TileTree(4 * side - 3, 4 * side - 3), reduction,
                           {.finest_pixel = 0.5, .refinement = 4});
    EXPECT_EQ(make.first({0, 4, 8}), glm::dvec2(64.0, 128.0));
    EXPECT_EQ(make.sample({0, 4, 8}, {2, 4}), glm::dvec2(64.5, 129.0));
    EXPECT_DOUBLE_EQ(make.spacing(0), 2.5);
    EXPECT_DOUBLE_EQ(make.spacing(2), 10.0);
    EXPECT_TRUE(make.has_all_samples({2, 0, 0}));
    EXPECT_FALSE(make.has_all_samples({3, 0, 0}));
    const glm::dvec3 expected = maker().place({0, 1, 2}, {0, 0}, 5.0);
    EXPECT_EQ(make.place({0, 4, 8}, {0, 0}, 5.0), expected);
}

double globe_height(glm::dvec2 sample) {
    const double x = sample.x * 2.0 * std::numbers::pi / 36.0;
    return sample.y <= 0.0 || sample.y >= 19.0 ? 9000.0 : 9000.0 + 20000.0 * std::sin(x + 0.4);
}

/// 36×18 samples around the Earth, 10° apart, and what closes them.
TileBuilder globe_maker() {
    constexpr geo::GlobalWrap wrap{.around = true, .east = true, .north = 0.5, .south = 0.5};
    Grid<glm::dvec2> degrees(9, 9);
    for (int row = 0; row < 9; ++row) {
        for (int col = 0; col < 9; ++col) {
            degrees(col, row) = {85.0 - 170.0 * row / 8.0, -175.0 + 350.0 * col / 8.0};
        }
    }
    terrain::Terrain globe{"globe", {}, {}, {}};
    globe.heightfield.heights = Grid<float>(37, 20);
    for (int row = 0; row < 20; ++row) {
        for (int col = 0; col < 37; ++col) {
            globe.heightfield.heights(col, row) = static_cast<float>(globe_height({col % 36, row}));
        }
    }
    globe.heightfield.range = {-11000.0, 29000.0};
    globe.heightfield.spacing = glm::dvec2(1.11e6);
    globe.heightfield.georeference.emplace();
    globe.heightfield.georeference->geodetic =
        geo::GeodeticMap(degrees, glm::dvec2(0.0), {35.0 / 8.0, 17.0 / 8.0}).closed(wrap, 36, 18);
    auto surface =
        TerrainSurface::create(std::make_shared<const terrain::Terrain>(std::move(globe)),
                               {.placement = terrain::PlacementKind::ellipsoid});
    EXPECT_TRUE(surface);
    return {
        std::make_shared<const TerrainSurface>(std::move(*surface)), TileTree(37, 20), 1, {}, wrap};
}

TEST(TileMakers, OfAWholeGlobeMeetAcrossTheAntimeridianAndAtThePoles) {
    const TileBuilder make = globe_maker();
    const TreeTile all{0, 0, 0};
    Grid<float> heights(39, 22);
    for (int row = 0; row < 22; ++row) {
        for (int col = 0; col < 39; ++col) {
            heights(col, row) =
                static_cast<float>(globe_height({(col + 35) % 36, std::clamp(row - 1, 0, 19)}));
        }
    }
    const TerrainTile made = make.make(all, std::move(heights));
    for (int row = 0; row < 20; ++row) {
        const glm::dvec3 step = made.place({0, row}) - made.place({36, row});
        EXPECT_LT(glm::length(step), 0.05) << row;
        EXPECT_LT(glm::distance(made.normals(0, row), made.normals(36, row)), 1e-5F) << row;
    }
    for (int col = 0; col <= 36; ++col) {
        EXPECT_LT(glm::distance(made.place({col, 0}), made.place({5, 0})), 0.05);
        EXPECT_LT(glm::distance(made.normals(col, 0), made.normals(5, 0)), 1e-5F);
    }
    const Grid<float> of_overview = make.overview_heights(all);
    for (int row = 0; row < of_overview.rows(); ++row) {
        EXPECT_EQ(of_overview(1, row), of_overview(37, row));
    }
    for (const double row : {0.0, 0.5, 1.0, 10.0, 18.25, 19.0}) {
        EXPECT_NEAR(make.from_overview(make.on_overview({4.0, row})).y, row, 1e-12);
    }
}

} // namespace
} // namespace reljef::scene
