#include "engine/terrain/field/color_ramp.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

Heightfield land(float low, float high) {
    return test::plane_heightfield(
        test::made_heights(4, 4, [&](int col, int row) { return col + row == 0 ? low : high; }));
}

Heightfield land_at(double latitude) {
    return test::geographic_heightfield(Grid<float>(9, 9, 1.0F), latitude, 7.0, 0.01);
}

TEST(ColorRamp, EveryNameIsARampWithStops) {
    EXPECT_EQ(ramp_names().front(), default_ramp);
    for (const std::string_view name : ramp_names()) {
        const auto ramp = named_ramp(name);
        ASSERT_TRUE(ramp) << name;
        EXPECT_EQ(ramp->name, name);
        EXPECT_FALSE(ramp->stops.empty());
    }
    EXPECT_FALSE(named_ramp("rainbow"));
}

TEST(ColorRamp, OnlyClayHasOneColor) {
    for (const std::string_view name : ramp_names()) {
        EXPECT_EQ(has_one_color(*named_ramp(name)), name == "clay") << name;
    }
    const RampStop grey{0.0, glm::vec3(90.0F), false, false};
    EXPECT_TRUE(has_one_color({"file", {grey, grey}, false, false, {}}));
    EXPECT_FALSE(has_one_color({"rock and snow", {grey}, true, false, {}}));
}

TEST(ColorRamp, IsLinearBetweenStopsAndConstantBeyond) {
    const ColorRamp ramp{
        "two", {{100.0, glm::vec3(10.0F)}, {300.0, glm::vec3(50.0F)}}, false, false, {}};
    const RampColors colors(ramp, land(0.0F, 400.0F));
    EXPECT_EQ(colors.at(-9.0).r, 10.0F);
    EXPECT_FLOAT_EQ(colors.at(150.0).r, 20.0F);
    EXPECT_EQ(colors.at(1000.0).r, 50.0F);
}

TEST(ColorRamp, RoundingLeavesNoRangeBetweenTwoStops) {
    const ColorRamp ramp{
        "two", {{-5.0, {0.0F, 0.0F, 255.0F}}, {1201.5, glm::vec3(255.0F)}}, false, false, {}};
    const RampColors colors(ramp, land(0.0F, 400.0F));
    for (int i = -10; i <= 2500; ++i) {
        EXPECT_EQ(colors.at(0.5 * i).b, 255.0F) << i;
    }
}

TEST(ColorRamp, ColorsOfAHeightDoNotDependOnTheTerrain) {
    const ColorRamp ramp = *named_ramp(default_ramp);
    EXPECT_EQ(RampColors(ramp, land(0.0F, 250.0F)).at(200.0),
              RampColors(ramp, land(100.0F, 4000.0F)).at(200.0));
}

TEST(ColorRamp, SharesFollowTheTerrain) {
    const ColorRamp ramp = *named_ramp("stretched");
    const Heightfield low =
        test::plane_heightfield(test::made_heights(101, 2, [](int col, int) { return col; }));
    const Heightfield high = test::plane_heightfield(
        test::made_heights(101, 2, [](int col, int) { return 40.0 * col; }));
    EXPECT_EQ(RampColors(ramp, low).at(50.0), RampColors(ramp, high).at(2000.0));
}

// Maps have no white coasts and no black heights: light and shadow say where it is steep.
TEST(ColorRamp, AnAtlasIsMutedAndHasNoSnow) {
    const ColorRamp ramp = *named_ramp(map_ramp);
    const Heightfield coast =
        test::plane_heightfield(test::made_heights(257, 2, [](int col, int) { return col; }));
    const RampColors colors(ramp, coast);
    for (double height = 0.0; height <= 256.0; height += 8.0) {
        const glm::vec3 color = colors.at(height, {0.1F, 0.1F});
        const auto [low, high] = std::minmax({color.r, color.g, color.b});
        EXPECT_GT(low, 100.0F) << height;
        EXPECT_LT(high, 200.0F) << height;
        EXPECT_LT(high - low, 60.0F) << height;
    }
    EXPECT_NE(colors.at(20.0), colors.at(120.0));
}

// The shares are those of the land, however deep the sea is.
TEST(ColorRamp, AnAtlasHasSeasOfTheirOwn) {
    const ColorRamp ramp = *named_ramp(map_ramp);
    const auto range = [](double low) {
        return test::plane_heightfield(test::made_heights(
            401, 2, [low](int col, int) { return col < 200 ? low : 10.0 * (col - 200); }));
    };
    const RampColors deep(ramp, range(-4000.0));
    EXPECT_GT(deep.at(-300.0).b, deep.at(-300.0).r + 20.0F);
    EXPECT_EQ(deep.at(1500.0), RampColors(ramp, range(-200.0)).at(1500.0));
    const glm::vec3 polder = RampColors(ramp, land(-6.0F, 90.0F)).at(-5.0);
    EXPECT_GT(polder.g, polder.b);
}

TEST(ColorRamp, PoldersAreNoSea) {
    const ColorRamp ramp = *named_ramp(default_ramp);
    const glm::vec3 polder = RampColors(ramp, land(-6.0F, 90.0F)).at(-5.0);
    EXPECT_GT(polder.g, polder.b);
    const glm::vec3 sea = RampColors(ramp, land(-3000.0F, 90.0F)).at(-500.0);
    EXPECT_GT(sea.b, sea.g);
}

TEST(ColorRamp, SnowLiesHighOnGentleGroundAndLowerTowardsThePole) {
    const ColorRamp ramp = *named_ramp(default_ramp);
    const RampColors colors(ramp, land_at(46.0));
    const double line = colors.snow_height();
    const glm::vec3 snow = colors.at(line + 400.0, {0.2F, 0.0F});
    EXPECT_GT(snow.b, 190.0F);
    EXPECT_LT(colors.at(line + 400.0, {2.0F, 0.0F}).b, snow.b - 30.0F) << "a wall is rock";
    EXPECT_EQ(colors.at(line - 600.0, {0.1F, 0.0F}), colors.at(line - 600.0, {0.0F, 0.1F}));
    // A slope falls to the north where its height grows to the south.
    EXPECT_GT(colors.at(line, {0.0F, -0.5F}).b, colors.at(line, {0.0F, 0.5F}).b + 10.0F);
    const RampColors southern(ramp, land_at(-46.0));
    EXPECT_LT(southern.at(line, {0.0F, -0.5F}).b, southern.at(line, {0.0F, 0.5F}).b - 10.0F);
}

TEST(ColorRamp, SnowLinesFallToThePoles) {
    EXPECT_EQ(snow_line(-46.0), snow_line(46.0));
    EXPECT_EQ(snow_line(90.0), 0.0);
    for (double latitude = 21.0; latitude <= 90.0; latitude += 1.0) {
        EXPECT_LT(snow_line(latitude), snow_line(latitude - 1.0));
    }
}

} // namespace
} // namespace reljef::terrain
