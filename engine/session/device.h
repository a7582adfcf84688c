#pragma once

#include <memory>
#include <optional>

#include "engine/platform/context.h"
#include "engine/render/driver.h"

namespace reljef::session {

struct DeviceOptions {
    /// Absent: EGL where it finds a hardware GPU, else OSMesa.
    std::optional<platform::ContextKind> context;
    platform::ContextOptions context_options;
    render::DriverOptions driver;
    int threads = 0; ///< of a software renderer; 0: its own choice
};

/// How many threads software contexts made from now on draw with (llvmpipe); 0 changes nothing.
void limit_software_threads(int threads);

/// A context and the driver that draws with it.
class Device {
public:
    static Result<Device> create(const DeviceOptions& options = {});

    [[nodiscard]] const platform::Context& context() const { return *context_; }
    [[nodiscard]] render::Driver& driver() { return *driver_; }

private:
    Device() = default;

    std::unique_ptr<platform::Context> context_; // outlives the driver's GL objects
    std::unique_ptr<render::Driver> driver_;
};

} // namespace reljef::session
