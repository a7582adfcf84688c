#include "engine/terrain/kept_border.h"

#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/terrain/made_bisection.h"

namespace reljef::terrain {
namespace {

// Triangles of the only tile, as coarse as an error in metres allows.
std::vector<test::Triangle> kept_triangles(const test::PlacedTerrain& made, double most_error) {
    ErrorView view;
    view.perspective = false;
    view.most_error = most_error;
    const Tile& tile = made.tiles.front();
    const Triangulation cut =
        triangulate_samples(made.bisection, tile, view, splits_of_border({tile.cols, tile.rows}));
    std::vector<test::Triangle> triangles;
    for (std::size_t i = 0; i < cut.indices.size(); i += 3) {
        triangles.push_back({cut.vertices[cut.indices[i]], cut.vertices[cut.indices[i + 1]],
                             cut.vertices[cut.indices[i + 2]]});
    }
    return triangles;
}

std::size_t border_vertices(const std::vector<test::Triangle>& triangles, glm::ivec2 end) {
    std::set<std::pair<int, int>> places;
    for (const test::Triangle& triangle : triangles) {
        for (const glm::ivec2 place : triangle) {
            EXPECT_EQ(place % steps_per_sample, glm::ivec2(0));
            if (place.x == 0 || place.y == 0 || place.x == end.x || place.y == end.y) {
                places.emplace(place.x, place.y);
            }
        }
    }
    return places.size();
}

TEST(KeptBorder, AllOfItIsThereAndTrianglesMeetEdgeToEdgeWhateverTheError) {
    for (const glm::ivec2 cells : {glm::ivec2(128, 128), glm::ivec2(128, 37), glm::ivec2(1, 128),
                                   glm::ivec2(91, 64), glm::ivec2(1, 1), glm::ivec2(127, 127)}) {
        const test::PlacedTerrain made(
            {"", test::plane_heightfield(test::rough_hills(cells.x + 1, cells.y + 1, 3))});
        for (const double most_error : {1e6, 30.0, 5.0, 0.5, 1e-3}) {
            const auto triangles = kept_triangles(made, most_error);
            std::int64_t area = 0;
            for (const test::Triangle& triangle : triangles) {
                ASSERT_GT(test::doubled_area(triangle), 0);
                area += test::doubled_area(triangle);
            }
            const glm::ivec2 end = made.bisection.end();
            EXPECT_EQ(area, 2 * static_cast<std::int64_t>(end.x) * end.y);
            EXPECT_EQ(test::open_edges(made, triangles), 0U);
            EXPECT_EQ(border_vertices(triangles, end),
                      static_cast<std::size_t>(2 * (cells.x + cells.y)));
        }
    }
}

TEST(KeptBorder, TakesFewTrianglesInside) {
    const test::PlacedTerrain made({"", test::plane_heightfield(Grid<float>(129, 129, 1.0F))});
    EXPECT_LT(kept_triangles(made, 1.0).size(), 2 * 128 * 128 / 16);
}

} // namespace
} // namespace reljef::terrain
