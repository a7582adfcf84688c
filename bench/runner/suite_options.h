#pragma once

#include <filesystem>
#include <optional>

#include <glm/vec2.hpp>

#include "engine/core/parallel_for.h"
#include "engine/platform/context.h"

namespace reljef::bench {

/// What all suites that measure are told.
struct SuiteOptions {
    glm::ivec2 size{1024, 768};
    std::optional<platform::ContextKind> context; ///< absent: EGL on a hardware GPU, else OSMesa
    int threads = 0;                              ///< 0: as many as the machine has
    int rounds = 0; ///< of each measurement; 0: as many as fit in the time, at least 5
    /// Done in a minute; fewer rounds than 5 where they would take longer.
    bool quick = false;
    double quick_seconds = 48.0; ///< of a quick run: the minute, less a slow machine's reserve
    bool quiet = false;          ///< no progress and no notes on stderr
    std::filesystem::path
        shader_dir;          ///< shader files here come before the built-in ones; may be empty
    bool keep_views = false; ///< fills Row::view
    Progress progress;       ///< told beside the line on stderr
};

} // namespace reljef::bench
