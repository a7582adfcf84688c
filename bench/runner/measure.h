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

/// Draws one frame and returns when it is finished.
using DrawFrame = std::function<Result<void>()>;

struct MeasureOptions {
    int warm_up_rounds = 2; ///< drawn and not timed: programs, uploads, caches
    int min_rounds = 5;
    int max_rounds = 1000;
    double seconds = 10.0; ///< no new timed round begins later than this, once the least are done
    /// No new timed round begins that would not end by then, the warm-up included, even if the
    /// least are not done; there is one at any rate.
    double max_seconds = std::numeric_limits<double>::infinity();
    /// Two of the things drawn that are one and the same: how far their medians lie apart is the
    /// noise floor of all the others.
    std::optional<std::pair<std::size_t, std::size_t>> null_pair;
    double max_noise = 0.10; ///< a floor above it asks for rounds beyond `seconds`,
    /// but none beyond `max_rounds`, and none begins later than this. Whether the floor has come
    /// down is asked each time the rounds have grown by a quarter: asked after every round, it
    /// would be believed at its luckiest.
    double noisy_seconds = 60.0;
    std::stop_token stop; ///< no new frame begins once a stop is asked for
    Progress progress;
    std::function<double()> now_ms; ///< a steady clock, milliseconds; empty: the system's
};

struct Measurement {
    /// The time of each frame, milliseconds: one list for each thing drawn, in the order drawn.
    std::vector<std::vector<double>> ms;
    /// relative_distance() of the medians of the null pair; absent without one, or where either
    /// was never timed.
    std::optional<double> noise_floor;
    bool stopped = false; ///< early, by the token: lists may be empty, or differ in length by one
};

/// Times things interleaved (A B C A B C …), so that whatever slows the machine for a while slows
/// all of them alike. Fails with the first frame that fails. Precondition: there is something to
/// draw, 1 <= min_rounds <= max_rounds, the null pair is among the things drawn.
Result<Measurement> measure(std::span<const DrawFrame> frames, const MeasureOptions& options = {});

} // namespace reljef::bench
