#include "engine/cast/ray_tile.h"

#include <gtest/gtest.h>

#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::cast {
namespace {

TEST(RayTile, BoundsTheHeightsOfAnyCells) {
    test::Chance chance(5);
    for (const glm::ivec2 size : {glm::ivec2(2, 2), {3, 200}, {65, 64}, {130, 71}}) {
        const Grid<float> heights = test::random_heights(size.x, size.y, -50.0F, 90.0F, 11);
        const RayTile tile(heights.view());
        for (int i = 0; i < 500; ++i) {
            const glm::ivec2 first(chance.whole(0, size.x - 2), chance.whole(0, size.y - 2));
            const glm::ivec2 last(chance.whole(first.x, size.x - 2),
                                  chance.whole(first.y, size.y - 2));
            float highest = heights(first.x, first.y);
            for (int row = first.y; row <= last.y + 1; ++row) {
                for (int col = first.x; col <= last.x + 1; ++col) {
                    highest = std::max(highest, heights(col, row));
                }
            }
            ASSERT_GE(tile.max_within(first, last), highest);
            ASSERT_LE(tile.max_within(first, last), tile.total().high);
            if (first == last) {
                ASSERT_EQ(tile.max_within(first, last), highest);
            }
        }
    }
}

TEST(RayTile, TakesAtMostEightBytesASample) {
    const Grid<float> heights = test::random_heights(1025, 1025, 0.0F, 1.0F, 1);
    const RayTile tile(heights.view());
    EXPECT_LE(tile.bytes(), 8U * heights.size());
}

TEST(RayTile, HasNoSurfaceBelowTwoByTwoSamples) {
    for (const glm::ivec2 size : {glm::ivec2(0, 0), {1, 1}, {1, 9}, {9, 1}}) {
        const Grid<float> heights(size.x, size.y, 3.0F);
        EXPECT_EQ(RayTile(heights.view()).cells(), glm::ivec2(0));
    }
}

} // namespace
} // namespace reljef::cast
