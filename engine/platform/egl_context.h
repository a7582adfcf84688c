#pragma once

#include <memory>

#include "engine/platform/context.h"

namespace reljef::platform {

enum class EglDevices {
    all,
    hardware ///< no display that is known to be drawn on the CPU
};

/// A context without surfaces on the first EGL display that gives one, not current yet. It may be
/// older than 4.5 where there is nothing better; make_current() then says so.
Result<std::unique_ptr<Context>> create_egl_context(const ContextOptions& options,
                                                    EglDevices devices = EglDevices::all);

} // namespace reljef::platform
