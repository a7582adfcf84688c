#include "engine/session/scene_renderer.h"

#include <utility>

namespace reljef::session {

Result<SceneRenderer> SceneRenderer::create(const SceneRendererOptions& options) {
    auto driver = render::Driver::create(options.driver);
    if (!driver) {
        return driver.error();
    }
    return SceneRenderer(std::move(*driver), options);
}

Result<view::FrameStats> SceneRenderer::draw_selected(bool wait) {
    auto stats = driver_.draw(selector_.selected(), wait);
    if (stats) {
        const bool was_drawn = std::exchange(drawn_, selector_.count()) == selector_.count();
        stats->skipped.selections_unchanged = was_drawn ? 1 : 0;
        stats->cpu_ms += was_drawn ? 0.0 : selector_.milliseconds();
    }
    return stats;
}

Result<HitBuffer> SceneRenderer::draw_selected_hits() {
    return driver_.draw_hits(selector_.selected());
}

Result<view::FrameStats> SceneRenderer::draw(const scene::Scene& scene, bool wait) {
    select(scene);
    return draw_selected(wait);
}

Result<HitBuffer> SceneRenderer::draw_hits(const scene::Scene& scene) {
    select(scene);
    return draw_selected_hits();
}

} // namespace reljef::session
