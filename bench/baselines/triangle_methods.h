#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "engine/core/grid.h"

namespace reljef::bench {

/// Ways to triangulate 2^n+1 × 2^n+1 heights with an error in mind: the engine's bisection; RTIN,
/// whose errors are those of the middles of longest edges alone (Evans, Kirkpatrick and Townsend
/// 2001, "Right-triangulated irregular networks"); regular patches of 16 cells, each as coarse as
/// it may be, their borders not yet stitched; and greedy insertion.
enum class TriangleMethod { bisection, rtin, patches, greedy };
inline constexpr std::array all_triangle_methods{TriangleMethod::bisection, TriangleMethod::rtin,
                                                 TriangleMethod::patches, TriangleMethod::greedy};
std::string_view to_string(TriangleMethod method);

struct MethodResult {
    std::size_t triangles = 0;
    double worst = 0.0; ///< of any sample from the triangles, vertically, metres
};
/// Precondition: 2^n+1 × 2^n+1 heights of at least 17 × 17, error > 0.
MethodResult triangulate_by(TriangleMethod method, const Grid<float>& heights, double error);

} // namespace reljef::bench
