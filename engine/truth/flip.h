#pragma once

#include <numbers>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/core/result.h"

namespace reljef::truth {

struct FlipOptions {
    /// Pixels that the viewer sees under a degree of the visual field, at least 1. The default of
    /// the paper, 67.02: a screen 0.7 m wide with 3840 pixels across, seen from 0.7 m.
    double pixels_per_degree = 3840.0 * std::numbers::pi / 180.0;
    unsigned threads = 0; ///< 0: as many as the machine has; the result does not depend on it
};

/// How different two pictures look when they alternate: 0 the same, 1 as different as can be.
struct Flip {
    double mean = 0.0;
    Grid<float> map; ///< one a pixel, in [0,1]
};

/// FLIP for pictures of low dynamic range (Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström
/// and Fairchild 2020, "FLIP: A Difference Evaluator for Alternating Images"). Symmetric in the
/// two pictures; beyond the border lies the nearest pixel; alpha is not looked at. Fails where the
/// pictures are empty or differ in size. Precondition: pixels_per_degree >= 1.
Result<Flip> flip(const Image& shown, const Image& truth, const FlipOptions& options = {});

} // namespace reljef::truth
