#include "engine/session/scene_renderer.h"

#include <cstdlib>
#include <string>
#include <utility>

namespace reljef::session {

Result<SceneRenderer> SceneRenderer::create(const SceneRendererOptions& options) {
    auto driver = render::Driver::create(options.driver);
    return driver ? Result<SceneRenderer>(SceneRenderer(std::move(*driver), options))
                  : driver.error();
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

Result<view::FrameStats> SceneRenderer::draw(const scene::Scene& scene, bool wait) {
    select(scene);
    return draw_selected(wait);
}

Result<HitBuffer> SceneRenderer::draw_hits(const scene::Scene& scene) {
    select(scene);
    auto drawn = draw_selected_hits();
    return drawn ? Result<HitBuffer>(std::move(drawn->hits)) : drawn.error();
}

void limit_software_threads(int threads) {
    if (threads > 0) {
        ::setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
    }
}

Result<Device> Device::create(const DeviceOptions& options) {
    limit_software_threads(options.threads);
    const platform::ContextOptions hidden{.size = options.size, .visible = false};
    auto context = options.context ? platform::make_context(*options.context, hidden)
                                   : platform::make_headless_context(hidden);
    if (!context) {
        return context.error();
    }
    auto renderer = SceneRenderer::create({.driver = {.size = options.size,
                                                      .shader_dir = options.shader_dir,
                                                      .software = (*context)->is_software(),
                                                      .samples = options.samples},
                                           .selects_always = options.selects_always});
    if (!renderer) {
        return renderer.error();
    }
    Device device;
    device.context_ = std::move(*context);
    device.renderer_ = std::make_unique<SceneRenderer>(std::move(*renderer));
    return device;
}

} // namespace reljef::session
