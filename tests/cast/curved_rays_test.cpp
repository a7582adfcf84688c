#include "engine/cast/curved_rays.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/cast/driver.h"
#include "engine/truth/draw.h"
#include "engine/truth/geometric_error.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_scene.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::cast {
namespace {

constexpr glm::ivec2 curved_size{320, 240};
constexpr int curved_side = 257; // samples

// Mountains and valleys, 200 m to 3 km wide.
Grid<float> mountains() {
    return test::made_heights(curved_side, curved_side, [](int col, int row) {
        return 900.0 + 500.0 * std::sin(0.09 * col) * std::cos(0.07 * row) +
               120.0 * std::sin(0.5 * col + 0.3 * row) + 30.0 * std::sin(1.9 * col - 1.1 * row);
    });
}

// A terrain on the ellipsoid, its corner at a latitude, turned by degrees.
struct EarthStage {
    scene::Scene scene;
    scene::Node* terrain = nullptr;
    scene::Node* camera = nullptr;

    explicit EarthStage(double latitude, double step = 0.001, double turn = 0.0,
                        double exaggeration = 1.0) {
        terrain = &test::add_terrain(
            scene, test::geographic_heightfield(mountains(), latitude, 7.0, step, turn), {},
            {.placement = terrain::PlacementKind::ellipsoid, .exaggeration = exaggeration});
        scene::Polygons bounded;
        bounded.error = 1.0;
        terrain->get<scene::TerrainNode>()->material.technique = scene::Technique{bounded};
        camera = &scene.add_camera({});
    }

    [[nodiscard]] const scene::TerrainSurface& surface() const {
        return test::surface_of(*terrain);
    }
    [[nodiscard]] glm::dvec3 world(glm::dvec3 sample) const {
        return surface().placement().world_from_sample(sample);
    }
    void look(const scene::Camera& at) { *camera->get<scene::Camera>() = at; }

    // From `above` metres over a sample, to a place on the ground.
    void look(glm::dvec2 from, double above, glm::dvec2 to) {
        const auto height = [&](glm::dvec2 sample) {
            return terrain::bilinear_height(
                surface().heightfield().heights.view(),
                glm::clamp(sample, glm::dvec2(0.0), glm::dvec2(curved_side - 1.0)));
        };
        scene::Camera at;
        at.eye = world({from, height(from) + above});
        at.target = world({to, height(to)});
        at.near = 0.01;
        look(at);
    }

    [[nodiscard]] view::DrawnHits drawn() const {
        Driver driver = test::must(Driver::create({.size = curved_size}));
        return test::must(driver.draw_hits(view::select(scene, curved_size)));
    }
    [[nodiscard]] truth::GeometricErrors errors(const HitBuffer& shown) const {
        const truth::SurfaceView view{surface().heightfield().heights.view(), surface().placement(),
                                      terrain->world_from_local(), scene.camera()};
        return test::must(
            truth::geometric_errors(view, shown, test::must(truth::draw_hits(scene, curved_size))));
    }

    void expect_true(const std::string& name, double most) const {
        const view::DrawnHits shown = drawn();
        const truth::GeometricErrors found = errors(shown.hits);
        ASSERT_TRUE(found.reprojection.distribution && shown.stats.kept_error) << name;
        EXPECT_GT(found.reprojection.distribution->count, shown.hits.size() / 50) << name;
        // Where the truth of a pixel is not stable, the next ridge may be hit.
        EXPECT_LE(found.wrong + found.holes + found.reprojection.unbounded,
                  shown.hits.size() / 2000)
            << name;
        EXPECT_LT(found.reprojection.distribution->p99, most) << name;
        EXPECT_LT(found.reprojection.distribution->p99, *shown.stats.kept_error) << name;
        EXPECT_LT(*shown.stats.kept_error, 10.0 * most) << name;
    }
};

TEST(CurvedRays, HitWhatTheTruthHits) {
    for (const double latitude : {45.0, 0.1, -60.0, 85.0}) {
        for (const double above : {0.3, 30.0, 3e3, 2e4}) {
            EarthStage stage(latitude, 0.001, latitude > 0.0 ? 20.0 : 0.0);
            stage.look({120.3, 201.7}, above, {140.0, 40.0});
            stage.expect_true(fmt::format("latitude {}, {} m above", latitude, above),
                              std::abs(latitude) > 80.0 ? 0.05 : 0.01);
        }
    }
}

TEST(CurvedRays, FromFarAwayAreLeftToOpenGl) {
    EarthStage stage(45.0);
    stage.look({120.3, 201.7}, 3e6, {140.0, 40.0});
    EXPECT_NE(obstacle_of(view::select(stage.scene, curved_size).list), "");
    stage.look({120.3, 201.7}, 2e4, {140.0, 40.0});
    EXPECT_EQ(obstacle_of(view::select(stage.scene, curved_size).list), "");
}

} // namespace
} // namespace reljef::cast
