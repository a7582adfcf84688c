#pragma once

#include "bench/runner/suite_options.h"
#include "engine/core/result.h"
#include "engine/session/device.h"

namespace reljef::bench {

/// The device a suite draws with; it selects each frame anew. Fails as session::Device::create.
Result<session::Device> make_device(const SuiteOptions& options);

} // namespace reljef::bench
