#pragma once

#include <cstddef>
#include <optional>

#include "bench/runner/measure.h"
#include "bench/runner/suite_options.h"

namespace reljef::bench {

/// Reserved by a quick run to write a page.
inline constexpr double page_seconds = 3.0;

/// The cost of a group, in seconds.
struct GroupCost {
    double elapsed = 0.0;       ///< since the group began
    double error_seconds = 0.0; ///< part of it: errors of candidates, without texture (the truth)
    int checked = 0;            ///< candidates in `error_seconds`
    double round = 0.0;         ///< of timing: one frame of each candidate
    int frames = 0;             ///< per round
};

/// Time for the next of `groups_left` groups when the run began `elapsed` seconds ago: an even
/// share of the rest, at least 0. Infinite unless the run is quick without a number of rounds.
double group_seconds(const SuiteOptions& options, double elapsed, std::size_t groups_left);

/// The cost with one more candidate of mean cost. `frame`: its frame time in seconds, if known.
GroupCost with_another(const GroupCost& cost, std::optional<double> frame = std::nullopt);

/// Whether each candidate can be drawn min_frames times within `seconds`.
bool fits(const GroupCost& cost, double seconds);

/// Options to time one of `groups` groups within `seconds_left`.
MeasureOptions measuring(const SuiteOptions& options, std::size_t groups, double seconds_left);

} // namespace reljef::bench
