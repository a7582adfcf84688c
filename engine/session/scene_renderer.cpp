#include "engine/session/scene_renderer.h"

#include <chrono>
#include <utility>

namespace reljef::session {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

} // namespace

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
    }
    return stats;
}

Result<HitBuffer> SceneRenderer::draw_selected_hits() {
    return driver_.draw_hits(selector_.selected());
}

Result<view::FrameStats> SceneRenderer::draw(const scene::Scene& scene, bool wait) {
    const auto start = Clock::now();
    select(scene);
    const double select_ms = milliseconds_since(start);
    auto stats = draw_selected(wait);
    if (stats) {
        stats->cpu_ms += select_ms;
    }
    return stats;
}

Result<HitBuffer> SceneRenderer::draw_hits(const scene::Scene& scene) {
    select(scene);
    return draw_selected_hits();
}

} // namespace reljef::session
