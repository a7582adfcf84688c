#pragma once

#if __cplusplus < 202002L
#error "reljef needs C++20: -std=c++20, or target_link_libraries(... reljef::reljef) with CMake"
#endif

#include <cstddef>
#include <optional>

namespace reljef {

/// Prints `what` and aborts. For broken preconditions only, never for bad input.
[[noreturn]] void abort_with(const char* what);

inline void check(bool condition, const char* what) {
    if (!condition) {
        abort_with(what);
    }
}

/// What a pointer that is not null points to.
template <class T> T& checked_pointer(T* pointer, const char* what) {
    check(pointer != nullptr, what);
    return *pointer;
}

/// The whole part of a number; absent if it is NaN or beyond int.
constexpr std::optional<int> checked_int(double value) {
    return value > -2147483649.0 && value < 2147483648.0 ? std::optional(static_cast<int>(value))
                                                         : std::nullopt;
}

/// The whole part of a number, clamped to [low, high]; `low` for NaN.
constexpr int clamped_int(double value, int low, int high) {
    return !(value >= low) ? low : value >= high ? high : static_cast<int>(value);
}

/// Absent if it is beyond std::size_t.
constexpr std::optional<std::size_t> checked_product(std::size_t a, std::size_t b) {
    std::size_t product = 0;
    return __builtin_mul_overflow(a, b, &product) ? std::nullopt : std::optional(product);
}

} // namespace reljef
