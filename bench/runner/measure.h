#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "engine/core/parallel_for.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// Draws one frame; returns when it is complete.
using DrawFrame = std::function<Result<void>()>;

struct MeasureOptions {
    int warm_up_rounds = 2; ///< untimed: programs, uploads, caches
    int min_rounds = 5;
    int max_rounds = 1000;
    double seconds = 10.0; ///< after min_rounds, no round begins later than this
    /// No round begins that would end later, even before min_rounds; includes the warm-up. At least
    /// one round is timed.
    double max_seconds = std::numeric_limits<double>::infinity();
    /// Two equal frames; the distance of their medians is the noise floor.
    std::optional<std::pair<std::size_t, std::size_t>> null_pair;
    double max_noise = 0.10; ///< a larger floor adds rounds after `seconds`,
    /// up to this time or max_rounds. The floor is checked whenever the rounds have grown by a
    /// quarter: a check after every round would stop at a floor that is small by chance.
    double noisy_seconds = 60.0;
    std::stop_token stop; ///< checked before each frame
    Progress progress;
    std::function<double()> now_ms; ///< a steady clock, ms; empty: the system's
};

struct Measurement {
    std::vector<std::vector<double>> ms; ///< times of each frame, one list per DrawFrame
    /// relative_distance() of the medians of the null pair; absent without a timed null pair.
    std::optional<double> noise_floor;
    bool stopped = false; ///< by the token; lists may be empty or differ in length by one
};

/// Times frames interleaved (A B C A B C …): a temporarily slow machine slows all alike. Fails with
/// the first frame that fails. Precondition: frames exist, 1 <= min_rounds <= max_rounds, the null
/// pair is among the frames.
Result<Measurement> measure(std::span<const DrawFrame> frames, const MeasureOptions& options = {});

} // namespace reljef::bench
