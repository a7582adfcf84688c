#include "engine/view/terrain_maps.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/render/made_scene.h"

namespace reljef::view {
namespace {

std::shared_ptr<const scene::TerrainSurface> surface(terrain::Heightfield heightfield,
                                                     Image color = {}) {
    auto terrain = std::make_shared<const terrain::Terrain>(
        terrain::Terrain{"made", std::move(heightfield), std::move(color), {}, {}});
    return std::make_shared<const scene::TerrainSurface>(
        scene::TerrainSurface::create(std::move(terrain)).value());
}

scene::TerrainLight light_from(double azimuth, double altitude) {
    scene::TerrainLight light;
    light.sun.azimuth = azimuth;
    light.sun.altitude = altitude;
    light.sun.color = glm::vec3(0.8F);
    light.sun.ambient = glm::vec3(0.1F);
    return light;
}

TEST(LitMap, WithoutASunItIsTheImageryItself) {
    Image color(7, 5, Rgba8{10, 20, 30, 255});
    color(6, 0) = {200, 0, 0, 255};
    const auto made = surface(test::plane_heightfield(Grid<float>(33, 9, 1.0F)), color);
    EXPECT_EQ(lit_map(*made, std::nullopt, 4096), color);
}

TEST(LitMap, MixesImageryWithTheColoursByHeight) {
    Image color(9, 9, Rgba8{200, 40, 10, 255});
    color(0, 0) = {200, 40, 10, 0}; // no imagery
    const auto made = [&](double share) {
        auto terrain = std::make_shared<const terrain::Terrain>(terrain::Terrain{
            "made", test::plane_heightfield(Grid<float>(9, 9, 700.0F)), color, {}, {}});
        scene::TerrainOptions options;
        options.imagery_share = share;
        return lit_map(*scene::TerrainSurface::create(terrain, options), std::nullopt, 4096);
    };
    const Rgba8 tint = made(0.0)(4, 4);
    EXPECT_EQ(made(0.0)(0, 0), tint);
    EXPECT_EQ(made(1.0)(4, 4), (Rgba8{200, 40, 10, 255}));
    for (const double share : {0.1, 0.5, 0.75}) {
        const Image mixed = made(share);
        EXPECT_EQ(mixed(0, 0), tint);
        EXPECT_NEAR(mixed(4, 4).r, glm::mix(static_cast<double>(tint.r), 200.0, share), 1.0);
        EXPECT_NEAR(mixed(4, 4).b, glm::mix(static_cast<double>(tint.b), 10.0, share), 1.0);
        EXPECT_EQ(mixed(4, 4).a, 255);
    }
}

TEST(LitMap, OfAPlaneIsLambertsLaw) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> slopes(-2.0, 2.0);
    std::uniform_real_distribution<double> azimuths(0.0, 360.0);
    const glm::vec3 albedo = linear_from_rgba8({120, 60, 200, 255});
    for (int i = 0; i < 200; ++i) {
        const glm::dvec2 slope(slopes(random), slopes(random));
        const auto made =
            surface(test::plane_heightfield(test::made_heights(
                        9, 9, [&](int col, int row) { return slope.x * col - slope.y * row; })),
                    Image(9, 9, Rgba8{120, 60, 200, 255}));
        scene::TerrainLight light = light_from(azimuths(random), 80.0);
        const glm::dvec3 normal = glm::normalize(glm::dvec3(-slope, 1.0));
        const double sun = std::max(0.0, glm::dot(normal, scene::to_light(light.sun)));
        const auto light_there = static_cast<float>(0.8 * sun + 0.1 * (0.5 + 0.5 * normal.z));
        const Rgba8 lit = lit_map(*made, light, 4096)(4, 4);
        const Rgba8 right = rgba8_from_linear(light_there * albedo);
        if (sun > 0.05) { // a plane that the sun only grazes lies in its own penumbra
            ASSERT_NEAR(lit.r, right.r, 1) << slope.x << ' ' << slope.y;
            ASSERT_NEAR(lit.b, right.b, 1) << slope.x << ' ' << slope.y;
        }
    }
}

TEST(LitMap, HidesTheSunAtAnyResolutionOfTheImagery) {
    const auto heights =
        test::made_heights(65, 65, [](int, int row) { return row == 20 ? 10.0 : 0.0; });
    for (const int side : {65, 17, 129}) {
        const auto made =
            surface(test::plane_heightfield(heights), Image(side, side, Rgba8{255, 255, 255, 255}));
        const Image map = lit_map(*made, light_from(0.0, 45.0), 4096);
        ASSERT_EQ(map.cols(), std::max(side, 65)) << "as fine as the finer one";
        const auto brightness = [&](int row) {
            return linear_from_rgba8(map(map.cols() / 2, row * (map.rows() - 1) / 64)).x;
        };
        const auto level = static_cast<float>(0.8 * std::sqrt(0.5) + 0.1);
        EXPECT_NEAR(brightness(8), level, 0.01F) << "north of the wall, sun in the north";
        EXPECT_NEAR(brightness(25), 0.1F, 0.02F) << "in its shadow";
        EXPECT_NEAR(brightness(48), level, 0.01F);
    }
}

TEST(LitMap, TurnsWithItsNode) {
    const auto made = surface(
        test::plane_heightfield(test::made_heights(17, 17, [](int col, int) { return 0.5 * col; })),
        Image(17, 17, Rgba8{200, 200, 200, 255}));
    scene::TerrainLight turned = light_from(90.0, 60.0);
    turned.world_from_local =
        glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(90.0), glm::dvec3(0.0, 0.0, 1.0)));
    // Turned by 90 degrees from east to north, the slope faces south: the same as sun from there.
    const Image map = lit_map(*made, turned, 4096);
    const Image unturned = lit_map(*made, light_from(180.0, 60.0), 4096);
    EXPECT_NEAR(map(8, 8).g, unturned(8, 8).g, 1);
    EXPECT_NE(map(8, 8), lit_map(*made, light_from(90.0, 60.0), 4096)(8, 8));
}

TEST(LitMap, ShadowsFallAwayFromTheSunWhereTheRowsDoNotRunEast) {
    // A grid on the Earth whose columns run north-east: what it calls east is 45 degrees off.
    const auto heights = test::made_heights(
        65, 65, [](int col, int row) { return col == 32 && row == 32 ? 60.0 : 0.0; });
    const auto made = surface(test::geographic_heightfield(heights, 0.0, 10.0, 1e-4, 45.0),
                              Image(65, 65, Rgba8{255, 255, 255, 255}));
    const Image map = lit_map(*made, light_from(270.0, 45.0), 4096);
    // The sun is in the west, so the shadow falls east: by columns and rows alike.
    EXPECT_LT(map(35, 35).g, map(35, 32).g);
    EXPECT_LT(map(35, 35).g, map(29, 29).g);
}

TEST(LitMap, NoSideIsLongerThanAsked) {
    Image color(300, 40, Rgba8{0, 0, 0, 255});
    color(299, 39) = {255, 255, 255, 255};
    const auto made = surface(test::plane_heightfield(Grid<float>(20, 20, 1.0F)), color);
    const Image map = lit_map(*made, std::nullopt, 64);
    EXPECT_EQ(map.cols(), 64);
    EXPECT_EQ(map.rows(), 40);
    EXPECT_EQ(map(63, 39), color(299, 39)) << "corners stay where they are";
    const Image lit = lit_map(*made, light_from(90.0, 45.0), 8);
    EXPECT_EQ(glm::ivec2(lit.cols(), lit.rows()), glm::ivec2(8, 8));
}

TEST(LitMap, CliffsAreNoNumbersOutOfRange) {
    const auto made = surface(test::plane_heightfield(
        test::made_heights(9, 9, [](int col, int) { return col % 2 == 0 ? 1e30 : -1e30; }),
        {1e-3, 1e-3}));
    const Image map = lit_map(*made, light_from(45.0, 45.0), 4096);
    for (const Rgba8 texel : map.samples()) {
        EXPECT_EQ(texel.a, 255);
    }
}

} // namespace
} // namespace reljef::view
