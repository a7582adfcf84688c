#pragma once

#include <memory>

#include "engine/platform/context.h"

namespace reljef::platform {

/// A context of Mesa's off-screen library, not current yet. It may be older than 4.5 where the
/// library has nothing better; make_current() then says so.
Result<std::unique_ptr<Context>> create_osmesa_context();

} // namespace reljef::platform
