#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"

namespace reljef::cast {

/// An instruction set that the rays are compiled for. The same binary and target give the same
/// bits.
struct SimdTarget {
    std::string_view name; ///< as on the command line
    std::int64_t bit = 0;  ///< Highway's

    friend bool operator==(const SimdTarget&, const SimdTarget&) = default;
};

/// Those that this machine supports, the fastest first.
std::vector<SimdTarget> simd_targets();

/// Fails unless this machine supports the target, and names those that it does.
Result<SimdTarget> simd_target(std::string_view name);

} // namespace reljef::cast
