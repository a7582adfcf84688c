#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "bench/results.h"

namespace reljef::bench {

struct TablesOptions {
    std::vector<std::string> terrains{"natural", "urban"};
    /// Beside texture, which is always measured; empty: every technique as it is by default.
    std::vector<scene::Technique> techniques;
    glm::ivec2 size{1024, 768};
    std::optional<platform::ContextKind> context; ///< absent: EGL on a hardware GPU, else OSMesa
    int threads = 0;                              ///< 0: as many as the machine has
    int rounds = 0;                               ///< 0: as many as fit in the time, at least 5
    /// Ten seconds of measuring in all instead of twenty a terrain; fewer rounds than 5 where they
    /// would take beyond half a minute.
    bool quick = false;
    bool quiet = false; ///< no progress and no notes on stderr
};

/// Measures every technique on every terrain with the whole terrain in view. The terrains are
/// opened before anything is measured. A run that is stopped or fails on the way keeps the rows it
/// has, and says why in Results::stopped.
Results run_tables(const TablesOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
