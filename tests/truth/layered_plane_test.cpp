#include "engine/truth/layered_plane.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/truth/techniques/tile_panel.h"

namespace reljef::truth {
namespace {

// A ray from somewhere around to somewhere in the tile, from above or from beneath.
Ray ray_through_tile(test::Chance& chance) {
    const double from = chance.one_in(2) ? 1.0 : -1.0;
    const glm::dvec3 eye(chance.between(-2.0, 2.0), chance.between(-2.0, 2.0),
                         from * chance.between(0.3, 2.0));
    const glm::dvec3 at(chance.between(-0.5, 0.5), chance.between(-0.5, 0.5), 0.0);
    return {eye, glm::normalize(at - eye)};
}

Grid<glm::vec4> filled_noise(const Grid<float>& heights) {
    Grid<glm::vec4> layers(heights.cols(), heights.rows());
    for (std::size_t i = 0; i < layers.size(); ++i) {
        layers.samples()[i] = {heights.samples()[i], 0.0F, 0.0F, 0.0F};
    }
    return layers;
}

// What is solid all through below its heights is a relief; that one is tested against brute force.
TEST(LayeredPlane, ASolidBelowHeightsIsTheirRelief) {
    test::Chance chance(20);
    for (const Border border : {Border::wrap, Border::clamp, Border::discard}) {
        const Grid<float> heights = noise_tile(9, 13, 21);
        const ReliefOptions options{1.0, 0.2, -0.4, border};
        const auto relief = ReliefPlane::create(heights.view(), options).value();
        const Grid<glm::vec4> layers = filled_noise(heights);
        const auto plane = LayeredPlane::create(layers.view(), options).value();
        int met = 0;
        for (int i = 0; i < 5000; ++i) {
            const Ray ray = ray_through_tile(chance);
            if (ray.origin.z < 0.0) {
                continue;
            }
            const auto expected = relief.first_hit(ray);
            const auto found = plane.first_hit(ray);
            ASSERT_EQ(found.has_value(), expected.has_value()) << i;
            met += found ? 1 : 0;
            if (found) {
                ASSERT_NEAR(found->t, expected->t, 1e-9) << i;
                ASSERT_NEAR(found->height, expected->height, 1e-9);
                ASSERT_EQ(found->layer, 0);
            }
        }
        EXPECT_GT(met, 1000);
    }
}

// Small steps along the ray, over the bilinear layers.
TEST(LayeredPlane, NoRayEntersASolidBeforeItsHit) {
    test::Chance chance(22);
    const Grid<glm::vec4> layers = layered_noise(8, 6, 23);
    const ReliefOptions options{1.0, 0.2, -0.5, Border::wrap};
    const auto plane = LayeredPlane::create(layers.view(), options).value();
    int met = 0;
    for (int i = 0; i < 2000; ++i) {
        const Ray ray = ray_through_tile(chance);
        const auto hit = plane.first_hit(ray);
        const double end = hit ? hit->t : 6.0;
        met += hit ? 1 : 0;
        for (int step = 0; step < 300; ++step) {
            const glm::dvec3 at = ray.at(end * (step + 0.5) / 301.0);
            const glm::dvec4 here =
                layers_at(layers, {at.x + 0.5, 0.5 - at.y}, material::WrapMode::wrap);
            const double height = at.z / 0.2 + 0.5;
            ASSERT_FALSE((height < here.x - 1e-9 && height > here.y + 1e-9) ||
                         (height < here.z - 1e-9 && height > here.w + 1e-9))
                << i << ' ' << step;
        }
        if (hit) {
            const glm::dvec4 here =
                layers_at(layers, hit->texture_coordinate, material::WrapMode::wrap);
            ASSERT_NEAR(hit->height, here[hit->layer], 1e-9);
        }
    }
    EXPECT_GT(met, 1000);
}

TEST(LayeredPlane, BadLayersAreToldWithTheirPlace) {
    Grid<glm::vec4> layers(3, 3, glm::vec4(0.9F, 0.5F, 0.4F, 0.1F));
    layers(2, 1).z = 0.6F;
    EXPECT_THAT(LayeredPlane::create(layers.view(), {}).error().message,
                testing::HasSubstr("column 2, row 1"));
    layers(2, 1).z = 0.4F;
    EXPECT_TRUE(LayeredPlane::create(layers.view(), {}));
    EXPECT_FALSE(LayeredPlane::create(layers.view(), {.scale = -1.0}));
}

} // namespace
} // namespace reljef::truth
