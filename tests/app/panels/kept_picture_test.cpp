#include "app/viewer/panels/toolkit/kept_picture.h"

#include <set>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/panels/toolkit/pixel_area.h"

namespace reljef::app {
namespace {

// The pixels that strips cover; fails where one is covered twice.
std::set<std::pair<int, int>> pixels_of(const std::vector<PixelArea>& strips) {
    std::set<std::pair<int, int>> pixels;
    for (const PixelArea& strip : strips) {
        for (int y = strip.low.y; y < strip.low.y + strip.size.y; ++y) {
            for (int x = strip.low.x; x < strip.low.x + strip.size.x; ++x) {
                EXPECT_TRUE(pixels.emplace(x, y).second) << x << ' ' << y;
            }
        }
    }
    return pixels;
}

TEST(KeptPicture, StripsCoverARectangleOnce) {
    const auto strips = strips_of({{10, 20}, {30, 25}, 0}, {100, 100});
    EXPECT_EQ(strips, (std::vector{PixelArea{{10, 20}, {20, 5}}}));
}

TEST(KeptPicture, StripsLeaveOutRoundedCorners) {
    constexpr int radius = 8;
    const auto pixels = pixels_of(strips_of({{0, 0}, {40, 30}, radius}, {100, 100}));
    EXPECT_FALSE(pixels.contains({0, 0}));
    EXPECT_FALSE(pixels.contains({39, 29}));
    EXPECT_TRUE(pixels.contains({0, 15}));
    EXPECT_TRUE(pixels.contains({20, 0}));
    for (const auto& [x, y] : pixels) { // as many at each side
        EXPECT_TRUE(pixels.contains({39 - x, y}));
        EXPECT_TRUE(pixels.contains({x, 29 - y}));
    }
    // A square of the radius's side less its quarter disc, four times.
    EXPECT_NEAR(40.0 * 30.0 - static_cast<double>(pixels.size()), 64.0 * (4.0 - 3.14159), 16.0);
}

TEST(KeptPicture, StripsStayWithinTheWindow) {
    const auto pixels = pixels_of(strips_of({{-5, -5}, {200, 80}, 4}, {20, 10}));
    EXPECT_EQ(pixels.size(), 20U * 10U);
    EXPECT_TRUE(strips_of({{30, 30}, {40, 40}, 4}, {20, 10}).empty());
    EXPECT_TRUE(strips_of({{0, 0}, {5, 5}, 0}, {0, 0}).empty());
}

TEST(PixelAreas, OverlappingAreasAreJoinedUntilNoneAre) {
    // The second and the third join to one that overlaps the first.
    const auto areas =
        disjoint({{{0, 0}, {10, 10}}, {{5, 20}, {10, 10}}, {{8, 5}, {2, 20}}, {{50, 0}, {5, 5}}});
    EXPECT_THAT(areas, testing::UnorderedElementsAre(PixelArea{{0, 0}, {15, 30}},
                                                     PixelArea{{50, 0}, {5, 5}}));
    EXPECT_EQ(disjoint({{{0, 0}, {5, 5}}, {{5, 0}, {5, 5}}}).size(), 2U); // neighbours
    EXPECT_TRUE(disjoint({}).empty());
}

} // namespace
} // namespace reljef::app
