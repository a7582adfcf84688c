#include "engine/view/choice/view_probes.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/view/select.h"
#include "tests/render/made_scene.h"

namespace reljef::view {
namespace {

constexpr glm::ivec2 probed_size{640, 480};

struct ProbedScene {
    scene::Scene scene;
    DrawList list;

    ProbedScene(Grid<float> heights, glm::dvec3 eye, double fov = 60.0) {
        scene::Node& node =
            test::add_terrain(scene, test::plane_heightfield(std::move(heights), {10.0, 10.0}));
        node.get<scene::TerrainNode>()->material.technique =
            scene::parse_technique("auto:error=1").value();
        scene.add_camera(test::camera_at(eye, {0.0, 0.0, 0.0})).get<scene::Camera>()->vertical_fov =
            fov;
        list = view::select(scene, probed_size, {}).list;
    }
    [[nodiscard]] const TerrainDraw& draw() const { return list.terrains.front(); }
    [[nodiscard]] ProbedView exact() const { return probe_view(list, draw(), nullptr); }
    [[nodiscard]] ProbedView counted() const {
        const ProbedSurface surface(*draw().terrain->surface);
        return probe_view(list, draw(), &surface);
    }
};

double pixels_of(const ProbedView& probed) {
    double pixels = 0.0;
    for (const auto& [tile, shown] : probed.tile_pixels) {
        pixels += shown;
    }
    return pixels;
}

TEST(ViewProbes, RaysAreThoseOfTheirPixels) {
    for (const double fov : {1.0, 60.0, 120.0}) {
        const ProbedScene scene(test::hills(261, 261, 60.0), {300.0, -1500.0, 400.0}, fov);
        const ProbedView probed = scene.exact();
        ASSERT_FALSE(probed.of_box.empty());
        for (const ProbeRay& probe : probed.of_box) {
            const Ray expected = scene::view_ray(scene.list.camera, probed_size, probe.pixel);
            EXPECT_EQ(probe.ray.origin, expected.origin);
            const double scale = glm::length(expected.direction);
            EXPECT_LT(glm::distance(probe.ray.direction, expected.direction), 1e-14 * scale * 16.0);
        }
    }
}

TEST(ViewProbes, FewerRaysAndSamplesShowAboutTheSamePixels) {
    const double all = static_cast<double>(probed_size.x) * probed_size.y;
    for (const double height : {120.0, 400.0, 3000.0}) {
        for (const bool has_towers : {false, true}) {
            Grid<float> heights = test::hills(400, 389, 60.0);
            for (int row = 40; has_towers && row < 360; ++row) {
                for (int col = 40; col < 360; ++col) {
                    heights(col, row) += (col / 12 + row / 12) % 3 == 0 ? 80.0F : 0.0F;
                }
            }
            const ProbedScene scene(std::move(heights), {0.0, -1900.0, height});
            const ProbedView exact = scene.exact();
            const ProbedView counted = scene.counted();
            EXPECT_EQ(exact.of_box.size(), counted.of_box.size());
            EXPECT_NEAR(pixels_of(exact), pixels_of(counted), 0.03 * all);
            for (const auto& [tile, pixels] : exact.tile_pixels) {
                const auto found = counted.tile_pixels.find(tile);
                const double about = found == counted.tile_pixels.end() ? 0.0 : found->second;
                EXPECT_NEAR(pixels, about, 0.03 * all) << height << " " << has_towers;
            }
        }
    }
}

// From above its middle, a terrain of any size fills the same pixels by all samples and by few.
TEST(ViewProbes, FewerSamplesCoverTheWholeTerrain) {
    for (int side = 2; side <= 12; ++side) {
        const double metres = 10.0 * (side - 1);
        const ProbedScene scene(Grid<float>(side, side, 5.0F), {0.0, -0.1 * metres, 2.0 * metres});
        const double all = static_cast<double>(probed_size.x) * probed_size.y;
        EXPECT_GT(pixels_of(scene.exact()), 0.05 * all) << side;
        EXPECT_NEAR(pixels_of(scene.exact()), pixels_of(scene.counted()), 0.02 * all) << side;
    }
}

} // namespace
} // namespace reljef::view
