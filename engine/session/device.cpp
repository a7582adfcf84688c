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
    render::DriverOptions driver_options = options.driver;
    driver_options.software = (*context)->is_software();
    auto driver = render::Driver::create(driver_options);
    if (!driver) {
        return driver.error();
    }
    Device device;
    device.context_ = std::move(*context);
    device.driver_ = std::make_unique<render::Driver>(std::move(*driver));
    return device;
}

} // namespace reljef::session
