#include "app/device.h"

namespace reljef::app {

Result<Device> Device::create(const DeviceOptions& options) {
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

} // namespace reljef::app
