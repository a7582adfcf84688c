#pragma once

#include <cstddef>

namespace reljef {

/// What this process has of the machine's memory for itself, bytes; 0 where the system does not
/// tell. Pages of programs and files are left out: the system takes them back when it needs them.
struct ProcessMemory {
    std::size_t now = 0;
    std::size_t most = 0; ///< since it began, as far as the pages left out were never fewer
};
ProcessMemory process_memory();

} // namespace reljef
