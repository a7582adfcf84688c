#include "engine/terrain/mesh/grid_triangles.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>

#include <gtest/gtest.h>

namespace reljef::terrain {
namespace {

// Twice the area of a triangle of the grid as seen from above, rows growing south.
int area_from_above(const std::array<int, 3>& triangle, int cols) {
    const auto x = [&](int vertex) { return vertex % (cols + 1); };
    const auto y = [&](int vertex) { return -(vertex / (cols + 1)); };
    const auto [a, b, c] = triangle;
    return (x(b) - x(a)) * (y(c) - y(a)) - (x(c) - x(a)) * (y(b) - y(a));
}

TEST(GridTriangles, CoverEveryQuadByTwoTrianglesCounterClockwiseFromAbove) {
    for (const auto& [cols, rows] :
         {std::pair{1, 1}, {2, 5}, {5, 2}, {128, 128}, {255, 255}, {1, 300}}) {
        const auto indices = grid_triangles<std::uint16_t>(cols, rows);
        ASSERT_EQ(indices.size(), static_cast<std::size_t>(6 * cols * rows));
        std::set<std::array<int, 3>> seen;
        for (std::size_t i = 0; i < indices.size(); i += 3) {
            const std::array<int, 3> triangle{indices[i], indices[i + 1], indices[i + 2]};
            ASSERT_EQ(area_from_above(triangle, cols), 1);
            ASSERT_LT(*std::max_element(triangle.begin(), triangle.end()), (cols + 1) * (rows + 1));
            std::array<int, 3> key = triangle;
            std::sort(key.begin(), key.end());
            ASSERT_TRUE(seen.insert(key).second) << "twice";
            // Both triangles of a quad hold its north-west and its south-east corner.
            const int north_west = key[0];
            ASSERT_EQ(key[2], north_west + cols + 2);
            ASSERT_LT(north_west % (cols + 1), cols) << "around the border";
        }
    }
}

TEST(GridTrianglesDeathTest, DoNotReachMoreThanSixteenBits) {
    EXPECT_DEATH(grid_triangles<std::uint16_t>(256, 256), "indices reach");
}

} // namespace
} // namespace reljef::terrain
