#include "engine/render/terrain_maps.h"

#include <cmath>

#include <glm/packing.hpp>
#include <gtest/gtest.h>

#include "tests/render/made_scene.h"

namespace reljef::render {
namespace {

std::shared_ptr<const scene::TerrainSurface> surface(terrain::Heightfield heightfield,
                                                     Image color = {}) {
    auto terrain = std::make_shared<const terrain::Terrain>(
        terrain::Terrain{"made", std::move(heightfield), std::move(color), {}});
    return std::make_shared<const scene::TerrainSurface>(
        scene::TerrainSurface::create(std::move(terrain)).value());
}

TEST(ColorMap, WithoutASunItIsTheImageryItself) {
    Image color(7, 5, Rgba8{10, 20, 30, 255});
    color(6, 0) = {200, 0, 0, 255};
    const auto made = surface(test::plane_heightfield(Grid<float>(33, 9, 1.0F)), color);
    EXPECT_EQ(color_map(*made, std::nullopt, 4096), color);
}

TEST(ColorMap, HasTheSunsShareInAlphaAtAnyResolution) {
    const auto heights =
        test::made_heights(65, 65, [](int, int row) { return row == 20 ? 10.0 : 0.0; });
    for (const int side : {65, 17, 129}) {
        const auto made =
            surface(test::plane_heightfield(heights), Image(side, side, Rgba8{1, 2, 3, 255}));
        const Image map = color_map(*made, glm::dvec3(0.0, 1.0, 1.0), 4096);
        const auto alpha = [&](int row) { return map(side / 2, row * (side - 1) / 64).a; };
        EXPECT_EQ(alpha(8), 255) << "north of the wall, sun in the north";
        EXPECT_LT(alpha(24), 30) << "in its shadow";
        EXPECT_EQ(alpha(48), 255);
        EXPECT_EQ(map(3, 3).g, 2);
    }
}

TEST(ColorMap, NoSideIsLongerThanAsked) {
    Image color(300, 40, Rgba8{0, 0, 0, 255});
    color(299, 39) = {255, 255, 255, 255};
    const auto made = surface(test::plane_heightfield(Grid<float>(20, 20, 1.0F)), color);
    const Image map = color_map(*made, std::nullopt, 64);
    EXPECT_EQ(map.cols(), 64);
    EXPECT_EQ(map.rows(), 40);
    EXPECT_EQ(map(63, 39), color(299, 39)) << "corners stay where they are";
    EXPECT_EQ(gradient_map(*made, 8).cols(), 8);
}

TEST(GradientMap, PacksEastAndNorthAsHalves) {
    const auto made = surface(test::plane_heightfield(
        test::made_heights(9, 9, [](int col, int row) { return 0.5 * col - 2.0 * row; })));
    const Grid<std::uint32_t> map = gradient_map(*made, 4096);
    for (const std::uint32_t texel : map.samples()) {
        EXPECT_EQ(glm::unpackHalf2x16(texel), glm::vec2(0.5F, 2.0F));
    }
}

TEST(GradientMap, StaysFiniteOnCliffs) {
    const auto made = surface(test::plane_heightfield(
        test::made_heights(9, 9, [](int col, int) { return col % 2 == 0 ? 1e30 : -1e30; }),
        {1e-3, 1e-3}));
    const Grid<std::uint32_t> map = gradient_map(*made, 4096);
    for (const std::uint32_t texel : map.samples()) {
        const glm::vec2 gradient = glm::unpackHalf2x16(texel);
        EXPECT_TRUE(std::isfinite(gradient.x) && std::isfinite(gradient.y));
    }
}

} // namespace
} // namespace reljef::render
