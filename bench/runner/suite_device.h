#pragma once

#include "bench/runner/suite_options.h"
#include "engine/core/result.h"
#include "engine/session/device.h"

namespace reljef::bench {

/// What a suite draws with, pictures of its size in no window. Fails as app::Device::create.
Result<session::Device> make_device(const SuiteOptions& options);

} // namespace reljef::bench
