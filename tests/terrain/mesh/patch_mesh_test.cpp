#include "engine/terrain/mesh/patch_mesh.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/release_only.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

using Edge = std::array<int, 4>;

// Edges without their opposite that do not lie on the border of `last` samples, and twice the area.
std::pair<int, int> open_edges_and_area(const std::vector<Triangulation>& tiles, glm::ivec2 last) {
    std::map<Edge, int> edges;
    int area = 0;
    for (const Triangulation& tile : tiles) {
        for (std::size_t i = 0; i < tile.indices.size(); i += 3) {
            std::array<glm::ivec2, 3> corners{};
            for (std::size_t k = 0; k < 3; ++k) {
                corners[k] = sample_before(tile.vertices[tile.indices[i + k]]);
            }
            const glm::ivec2 p = corners[1] - corners[0];
            const glm::ivec2 q = corners[2] - corners[0];
            EXPECT_GT(p.y * q.x - p.x * q.y, 0);
            area += p.y * q.x - p.x * q.y;
            for (std::size_t k = 0; k < 3; ++k) {
                const glm::ivec2 a = corners[k];
                const glm::ivec2 b = corners[(k + 1) % 3];
                ++edges[{a.x, a.y, b.x, b.y}];
            }
        }
    }
    int open = 0;
    for (const auto& [edge, count] : edges) {
        const auto [ax, ay, bx, by] = edge;
        const bool on_border =
            (ax == bx && (ax == 0 || ax == last.x)) || (ay == by && (ay == 0 || ay == last.y));
        open += count != 1 || edges.contains({bx, by, ax, ay}) == on_border ? 1 : 0;
    }
    return {open, area};
}

TEST(PatchMesh, CoversTheHeightfieldOnceWithTrianglesThatMeetWhateverTheLevels) {
    RELJEF_RELEASE_ONLY("thousands of covers by the same few lines");
    for (const auto& [cols, rows] : {std::pair{2, 2}, {17, 17}, {300, 3}, {161, 150}, {129, 257}}) {
        const Heightfield heightfield =
            test::plane_heightfield(test::random_heights(cols, rows, 0.0F, 9.0F, 1));
        const Placement placement = test::placed(heightfield);
        std::mt19937 random(7);
        for (int i = 0; i < 20; ++i) {
            Grid<std::uint8_t> levels = patch_levels(heightfield, placement, {0, 0, 0}, 1);
            for (std::uint8_t& level : levels.samples()) {
                level = static_cast<std::uint8_t>(random() % max_patch_levels);
            }
            std::vector<Triangulation> tiles;
            for (const TileCells& tile : tile_layout(test::cells_of(heightfield))) {
                tiles.push_back(triangulate_patches(levels, tile));
            }
            const glm::ivec2 last(cols - 1, rows - 1);
            const auto [open, area] = open_edges_and_area(tiles, last);
            ASSERT_EQ(open, 0) << cols << 'x' << rows;
            ASSERT_EQ(area, 2 * last.x * last.y);
        }
    }
}

TEST(PatchMesh, OneLevelIsEverySample) {
    const Heightfield heightfield =
        test::plane_heightfield(test::random_heights(129, 100, 0.0F, 9.0F, 1));
    const Placement placement = test::placed(heightfield);
    const auto levels = patch_levels(heightfield, placement, {9e9, 0.0, 0.0}, 1);
    const Triangulation tile =
        triangulate_patches(levels, tile_layout(test::cells_of(heightfield)).front());
    EXPECT_EQ(tile.vertices.size(), 129U * 100U);
    EXPECT_EQ(tile.indices.size(), 6U * 128U * 99U);
}

// Distances of CTerrainSceneNode::calculateDistanceThresholds() with patches of 17 samples.
TEST(PatchMesh, LevelsChangeAtTheDistancesOfIrrlicht) {
    const Heightfield heightfield = test::plane_heightfield(Grid<float>(17, 17, 0.0F), {4.0, 9.0});
    const Placement placement = test::placed(heightfield);
    const double size = 17.0 * 6.0;
    const auto level_from = [&](double distance, int levels) {
        return static_cast<int>(
            patch_levels(heightfield, placement, {0, 0, distance}, levels)(0, 0));
    };
    const std::array<double, 4> begins{1.0, 2.0, 4.0, 5.0};
    for (int i = 1; i < 4; ++i) {
        const double begin = size * begins[static_cast<std::size_t>(i)];
        EXPECT_EQ(level_from(0.999 * begin, 4), i - 1);
        EXPECT_EQ(level_from(1.001 * begin, 4), i);
        EXPECT_EQ(level_from(1.001 * begin, i), i - 1);
    }
    EXPECT_EQ(level_from(0.0, 5), 0);
    EXPECT_EQ(level_from(100.0 * size, 5), 3) << "a fifth is not used";
}

} // namespace
} // namespace reljef::terrain
