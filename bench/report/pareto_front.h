#pragma once

#include <span>
#include <vector>

#include "bench/report/results.h"

namespace reljef::bench {

/// A row with holes in a larger share of its pixels is on no front.
inline constexpr double max_holes = 1e-3;

/// The front of one scene and pose: the settings that no other setting dominates. A setting
/// dominates another if its error (RMS reprojection error) is no larger and its median time is
/// shorter by more than both noise floors; without both floors it dominates nothing. Null rows,
/// rows without a reprojection error and rows with unbounded pixels are skipped; rows with more
/// than max_holes are skipped and listed.
///
/// The area is absent if a ratio to texture is. With E(r) the smallest error of the settings whose
/// ratio is at most r (max_error if there is none), clamped to [min_error, max_error] = [1e-3, 1e3]
/// pixels, and the ratios in [min_ratio, max_ratio] = [0.1, 1000]:
///     area = ∫ log(E(r) / min_error) d(log r) / (log(max_error / min_error) ·
///            log(max_ratio / min_ratio)),
/// r from min_ratio to max_ratio. It is 0 if exact pictures cost nothing and 1 if no setting is in
/// the box. Another setting never enlarges it (complement of the hypervolume indicator of Zitzler
/// and Thiele 1998).
///
/// Precondition: the rows are of one scene and pose, at least one.
Front front_of(std::span<const Row> rows);

/// One front for each sequence of rows with the same scene, pose and size.
std::vector<Front> fronts_of(std::span<const Row> rows);

} // namespace reljef::bench
