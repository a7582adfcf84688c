#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "engine/render/driver.h"
#include "engine/scene/motion/poses.h"
#include "engine/truth/draw.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_scene.h"
#include "tests/session/made_session.h"

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
        : size_(setting.size), driver_(must(test::make_renderer(setting.size))) {
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

private:
    void choose(const std::string& technique) {
        terrain_->get<scene::TerrainNode>()->material.technique =
            must(scene::parse_technique(technique));
    }

    glm::ivec2 size_;
    session::SceneRenderer driver_;
    scene::Scene scene_;
    scene::Node* terrain_ = nullptr;
    scene::Node* camera_ = nullptr;
};

/// Share of the pixels that show another place than the truth, or one where it shows none, percent.
inline double elsewhere_percent(const HitBuffer& shown, const HitBuffer& truth) {
    int wrong = 0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const Hit& a = shown.samples()[i];
        const Hit& b = truth.samples()[i];
        const bool same = a.is_sky() == b.is_sky() &&
                          (a.is_sky() || std::hypot(a.col - b.col, a.row - b.row) < 1.0F);
        wrong += same ? 0 : 1;
    }
    return 100.0 * wrong / static_cast<double>(shown.size());
}

} // namespace reljef::test
