#pragma once

#include "app/device.h"
#include "bench/suite_options.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// What a suite draws with, pictures of its size in no window. Fails as app::Device::create.
Result<app::Device> make_device(const SuiteOptions& options);

} // namespace reljef::bench
