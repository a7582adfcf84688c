#include "engine/cast/simd_target.h"

#include <algorithm>
#include <array>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hwy/targets.h>

#include "engine/cast/packet/block_kernel.h"

namespace reljef::cast {
namespace {

// The fastest first.
constexpr std::array all_targets{SimdTarget{"avx512", HWY_AVX3}, SimdTarget{"avx2", HWY_AVX2},
                                 SimdTarget{"sse4", HWY_SSE4}, SimdTarget{"neon", HWY_NEON},
                                 SimdTarget{"scalar", HWY_SCALAR}};

} // namespace

std::vector<SimdTarget> simd_targets() {
    const std::int64_t possible = compiled_targets() & hwy::SupportedTargets();
    std::vector<SimdTarget> targets;
    std::copy_if(all_targets.begin(), all_targets.end(), std::back_inserter(targets),
                 [&](const SimdTarget& target) { return (target.bit & possible) != 0; });
    return targets;
}

Result<SimdTarget> simd_target(std::string_view name) {
    std::vector<std::string_view> names;
    for (const SimdTarget& target : simd_targets()) {
        if (target.name == name) {
            return target;
        }
        names.push_back(target.name);
    }
    return usage_error(fmt::format("--simd {}: this machine has {}", name, fmt::join(names, ", ")));
}

} // namespace reljef::cast
