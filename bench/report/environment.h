#pragma once

#include <string>

#include "engine/platform/context.h"

namespace reljef::bench {

/// On what a measurement was made; figures of different environments are not comparable.
struct Environment {
    std::string renderer; ///< GL_RENDERER
    std::string gl;       ///< GL_VERSION
    std::string context;  ///< "osmesa", "egl", "glfw"
    unsigned threads = 1; ///< a software renderer may use
    std::string cpu;      ///< model name; "unknown" where the system does not tell
    std::string commit;   ///< of the sources when the build was configured; "unknown" without git
};

/// `threads` as asked for; 0: LP_NUM_THREADS, which llvmpipe obeys, else as many as the machine
/// has.
Environment environment_of(const platform::Context& context, int threads);

} // namespace reljef::bench
