#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include <glm/vec2.hpp>

#include "engine/platform/context.h"
#include "engine/session/scene_renderer.h"

namespace reljef::session {

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
