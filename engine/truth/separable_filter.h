#pragma once

#include <span>
#include <vector>

#include "engine/core/grid.h"

namespace reljef::truth {

/// One channel of a picture, row 0 at the top.
using Plane = Grid<double>;

/// exp(−x² / 2σ²) at the integers −radius … radius, not normalized. `deviation` in pixels, > 0.
std::vector<double> gaussian(double deviation, int radius);

/// Scales a kernel to sum 1. Precondition: its sum is not 0.
void normalize(std::span<double> kernel);

/// sum[i] += weight · samples[i]. Precondition: equal lengths.
void add_scaled(std::span<double> sum, std::span<const double> samples, double weight);

/// Correlation with a separable kernel: sample (col, row) becomes the sum of along_cols[i] ·
/// along_rows[j] · plane(col + i − r, row + j − s), where r and s are the kernels' radii. Borders
/// are clamped. `threads` 0: as many as the machine has; no influence on the result. Precondition:
/// kernels of odd length.
Plane filtered(const Plane& plane, std::span<const double> along_cols,
               std::span<const double> along_rows, unsigned threads = 0);

} // namespace reljef::truth
