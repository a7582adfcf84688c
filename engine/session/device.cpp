#include "engine/session/device.h"

#include <cstdlib>
#include <string>

namespace reljef::session {

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
