#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <glm/vec2.hpp>

#include "engine/core/parallel_for.h"
#include "engine/session/options.h"

namespace reljef::bench {

/// Options of all suites that measure.
struct SuiteOptions {
    glm::ivec2 size{1024, 768};
    std::optional<session::BackendKind> context; ///< absent: EGL on a hardware GPU, else OSMesa
    std::filesystem::path calibration; ///< costs that `auto` chooses by; empty: the built-in ones
    std::string simd;                  ///< instruction set of rays on the CPU; empty: the fastest
    int threads = 0;                   ///< 0: all of the machine
    int rounds = 0;                    ///< of each measurement; 0: as many as fit, at least 5
    bool moving = false;               ///< the view moves from frame to frame, see MovingView
    bool cold = false;                 ///< each frame is drawn as the first one of its view
    bool quick = false;                ///< ends within a minute, with fewer rounds if necessary
    double quick_seconds = 48.0;       ///< of a quick run; the rest of the minute is a reserve
    bool quiet = false;                ///< no progress and no notes on stderr
    std::filesystem::path shader_dir;  ///< its files replace built-in shaders; may be empty
    bool keep_views = false;           ///< sets Row::view
    Progress progress;                 ///< called besides the progress line
};

} // namespace reljef::bench
