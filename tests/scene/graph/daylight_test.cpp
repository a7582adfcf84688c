#include "engine/scene/graph/daylight.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

double luminance(glm::vec3 color) {
    return glm::dot(color, {0.2126F, 0.7152F, 0.0722F});
}

TEST(Daylight, IsNeutralAtNoonAndWarmInTheEvening) {
    const Daylight noon = daylight_at(40.0, default_turbidity);
    const glm::vec3 facing = noon.sun + noon.ambient;
    EXPECT_NEAR(facing.r / facing.g, 1.0F, 0.03F);
    EXPECT_NEAR(facing.b / facing.g, 1.0F, 0.03F);
    float redness = noon.sun.r / noon.sun.b;
    for (const double altitude : {25.0, 12.0, 5.0, 2.0}) {
        const Daylight later = daylight_at(altitude, default_turbidity);
        EXPECT_GT(later.sun.r / later.sun.b, redness) << altitude;
        EXPECT_GT(later.ambient.b, later.ambient.r) << "the sky stays blue";
        redness = later.sun.r / later.sun.b;
    }
}

TEST(Daylight, HazeMakesTheSunRedderAndTheSkyPaler) {
    const Daylight clear = daylight_at(20.0, 1.2);
    const Daylight hazy = daylight_at(20.0, 4.0);
    EXPECT_GT(hazy.sun.r / hazy.sun.b, clear.sun.r / clear.sun.b);
    EXPECT_GT(luminance(hazy.ambient) / luminance(hazy.sun),
              luminance(clear.ambient) / luminance(clear.sun));
    EXPECT_LT(hazy.sky.zenith.b / hazy.sky.zenith.r, clear.sky.zenith.b / clear.sky.zenith.r);
    EXPECT_LT(hazy.sky.fading.b / hazy.sky.fading.r, clear.sky.fading.b / clear.sky.fading.r);
}

TEST(Daylight, TheSkyIsBlueAboveAndBrightAtTheHorizon) {
    const Sky sky = daylight_at(40.0, default_turbidity).sky;
    EXPECT_GT(sky.zenith.b, 2.0F * sky.zenith.r);
    EXPECT_GT(luminance(sky.horizon), 1.5 * luminance(sky.zenith));
    EXPECT_GT(sky.horizon.b, sky.horizon.r);
}

TEST(Daylight, IsExposedForGroundInAnyLight) {
    for (const double altitude : {2.0, 10.0, 40.0, 90.0}) {
        const Daylight light = daylight_at(altitude, default_turbidity);
        const double facing = luminance(light.sun + light.ambient);
        EXPECT_GT(facing, 1.2) << altitude;
        EXPECT_LT(facing, 2.6) << altitude;
    }
}

TEST(Daylight, EveryValueIsAColorAtEverySunAndTurbidity) {
    for (double altitude = -20.0; altitude <= 90.0; altitude += 5.0) {
        for (const double turbidity : {min_turbidity, 2.0, max_turbidity}) {
            const Daylight light = daylight_at(altitude, turbidity);
            for (const glm::vec3 color : {light.sun, light.ambient, light.sky.zenith,
                                          light.sky.horizon, light.sky.glow, light.sky.fading}) {
                for (int i = 0; i < 3; ++i) {
                    ASSERT_TRUE(std::isfinite(color[i])) << altitude << ' ' << turbidity;
                    ASSERT_GE(color[i], 0.0F) << altitude << ' ' << turbidity;
                }
            }
            ASSERT_GT(light.sky.curve, 0.0F);
        }
    }
}

// Without aerosols, the direct light of the zenith is that of the depths of molecules and ozone.
TEST(Daylight, TheSunOverheadFadesByTheDepthOfTheAir) {
    const Daylight light = daylight_at(90.0, 1.0);
    const auto left = [](double molecules, double ozone) {
        return std::exp(-(molecules * 8.0e3 + ozone * 1.5e4));
    };
    const double red = left(5.8e-6, 0.65e-6) * 0.90;
    const double blue = left(33.1e-6, 0.085e-6) * 1.10;
    EXPECT_NEAR(light.sun.b / light.sun.r, blue / red, 0.02);
}

} // namespace
} // namespace reljef::scene
