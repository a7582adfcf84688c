#pragma once

namespace reljef {

/// Prints `what` and aborts: for broken preconditions, never for bad input.
[[noreturn]] void abort_with(const char* what);

inline void check(bool condition, const char* what) {
    if (!condition) {
        abort_with(what);
    }
}

} // namespace reljef
