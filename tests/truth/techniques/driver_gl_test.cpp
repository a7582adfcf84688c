// The driver draws the same surface as triangles and lights it through maps: what is left between
// it and the exact picture is small where the maps are as fine as the heights.
#include "engine/render/driver.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/truth/draw.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_scene.h"
#include "tests/session/made_session.h"

namespace reljef::truth {
namespace {

constexpr glm::ivec2 size{160, 120};

class DriverAgainstTruthGlTest : public test::GlTest {
protected:
    static session::SceneRenderer driver() { return test::must(test::make_renderer(size)); }

    // Of all pixels, the share whose hit is a texel or more off, or ground for sky, percent.
    static double wrong_percent(const HitBuffer& drawn, const HitBuffer& exact) {
        int wrong = 0;
        for (std::size_t i = 0; i < drawn.size(); ++i) {
            const Hit& a = drawn.samples()[i];
            const Hit& b = exact.samples()[i];
            const bool same = a.is_sky()
                                  ? b.is_sky()
                                  : !b.is_sky() && std::hypot(a.col - b.col, a.row - b.row) < 1.0F;
            wrong += same ? 0 : 1;
        }
        return 100.0 * wrong / static_cast<double>(drawn.size());
    }

    // Mean difference of a channel, of 255.
    static double mean_difference(const Image& a, const Image& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            const Rgba8 x = a.samples()[i];
            const Rgba8 y = b.samples()[i];
            sum += std::abs(x.r - y.r) + std::abs(x.g - y.g) + std::abs(x.b - y.b);
        }
        return sum / (3.0 * static_cast<double>(a.size()));
    }

    static void expect_alike(const scene::Scene& scene) {
        session::SceneRenderer made = driver();
        test::must(made.draw(scene));
        const Picture exact = draw(scene, size).value();
        EXPECT_LT(mean_difference(made.read_color(), exact.image), 1.5);
        EXPECT_LT(wrong_percent(test::must(made.draw_hits(scene)), exact.hits), 1.0);
    }
};

TEST_F(DriverAgainstTruthGlTest, SunAirAndSkyAreTheSame) {
    scene::Scene scene;
    test::add_terrain(scene, test::plane_heightfield(test::hills(129, 97, 9.0), {2.0, 2.0}));
    scene.add_light();
    scene.set_sky({.visibility = 700.0});
    scene.add_camera(test::camera_at({-20.0, -140.0, 45.0}, {0.0, 0.0, 0.0}));
    expect_alike(scene);
}

TEST_F(DriverAgainstTruthGlTest, ATurnedNodeOrthographicWithoutSkyIsTheSame) {
    scene::Scene scene;
    test::add_terrain(scene, test::plane_heightfield(test::hills(129, 97, 9.0), {2.0, 2.0}))
        .set_parent_from_local(glm::rotate(glm::dmat4(1.0), 0.8, glm::dvec3(0.1, 0.2, 1.0)));
    scene.add_light();
    scene::Camera camera = test::camera_at({0.0, -100.0, 120.0}, {0.0, 0.0, 0.0});
    camera.projection = scene::ProjectionKind::orthographic;
    camera.view_height = 200.0;
    scene.add_camera(camera);
    expect_alike(scene);
}

TEST_F(DriverAgainstTruthGlTest, OnTheEllipsoidItIsTheSame) {
    scene::Scene scene;
    test::add_terrain(scene,
                      test::geographic_heightfield(test::hills(121, 101, 600.0), 46.0, 7.0, 0.004));
    scene.add_light();
    scene.set_sky({.visibility = 60000.0});
    scene.add_camera(test::camera_at({0.0, -25000.0, 9000.0}, {0.0, 0.0, 0.0}));
    expect_alike(scene);
}

} // namespace
} // namespace reljef::truth
