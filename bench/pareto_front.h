#pragma once

#include <span>
#include <vector>

#include "bench/results.h"

namespace reljef::bench {

/// The box over which the area below a front is taken: time as a ratio to texture, error as the RMS
/// of the reprojection error, pixels.
struct FrontBox {
    double least_ratio = 0.1;
    double most_ratio = 1000.0;
    double least_error = 1e-3;
    double most_error = 1e3;
};

/// The front of one scene and pose: the settings that no other is both as fast and as accurate as,
/// and better in one of the two. Time is the ratio to texture, error the RMS of the reprojection
/// error; null rows, missing rows and rows without a reprojection error are left out, and so is a
/// row with pixels whose error has no bound.
///
/// The area is that below the front on logarithmic axes. With E(r) the least error of the settings
/// that take at most r times as long as texture, most_error where there is none, clamped to the
/// box:
///     area = ∫ log(E(r) / least_error) d(log r) / (log(most_error / least_error) ·
///            log(most_ratio / least_ratio)),
/// r from least_ratio to most_ratio: 0 where exact pictures cost nothing, 1 where no setting is in
/// the box. It falls whenever a setting moves the front, and never rises when one is added (the
/// hypervolume indicator of Zitzler and Thiele 1998, told from the other side).
///
/// Precondition: the rows are of one scene and pose, and there is one.
Front front_of(std::span<const Row> rows, const FrontBox& box = {});

/// The fronts of all rows, one for each run of rows with one scene, pose and size.
std::vector<Front> fronts_of(std::span<const Row> rows);

} // namespace reljef::bench
