#include "engine/session/scene_renderer.h"

#include <cstdlib>
#include <string>
#include <utility>

#include "engine/cast/simd_target.h"
#include "engine/core/check.h"

namespace reljef::session {
namespace {

// Precondition: OpenGL draws.
platform::ContextKind context_kind(BackendKind kind) {
    const auto found = platform::context_kind_from_string(to_string(kind));
    reljef::check(found.has_value(), "a context of OpenGL was expected");
    return *found;
}

// Of all rays of the process; empty: the fastest target.
Result<void> pin_simd(const std::string& name) {
    if (name.empty()) {
        return {};
    }
    const auto target = cast::simd_target(name);
    if (!target) {
        return target.error();
    }
    cast::pin_simd_target(*target);
    return {};
}

} // namespace

Result<SceneRenderer> SceneRenderer::create(const SceneRendererOptions& options) {
    const auto with = [&](auto driver) {
        return driver ? Result<SceneRenderer>(SceneRenderer(std::move(*driver), options))
                      : Result<SceneRenderer>(driver.error());
    };
    const auto* const rays = std::get_if<cast::DriverOptions>(&options.driver);
    return rays != nullptr
               ? with(cast::Driver::create(*rays))
               : with(render::Driver::create(std::get<render::DriverOptions>(options.driver)));
}

Result<view::DrawnHits> SceneRenderer::draw_selected_hits() {
    return std::visit([&](auto& driver) { return driver.draw_hits(selector_.selected()); },
                      driver_);
}

Image SceneRenderer::read_color() const {
    return std::visit([](const auto& driver) -> Image { return driver.read_color(); }, driver_);
}

void SceneRenderer::show_in_window(glm::ivec2 window_size) const {
    const auto* const opengl = std::get_if<render::Driver>(&driver_);
    reljef::check(opengl != nullptr, "a window shows what OpenGL draws");
    opengl->show_in_window(window_size);
}

Result<void> SceneRenderer::add_light(const view::PreparedLight& light) {
    return std::visit([&](auto& driver) { return driver.add_light(light); }, driver_);
}

int SceneRenderer::max_texture_side() const {
    return std::visit([](const auto& driver) { return driver.max_texture_side(); }, driver_);
}

Result<void> SceneRenderer::resize(glm::ivec2 size) {
    return std::visit([&](auto& driver) { return driver.resize(size); }, driver_);
}

void SceneRenderer::set_samples(int samples) {
    if (auto* const opengl = std::get_if<render::Driver>(&driver_)) {
        opengl->set_samples(samples);
    }
}

glm::ivec2 SceneRenderer::size() const {
    return std::visit([](const auto& driver) { return driver.size(); }, driver_);
}

Result<view::FrameStats> SceneRenderer::draw_selected(bool wait) {
    const view::FrameView& frame = selector_.selected();
    auto* const opengl = std::get_if<render::Driver>(&driver_);
    auto stats =
        opengl != nullptr ? opengl->draw(frame, wait) : std::get<cast::Driver>(driver_).draw(frame);
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

Result<Device> Device::create_with_rays(const DeviceOptions& options) {
    if (auto pinned = pin_simd(options.simd); !pinned) {
        return pinned.error();
    }
    auto renderer = SceneRenderer::create(
        {.driver = cast::DriverOptions{.size = options.size,
                                       .threads = static_cast<unsigned>(options.threads),
                                       .samples = options.samples},
         .selects_always = options.selects_always});
    if (!renderer) {
        return renderer.error();
    }
    Device device;
    device.info_ = {.renderer = "exact rays on the CPU",
                    .version = options.simd.empty() ? std::string(cast::simd_targets().front().name)
                                                    : options.simd,
                    .context = std::string(to_string(BackendKind::cpu)),
                    .is_software = true};
    device.renderer_ = std::make_unique<SceneRenderer>(std::move(*renderer));
    return device;
}

Result<Device> Device::create(const DeviceOptions& options) {
    if (options.context == BackendKind::cpu) {
        return create_with_rays(options);
    }
    limit_software_threads(options.threads);
    const platform::ContextOptions hidden{.size = options.size, .visible = false};
    auto context = options.context ? platform::make_context(context_kind(*options.context), hidden)
                                   : platform::make_headless_context(hidden);
    if (!context) {
        return context.error();
    }
    auto renderer = SceneRenderer::create(
        {.driver = render::DriverOptions{.size = options.size,
                                         .shader_dir = options.shader_dir,
                                         .software = (*context)->is_software(),
                                         .samples = options.samples},
         .selects_always = options.selects_always});
    if (!renderer) {
        return renderer.error();
    }
    Device device;
    device.info_ = platform::info_of(**context);
    device.context_ = std::move(*context);
    device.renderer_ = std::make_unique<SceneRenderer>(std::move(*renderer));
    return device;
}

} // namespace reljef::session
