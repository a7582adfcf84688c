#pragma once

#include <cstddef>

namespace reljef {

/// Resident memory of this process without file pages, bytes; 0 if unknown. File pages do not count
/// because the system can reclaim them.
struct ProcessMemory {
    std::size_t now = 0;
    std::size_t most = 0; ///< peak, if file pages never were fewer than now
};
ProcessMemory process_memory();

} // namespace reljef
