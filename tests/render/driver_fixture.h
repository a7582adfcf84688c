#pragma once

#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/render/driver.h"
#include "engine/scene/motion/poses.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_scene.h"
#include "tests/session/made_session.h"

namespace reljef::render {

using scene::Camera;
using scene::Node;
using scene::Scene;
using test::camera_at;
using test::surface_of;

constexpr glm::ivec2 size{320, 240};
constexpr double infinity = std::numeric_limits<double>::infinity();

class DriverGlTest : public test::GlTest {
protected:
    static session::SceneRenderer driver(glm::ivec2 picture = size) {
        return test::must(test::make_renderer(picture));
    }
    static Image draw(const Scene& scene) {
        session::SceneRenderer made = driver();
        test::must(made.draw(scene));
        return made.read_color();
    }
};

inline int brightness(Rgba8 color) {
    return color.r + color.g + color.b;
}

inline Camera pose(scene::Pose which, const Node& node) {
    const auto& surface = surface_of(node);
    return scene::pose_camera(which, surface.bounds(), [&](double x, double y) {
        return surface.height_at(x, y).value_or(0.0);
    });
}

// A bumpy square of nine tiles, 300 m wide, with sun and sky.
struct World {
    Scene scene;
    Node* terrain = nullptr;
    Node* camera = nullptr;

    explicit World(double exaggeration = 1.0) {
        terrain = &test::add_terrain(scene, test::plane_heightfield(test::hills(301, 301, 12.0)),
                                     {}, {.placement = {}, .exaggeration = exaggeration});
        camera = &scene.add_camera(pose(scene::Pose::overview, *terrain));
        scene.add_light();
        scene.set_sky({});
    }
    void look(const Camera& at) { *camera->get<Camera>() = at; }
};

} // namespace reljef::render
