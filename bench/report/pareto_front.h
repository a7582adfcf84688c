#pragma once

#include <span>
#include <vector>

#include "bench/report/results.h"

namespace reljef::bench {

/// The box over which the area below a front is taken: time as a ratio to texture, error as the RMS
/// of the reprojection error, pixels.
struct FrontBox {
    double min_ratio = 0.1;
    double max_ratio = 1000.0;
    double min_error = 1e-3;
    double max_error = 1e3;
};

/// Of more pixels than this share a row is no picture of the terrain, however small the error of
/// the others.
inline constexpr double max_holes = 1e-3;

/// The front of one scene and pose: the settings that none dominates, that is, none is as accurate
/// as and faster by more than the noise floors of both; where a floor is absent nothing dominates.
/// Time is the median, error the RMS of the reprojection error. Null rows, missing rows, rows
/// without a reprojection error and rows with pixels whose error has no bound have no place, and
/// rows with more than max_holes none either: they are named.
///
/// The area is that below all settings that have a place, time as a ratio to texture, on
/// logarithmic axes; absent where the ratio is. With E(r) the least error of the settings that take
/// at most r times as long as texture, max_error where there is none, clamped to the box:
///     area = ∫ log(E(r) / min_error) d(log r) / (log(max_error / min_error) ·
///            log(max_ratio / min_ratio)),
/// r from min_ratio to max_ratio: 0 where exact pictures cost nothing, 1 where no setting is in
/// the box. It falls by a setting that is more accurate than all that are as fast, and never rises
/// when one is added (the hypervolume indicator of Zitzler and Thiele 1998, told from the other
/// side).
///
/// Precondition: the rows are of one scene and pose, and there is one.
Front front_of(std::span<const Row> rows, const FrontBox& box = {});

/// The fronts of all rows, one for each run of rows with one scene, pose and size.
std::vector<Front> fronts_of(std::span<const Row> rows);

} // namespace reljef::bench
