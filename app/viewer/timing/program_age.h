#pragma once

#include "engine/core/result.h"

namespace reljef::app {

/// Seconds since the system began this process, exact to 0.01 s. Fails if /proc does not tell.
Result<double> program_age();

} // namespace reljef::app
