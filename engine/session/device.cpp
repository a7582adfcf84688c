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
    auto context = options.context
                       ? platform::make_context(*options.context, options.context_options)
                       : platform::make_headless_context(options.context_options);
    if (!context) {
        return context.error();
    }
    SceneRendererOptions renderer_options = options.renderer;
    renderer_options.driver.software = (*context)->is_software();
    auto renderer = SceneRenderer::create(renderer_options);
    if (!renderer) {
        return renderer.error();
    }
    Device device;
    device.context_ = std::move(*context);
    device.renderer_ = std::make_unique<SceneRenderer>(std::move(*renderer));
    return device;
}

} // namespace reljef::session
