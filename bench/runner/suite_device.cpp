#include "bench/runner/suite_device.h"

namespace reljef::bench {

Result<session::Device> make_device(const SuiteOptions& options) {
    session::DeviceOptions device;
    device.threads = options.threads;
    device.context = options.context;
    device.context_options.size = options.size;
    device.context_options.visible = false;
    device.renderer.driver.size = options.size;
    device.renderer.driver.shader_dir = options.shader_dir;
    device.renderer.selects_always = true;
    return session::Device::create(device);
}

} // namespace reljef::bench
