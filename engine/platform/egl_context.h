#pragma once

#include <memory>

#include "engine/platform/context.h"

namespace reljef::platform {

enum class EglDevices {
    all,
    hardware ///< without known CPU rasterizers
};

/// A context without surfaces on the first EGL display that has one, not current yet. It may be
/// older than 4.5; then make_current() fails.
Result<std::unique_ptr<Context>> create_egl_context(const ContextOptions& options,
                                                    EglDevices devices = EglDevices::all);

} // namespace reljef::platform
