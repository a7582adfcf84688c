#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/hit.h"
#include "engine/core/result.h"
#include "engine/platform/context.h"
#include "engine/render/driver.h"
#include "engine/scene/graph/scene.h"
#include "engine/view/select.h"

namespace reljef::session {

struct SceneRendererOptions {
    render::DriverOptions driver;
    view::SelectOptions select = {};
    bool selects_always = false; ///< see view::FrameSelector
};

/// Draws the frames of a scene with OpenGL, and selects each view once (see view::FrameSelector).
/// Destroy while its context is current.
class SceneRenderer {
public:
    /// Fails if the driver cannot draw the size.
    static Result<SceneRenderer> create(const SceneRendererOptions& options = {});

    /// Selects what the scene's camera sees. Valid until the next call.
    const view::FrameView& select(const scene::Scene& scene) {
        return selector_.select(scene, size());
    }
    /// Draws the frame selected last; `wait`: until it is finished. Precondition: the scene has not
    /// changed since.
    Result<view::FrameStats> draw_selected(bool wait = false);
    Result<view::DrawnHits> draw_selected_hits() { return driver_.draw_hits(selector_.selected()); }

    /// Selects and draws; FrameStats::cpu_ms includes the selection.
    Result<view::FrameStats> draw(const scene::Scene& scene, bool wait = false);
    Result<HitBuffer> draw_hits(const scene::Scene& scene);

    /// Releases the last view, before another scene is opened.
    void forget_scene() { selector_.forget(); }

    [[nodiscard]] view::FrameSelector& selector() { return selector_; }
    /// The last frame drawn. Waits for it.
    [[nodiscard]] Image read_color() const { return driver_.read_color(); }
    /// Copies the last frame to the window's back buffer.
    void show_in_window(glm::ivec2 window_size) const { driver_.show_in_window(window_size); }
    /// Takes the prepared light of a terrain, so that the next frame need not compute it.
    Result<void> add_light(const view::PreparedLight& light) { return driver_.add_light(light); }
    [[nodiscard]] int max_texture_side() const { return driver_.max_texture_side(); }
    Result<void> resize(glm::ivec2 size) { return driver_.resize(size); }
    /// For later frames, see render::DriverOptions::samples.
    void set_samples(int samples) { driver_.set_samples(samples); }
    [[nodiscard]] glm::ivec2 size() const { return driver_.size(); }

private:
    SceneRenderer(render::Driver driver, const SceneRendererOptions& options)
        : driver_(std::move(driver)), selector_(options.select, options.selects_always) {}

    render::Driver driver_;
    view::FrameSelector selector_;
    int drawn_ = 0; // the selection that was drawn last, counted from 1
};

struct DeviceOptions {
    /// Absent: EGL if it finds a hardware GPU, otherwise OSMesa.
    std::optional<platform::ContextKind> context = {};
    glm::ivec2 size{1024, 768};            ///< of the picture, pixels
    std::filesystem::path shader_dir = {}; ///< its files override the built-in shaders
    int samples = 1;                       ///< per pixel, see render::DriverOptions
    int threads = 0;                       ///< of a software renderer; 0: its own choice
    bool selects_always = false;           ///< see SceneRendererOptions
};

/// Sets the threads of software contexts (llvmpipe) created later; 0 changes nothing.
void limit_software_threads(int threads);

/// A context without a visible window, and the renderer that draws with it.
class Device {
public:
    /// Fails without such a context, and as SceneRenderer::create.
    static Result<Device> create(const DeviceOptions& options = {});

    [[nodiscard]] const platform::Context& context() const { return *context_; }
    [[nodiscard]] SceneRenderer& renderer() { return *renderer_; }

private:
    Device() = default;

    std::unique_ptr<platform::Context> context_; // outlives the renderer's GL objects
    std::unique_ptr<SceneRenderer> renderer_;
};

} // namespace reljef::session
