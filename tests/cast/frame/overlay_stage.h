#pragma once

#include <string_view>
#include <utility>

#include "engine/cast/frame/driver.h"
#include "engine/scene/motion/poses.h"
#include "engine/view/select.h"
#include "tests/cast/made_rays.h"
#include "tests/session/made_session.h"

namespace reljef::cast {

inline constexpr glm::ivec2 overlay_picture{320, 240};

/// Hills of samples 8 m apart, some of them steep, below a sun.
struct OverlayStage : Stage {
    scene::Node* light = nullptr;

    explicit OverlayStage(Grid<float> heights = test::hills(151, 129, 90.0),
                          glm::dvec2 spacing = {8.0, 8.0}, Image color = {})
        : Stage(std::move(heights), spacing, 1.0, std::move(color)) {
        light = &scene.add_light();
        node().material.technique = {scene::Exact{}};
        node().labels_contours = false; // the driver alone draws none
    }
    scene::Light& sun() { return *light->get<scene::Light>(); }
    scene::TerrainNode& node() { return *terrain->get<scene::TerrainNode>(); }
    void set_grain(float strength) { node().grain = strength; }
    void look_from(scene::Pose pose) {
        look(scene::pose_camera(pose, surface().bounds(), [&](double x, double y) {
            return surface().height_at(x, y).value_or(0.0);
        }));
    }
    /// A map of the ground around a place, `metre` metres a pixel.
    void look_down_at(glm::dvec2 place, double metre) {
        scene::Camera map;
        map.projection = scene::ProjectionKind::orthographic;
        map.eye = {place, 500.0};
        map.target = {place, 0.0};
        map.up = {0.0, 1.0, 0.0};
        map.view_height = metre * overlay_picture.y;
        look(map);
    }
    [[nodiscard]] Image drawn(const DriverOptions& options = {.size = overlay_picture}) const {
        Driver driver = test::must(Driver::create(options));
        test::must(driver.draw(view::select(scene, overlay_picture)));
        return driver.read_color();
    }
    /// By a technique of OpenGL, which the stage has from then on.
    [[nodiscard]] Image drawn_by_opengl(std::string_view technique) {
        node().material.technique = test::must(scene::parse_technique(technique));
        session::SceneRenderer opengl = test::must(test::make_renderer(overlay_picture));
        test::must(opengl.draw(scene));
        return opengl.read_color();
    }
    [[nodiscard]] HitBuffer hits() const {
        Driver driver = test::must(Driver::create({.size = overlay_picture}));
        return test::must(driver.draw_hits(view::select(scene, overlay_picture))).hits;
    }
};

} // namespace reljef::cast
