#pragma once

#include <cstddef>

namespace reljef {

/// Resident bytes without file pages, which the system can reclaim; 0 if unknown.
struct ProcessMemory {
    std::size_t now = 0;
    std::size_t peak = 0; ///< peak, if file pages never were fewer than now
};
ProcessMemory process_memory();

} // namespace reljef
