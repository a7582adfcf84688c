#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include <glm/vec2.hpp>

#include "engine/cast/driver.h"
#include "engine/core/color.h"
#include "engine/core/hit.h"
#include "engine/core/result.h"
#include "engine/platform/context.h"
#include "engine/render/driver.h"
#include "engine/scene/graph/scene.h"
#include "engine/session/options.h"
#include "engine/view/select.h"

namespace reljef::session {

struct SceneRendererOptions {
    /// Of OpenGL, or of rays on the CPU.
    std::variant<render::DriverOptions, cast::DriverOptions> driver;
    view::SelectOptions select = {};
    bool selects_always = false; ///< see view::FrameSelector
};

/// Draws the frames of a scene with OpenGL or by rays on the CPU, and selects each view once (see
/// view::FrameSelector). Destroy while its OpenGL context is current.
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
    Result<view::DrawnHits> draw_selected_hits();

    /// Selects and draws; FrameStats::cpu_ms includes the selection.
    Result<view::FrameStats> draw(const scene::Scene& scene, bool wait = false);
    Result<HitBuffer> draw_hits(const scene::Scene& scene);

    /// Releases the last view, before another scene is opened.
    void forget_scene() { selector_.forget(); }

    [[nodiscard]] view::FrameSelector& selector() { return selector_; }
    /// The last frame drawn. Waits for it.
    [[nodiscard]] Image read_color() const;
    /// Copies the last frame to the window's back buffer. Precondition: OpenGL draws.
    void show_in_window(glm::ivec2 window_size) const;
    /// Takes the prepared light of a terrain, so that the next frame need not compute it.
    Result<void> add_light(const view::PreparedLight& light);
    [[nodiscard]] int max_texture_side() const;
    Result<void> resize(glm::ivec2 size);
    /// For later frames, see render::DriverOptions::samples. Without influence on rays of the CPU.
    void set_samples(int samples);
    [[nodiscard]] glm::ivec2 size() const;

private:
    using Driver = std::variant<render::Driver, cast::Driver>;
    SceneRenderer(Driver driver, const SceneRendererOptions& options)
        : driver_(std::move(driver)), selector_(options.select, options.selects_always) {}

    Driver driver_;
    view::FrameSelector selector_;
    int drawn_ = 0; // the selection that was drawn last, counted from 1
};

struct DeviceOptions {
    /// Absent: EGL if it finds a hardware GPU, otherwise OSMesa.
    std::optional<BackendKind> context = {};
    glm::ivec2 size{1024, 768};            ///< of the picture, pixels
    std::filesystem::path shader_dir = {}; ///< its files override the built-in shaders
    int samples = 1;                       ///< per pixel, see render::DriverOptions
    int threads = 0;                       ///< of a software renderer; 0: its own choice
    std::string simd = {};                 ///< of rays on the CPU (cast/simd_target.h); empty: best
    bool selects_always = false;           ///< see SceneRendererOptions
};

/// Sets the threads of software contexts (llvmpipe) created later; 0 changes nothing.
void limit_software_threads(int threads);

/// A renderer, and the context without a visible window that it draws with, if OpenGL draws.
class Device {
public:
    /// Fails without such a context, and as SceneRenderer::create.
    static Result<Device> create(const DeviceOptions& options = {});

    [[nodiscard]] const platform::RendererInfo& info() const { return info_; }
    [[nodiscard]] SceneRenderer& renderer() { return *renderer_; }

private:
    Device() = default;

    static Result<Device> create_with_rays(const DeviceOptions& options);

    platform::RendererInfo info_;
    std::unique_ptr<platform::Context> context_; // outlives the renderer's GL objects; null: no GL
    std::unique_ptr<SceneRenderer> renderer_;
};

} // namespace reljef::session
