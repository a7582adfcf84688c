#pragma once

#include <optional>
#include <string>
#include <utility>

#include "engine/render/driver.h"
#include "engine/scene/poses.h"
#include "engine/truth/draw.h"
#include "engine/truth/geometric_error.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_scene.h"

namespace reljef::test {

/// What is looked at.
struct ReliefSetting {
    glm::dvec2 spacing{2.0, 2.0};
    std::optional<scene::Light> light{};
    glm::ivec2 size{320, 240};
    double exaggeration = 1.0;
    Image color{}; ///< empty: white
};

/// A terrain over a plane, drawn with one technique or another. Needs a context.
class ReliefStage {
public:
    explicit ReliefStage(Grid<float> heights, const ReliefSetting& setting = {})
        : size_(setting.size), driver_(must(render::Driver::create(
                                   {.size = setting.size, .shader_dir = {}, .software = true}))) {
        const Image white(heights.cols(), heights.rows(), Rgba8{255, 255, 255, 255});
        terrain_ = &add_terrain(
            scene_, plane_heightfield(std::move(heights), setting.spacing),
            setting.color.empty() ? white : setting.color,
            {.placement = terrain::PlacementKind::plane, .exaggeration = setting.exaggeration});
        camera_ = &scene_.add_camera({});
        if (setting.light) {
            scene_.add_light(*setting.light);
        }
        look(scene::Pose::overview);
    }

    void look(scene::Pose pose) {
        const auto& surface = surface_of(*terrain_);
        look(scene::pose_camera(pose, surface.bounds(), [&](double x, double y) {
            return surface.height_at(x, y).value_or(0.0);
        }));
    }
    void look(const scene::Camera& camera) { *camera_->get<scene::Camera>() = camera; }

    [[nodiscard]] scene::Scene& scene() { return scene_; }
    [[nodiscard]] const scene::Camera& camera() const { return *camera_->get<scene::Camera>(); }
    [[nodiscard]] const scene::TerrainSurface& surface() const { return surface_of(*terrain_); }
    [[nodiscard]] glm::ivec2 size() const { return size_; }

    HitBuffer hits(const std::string& technique) {
        choose(technique);
        return must(driver_.draw_hits(scene_));
    }
    Image image(const std::string& technique) {
        choose(technique);
        must(driver_.draw(scene_));
        return driver_.read_color();
    }
    [[nodiscard]] HitBuffer true_hits() const { return truth::draw_hits(scene_, size_).value(); }
    [[nodiscard]] Image true_image(const truth::DrawOptions& options) const {
        return truth::draw(scene_, size_, options).value().image;
    }
    truth::GeometricErrors errors(const std::string& technique) {
        const truth::SurfaceView view{surface().heightfield().heights.view(), surface().placement(),
                                      terrain_->world_from_local(), scene_.camera()};
        return truth::geometric_errors(view, hits(technique), true_hits()).value();
    }

private:
    void choose(const std::string& technique) {
        terrain_->get<scene::TerrainNode>()->material.technique =
            must(scene::parse_technique(technique));
    }

    glm::ivec2 size_;
    render::Driver driver_;
    scene::Scene scene_;
    scene::Node* terrain_ = nullptr;
    scene::Node* camera_ = nullptr;
};

} // namespace reljef::test
