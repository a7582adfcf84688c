#include "engine/building/footprint.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/building/made_outline.h"

namespace reljef::building {
namespace {

TEST(Footprint, AreasOfReversedRingsAreNegative) {
    Ring ring = test::rectangle_ring({2.0, 1.0}, {5.0, 3.0});
    EXPECT_DOUBLE_EQ(signed_area(ring), 6.0);
    std::reverse(ring.begin(), ring.end());
    EXPECT_DOUBLE_EQ(signed_area(ring), -6.0);
}

TEST(Footprint, CornersOnStraightLinesVanish) {
    const Ring square = test::rectangle_ring({0.0, 0.0}, {10.0, 10.0});
    Ring dotted = square;
    dotted.insert(dotted.begin() + 1, {glm::dvec2(3.0, 0.001), glm::dvec2(7.0, -0.001)});
    dotted.push_back({0.0, 0.004}); // beside the first
    EXPECT_EQ(without_straight_corners(dotted).size(), 4U);
    EXPECT_EQ(without_straight_corners(square), square);
}

TEST(Footprint, SpikesAndLinesVanish) {
    const Ring spike{{0.0, 0.0},    {10.0, 0.0},  {10.0, 5.0}, {30.0, 5.0},
                     {10.0, 5.001}, {10.0, 10.0}, {0.0, 10.0}};
    EXPECT_EQ(without_straight_corners(spike).size(), 4U);
    EXPECT_TRUE(without_straight_corners({{0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}}).empty());
    EXPECT_TRUE(without_straight_corners({{1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}}).empty());
    EXPECT_TRUE(without_straight_corners({}).empty());
}

TEST(Footprint, OnlyRingsThatTurnLeftOnceAreConvex) {
    for (unsigned seed = 0; seed < 100; ++seed) {
        Ring ring = test::random_convex(seed);
        EXPECT_TRUE(is_convex(ring)) << seed;
        std::reverse(ring.begin(), ring.end());
        EXPECT_FALSE(is_convex(ring)) << seed;
    }
    EXPECT_FALSE(is_convex({{0.0, 0.0}, {10.0, 0.0}, {10.0, 10.0}, {5.0, 2.0}, {0.0, 10.0}}));
    Ring twice; // a star of five corners turns twice
    for (int i = 0; i < 5; ++i) {
        twice.emplace_back(std::cos(2.513274 * i), std::sin(2.513274 * i));
    }
    EXPECT_FALSE(is_convex(twice));
    EXPECT_FALSE(is_convex({}));
}

} // namespace
} // namespace reljef::building
