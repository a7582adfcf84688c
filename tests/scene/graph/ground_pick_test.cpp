#include "engine/scene/graph/ground_pick.h"

#include <array>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/scene/streaming/made_plane_tiles.h"

namespace reljef::scene {
namespace {

using namespace test::plane_tiles;

constexpr double middle = 511.5; // sample of the terrain in the middle of its overview

// z of the plane at x, y.
double plane_at(double x, double y) {
    return height_of({x / 10.0 + middle, middle - y / 10.0});
}

// From above the terrain to a place of the plane inside it.
struct RayToPlane {
    Ray ray;
    glm::dvec3 place;
};
RayToPlane random_ray(std::mt19937& random) {
    std::uniform_real_distribution<double> any(-4800.0, 4800.0);
    glm::dvec3 place(any(random), any(random), 0.0);
    place.z = plane_at(place.x, place.y);
    const glm::dvec3 eye(any(random), any(random), 3000.0 + 0.5 * any(random) * 0.1);
    return {{eye, glm::normalize(place - eye)}, place};
}

TEST(GroundPick, MeetsThePlaneWithoutTilesWithCoarseOnesAndWithFineOnes) {
    auto stream = std::make_shared<TileStream>(maker(), read_plane);
    const TerrainNode node{overview(), {}, stream};
    for (const auto& tiles : {std::vector<terrain::TreeTile>{},
                              {{4, 0, 0}},
                              {{4, 0, 0}, {3, 0, 0}, {2, 1, 1}, {0, 8, 8}, {0, 7, 9}}}) {
        stream->request(tiles);
        stream->wait({});
        std::mt19937 random(1);
        for (int i = 0; i < 500; ++i) {
            const RayToPlane made = random_ray(random);
            const auto hit = pick_ground(node, made.ray);
            ASSERT_TRUE(hit) << tiles.size() << ' ' << i;
            ASSERT_LT(glm::distance(hit->world, made.place), 2e-3) << tiles.size() << ' ' << i;
            ASSERT_NEAR(hit->sample.z, made.place.z, 2e-3);
            ASSERT_NEAR(hit->t, glm::distance(made.ray.origin, made.place), 2e-3);
            const GroundTiles ground(stream->maker(), stream->loaded());
            const auto height = ground.height_at(glm::dvec2(hit->sample));
            ASSERT_EQ(height.has_value(), !tiles.empty());
            ASSERT_NEAR(height.value_or(made.place.z), made.place.z, 2e-3);
            const auto expected = node.surface->placement().sample_from_world(hit->world);
            ASSERT_LT(glm::distance(glm::dvec2(*expected), glm::dvec2(hit->sample)), 1e-3);
        }
    }
}

// The raster ends within the last cells of its coarse tiles.
TEST(GroundPick, MeetsTilesWithShorterLastCells) {
    constexpr int odd_side = 1000;
    const auto heights = [](terrain::TreeTile tile, const std::stop_token&) {
        const terrain::TileTree tree(odd_side, odd_side);
        TileContent content;
        content.heights = test::tile_heights(tree.cells(tile), [&](glm::ivec2 vertex) {
            return height_of(glm::dvec2(tree.sample(tile, vertex)));
        });
        return content;
    };
    auto stream = std::make_shared<TileStream>(
        TileBuilder{overview(), terrain::TileTree(odd_side, odd_side), reduction}, heights);
    const TerrainNode node{overview(), {}, stream};
    stream->request(std::array{terrain::TreeTile{4, 0, 0}});
    stream->wait({});
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(4700.0, 4870.0); // in the last cell of 160 m
    for (int i = 0; i < 200; ++i) {
        const double x = any(random);
        const glm::dvec3 place(x, -2000.0, plane_at(x, -2000.0));
        const glm::dvec3 eye(0.0, any(random), 3000.0);
        const auto hit = pick_ground(node, {eye, glm::normalize(place - eye)});
        ASSERT_TRUE(hit) << i;
        ASSERT_LT(glm::distance(hit->world, place), 0.05) << i;
    }
}

TEST(GroundPick, TheFinestTileCounts) {
    // The finest tile in the middle stands 100 m above the plane.
    const auto read = [](terrain::TreeTile tile, const std::stop_token& stop) {
        TileContent content = read_plane(tile, stop);
        for (int row = 0; tile.level == 0 && row < content.heights.rows(); ++row) {
            for (int col = 0; col < content.heights.cols(); ++col) {
                content.heights(col, row) += 100.0F;
            }
        }
        return content;
    };
    auto stream = std::make_shared<TileStream>(maker(), read);
    const TerrainNode node{overview(), {}, stream};
    stream->request(std::array{terrain::TreeTile{4, 0, 0}, terrain::TreeTile{0, 8, 8}});
    stream->wait({});
    const auto height_below = [&](double x, double y) {
        const auto hit = pick_ground(node, {{x, y, 5000.0}, {0.0, 0.0, -1.0}});
        return hit ? hit->world.z - plane_at(x, y) : HUGE_VAL;
    };
    EXPECT_NEAR(height_below(320.0, -320.0), 100.0, 1e-3);
    EXPECT_NEAR(height_below(-320.0, -320.0), 0.0, 1e-3);
    EXPECT_NEAR(height_below(980.0, -320.0), 0.0, 1e-3);
    // Below the fine tile, the coarse one does not show.
    const auto from_below =
        pick_ground(node, {{320.0, -320.0, plane_at(320.0, -320.0) + 50.0}, {0.0, 0.0, -1.0}});
    EXPECT_FALSE(from_below);
}

TEST(GroundPick, SkyAndRaysThatAreNoRaysMeetNothing) {
    auto stream = std::make_shared<TileStream>(maker(), read_plane);
    const TerrainNode streamed{overview(), {}, stream};
    const TerrainNode whole{overview(), {}};
    stream->request(std::array{terrain::TreeTile{4, 0, 0}});
    stream->wait({});
    for (const TerrainNode* node : {&streamed, &whole}) {
        EXPECT_FALSE(pick_ground(*node, {{0.0, 0.0, 5000.0}, {0.0, 0.1, 1.0}}));
        EXPECT_FALSE(pick_ground(*node, {{0.0, 0.0, 5000.0}, {std::nan(""), 0.1, -1.0}}));
        EXPECT_FALSE(pick_ground(*node, {{HUGE_VAL, 0.0, 5000.0}, {0.0, 0.0, -1.0}}));
        EXPECT_FALSE(pick_ground(*node, {{9000.0, 0.0, 5000.0}, {0.0, 0.0, -1.0}})) << "beside";
    }
}

} // namespace
} // namespace reljef::scene
