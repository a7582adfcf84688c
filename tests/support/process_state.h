#pragma once

#include <cstddef>

namespace reljef::test {

/// Bytes of this process that are in memory (VmRSS).
std::size_t resident_bytes();
/// Files, sockets and the like that this process has open.
std::size_t open_files();

/// Whether memory freed is given back as usual: sanitizers keep it for a while to catch its use.
constexpr bool memory_is_plain() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return false;
#else
    return true;
#endif
}

} // namespace reljef::test
