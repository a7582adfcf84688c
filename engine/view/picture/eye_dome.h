#pragma once

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"
#include "engine/view/draw_list.h"

namespace reljef::view {

/// How far away pixels are compared at most: parts of a picture need as wide a margin.
inline constexpr int max_eye_dome_reach = 28;

/// Darkens pixels that lie behind their surroundings: valleys, feet of walls, and ground behind
/// ridges, by DrawList::eye_dome at most (eye-dome lighting: C. Boucheny, doctoral thesis, Grenoble
/// 2009). Here a pixel is compared with the line through two opposite neighbours, so planes keep
/// their colours at any angle. The sky keeps its colours. `depths`: Hit::depth of the
/// picture's pixels. Precondition: equal sizes.
void shade_eye_dome(GridView<Rgba8> picture, const Grid<float>& depths, const DrawList& list,
                    const ParallelOptions& parallel = {});

} // namespace reljef::view
