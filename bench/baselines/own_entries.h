#pragma once

#include <optional>

#include "bench/baselines/baseline_entry.h"
#include "engine/session/scene_renderer.h"

namespace reljef::bench {

/// The device of OpenGL, and rays on the CPU.
class OwnDevices {
public:
    /// Fails as session::Device::create().
    static Result<OwnDevices> create(const SuiteOptions& options);

    [[nodiscard]] session::SceneRenderer& opengl() { return opengl_->renderer(); }
    [[nodiscard]] session::SceneRenderer& rays() { return rays_->renderer(); }
    [[nodiscard]] const session::Device& device() const { return *opengl_; }

private:
    std::optional<session::Device> opengl_;
    std::optional<session::Device> rays_;
};

/// The rows of reljef in all works. `view` and `devices` must outlive them.
std::vector<BaselineEntry> own_entries(BaselineView& view, OwnDevices& devices);

} // namespace reljef::bench
