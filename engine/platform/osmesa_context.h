#pragma once

#include <memory>

#include "engine/platform/context.h"

namespace reljef::platform {

/// A context of Mesa's off-screen library, not current yet. It may be older than 4.5; then
/// make_current() fails.
Result<std::unique_ptr<Context>> create_osmesa_context();

} // namespace reljef::platform
