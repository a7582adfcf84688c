#pragma once

#include <cstddef>
#include <optional>

#include "bench/runner/measure.h"
#include "bench/runner/suite_options.h"

namespace reljef::bench {

/// Of a quick run, to write a page.
inline constexpr double page_seconds = 3.0;

/// What a group took so far, and what there is to time in it; seconds.
struct GroupCost {
    double elapsed = 0.0; ///< since the group began
    double judging = 0.0; ///< of that, for the candidates but texture, which waits for the truth
    int judged = 0;       ///< so many
    double round = 0.0;   ///< of timing: a frame of each
    int frames = 0;       ///< in a round
};

/// Of the next group, when `groups_left` are left, this one among them, and the run began `elapsed`
/// seconds ago: an even share of what is left of the time, 0 where none is. Infinite where the run
/// is not quick, or is told its rounds.
double group_seconds(const SuiteOptions& options, double elapsed, std::size_t groups_left);

/// What the group will have cost when one candidate more is judged: as much as the mean of those
/// before it. `frame`: of it, seconds, where that is known.
GroupCost with_another(const GroupCost& cost, std::optional<double> frame = std::nullopt);

/// Whether a group of so many seconds has time to draw each min_frames times.
bool fits(const GroupCost& cost, double seconds);

/// How to time one of `groups` groups that has so many seconds left.
MeasureOptions measuring(const SuiteOptions& options, std::size_t groups, double seconds_left);

} // namespace reljef::bench
