#include "engine/session/scene_renderer.h"

#include <chrono>
#include <utility>

#include "engine/core/check.h"

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

const view::FrameView& SceneRenderer::select(const scene::Scene& scene) {
    const auto start = Clock::now();
    const bool has_changed = view_.look(scene, size());
    if (has_changed || !frame_ || options_.selects_always) {
        frame_ = view::select(view_, options_.select);
        was_drawn_ = false;
        ++selections_;
    }
    select_ms_ = milliseconds_since(start);
    return *frame_;
}

Result<view::FrameStats> SceneRenderer::draw_selected(bool wait) {
    check(frame_.has_value(), "a selected frame was expected");
    frame_->list.stats.skipped.selections_unchanged = was_drawn_ ? 1 : 0;
    was_drawn_ = true;
    auto stats = driver_.draw(*frame_, wait);
    if (stats) {
        stats->cpu_ms += std::exchange(select_ms_, 0.0);
    }
    return stats;
}

Result<HitBuffer> SceneRenderer::draw_selected_hits() {
    check(frame_.has_value(), "a selected frame was expected");
    return driver_.draw_hits(*frame_);
}

Result<view::FrameStats> SceneRenderer::draw(const scene::Scene& scene, bool wait) {
    select(scene);
    return draw_selected(wait);
}

Result<HitBuffer> SceneRenderer::draw_hits(const scene::Scene& scene) {
    select(scene);
    return draw_selected_hits();
}

void SceneRenderer::forget_scene() {
    view_ = {};
    frame_.reset();
}

} // namespace reljef::session
