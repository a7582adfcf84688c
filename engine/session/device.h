#pragma once

#include <memory>
#include <optional>

#include "engine/platform/context.h"
#include "engine/session/scene_renderer.h"

namespace reljef::session {

struct DeviceOptions {
    /// Absent: EGL where it finds a hardware GPU, else OSMesa.
    std::optional<platform::ContextKind> context;
    platform::ContextOptions context_options;
    SceneRendererOptions renderer; ///< `software` is the context's
    int threads = 0;               ///< of a software renderer; 0: its own choice
};

/// How many threads software contexts made from now on draw with (llvmpipe); 0 changes nothing.
void limit_software_threads(int threads);

/// A context and the renderer that draws with it.
class Device {
public:
    static Result<Device> create(const DeviceOptions& options = {});

    [[nodiscard]] const platform::Context& context() const { return *context_; }
    [[nodiscard]] SceneRenderer& renderer() { return *renderer_; }

private:
    Device() = default;

    std::unique_ptr<platform::Context> context_; // outlives the renderer's GL objects
    std::unique_ptr<SceneRenderer> renderer_;
};

} // namespace reljef::session
