#pragma once

#include <numbers>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/core/result.h"

namespace reljef::truth {

struct FlipOptions {
    /// Pixels per degree of the visual field, >= 1. The paper's default, 67.02, is a screen 0.7 m
    /// wide with 3840 pixels across, seen from 0.7 m.
    double pixels_per_degree = 3840.0 * std::numbers::pi / 180.0;
    unsigned threads = 0; ///< 0: as many as the machine has; no influence on the result
};

/// The visible difference of two alternating pictures: 0 equal, 1 maximal.
struct Flip {
    double mean = 0.0;
    Grid<float> map; ///< per pixel, in [0,1]
};

/// FLIP for low dynamic range (Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild
/// 2020, "FLIP: A Difference Evaluator for Alternating Images"). Symmetric; borders are clamped;
/// alpha is ignored. Fails as check_same_size(). Precondition: pixels_per_degree >= 1.
Result<Flip> flip(const Image& shown, const Image& truth, const FlipOptions& options = {});

/// Fails when the pictures are empty or differ in size.
Result<void> check_same_size(const Image& shown, const Image& truth);

} // namespace reljef::truth
