#pragma once

#if __cplusplus < 202002L
#error "reljef needs C++20: -std=c++20, or target_link_libraries(... reljef::reljef) with CMake"
#endif

namespace reljef {

/// Prints `what` and aborts. For broken preconditions only, never for bad input.
[[noreturn]] void abort_with(const char* what);

inline void check(bool condition, const char* what) {
    if (!condition) {
        abort_with(what);
    }
}

} // namespace reljef
