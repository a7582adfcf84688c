#pragma once

#include <functional>
#include <limits>
#include <span>
#include <stop_token>
#include <vector>

#include "engine/core/result.h"
#include "engine/core/worker_pool.h"

namespace reljef::bench {

/// Draws one frame and returns when it is finished.
using DrawFrame = std::function<Result<void>()>;

struct MeasureOptions {
    int warm_up_rounds = 2; ///< drawn and not timed: programs, uploads, caches
    int least_rounds = 5;
    int most_rounds = 1000;
    double seconds = 10.0; ///< no new timed round begins later than this, once the least are done
    /// No new timed round begins that would not end by then, the warm-up included, even if the
    /// least are not done; there is one at any rate.
    double most_seconds = std::numeric_limits<double>::infinity();
    std::stop_token stop; ///< no new frame begins once a stop is asked for
    Progress progress;
    std::function<double()> now_ms; ///< a steady clock, milliseconds; empty: the system's
};

struct Measurement {
    /// The time of each frame, milliseconds: one list for each thing drawn, in the order drawn.
    std::vector<std::vector<double>> ms;
    bool stopped = false; ///< early, by the token: lists may be empty, or differ in length by one
};

/// Times things interleaved (A B C A B C …), so that whatever slows the machine for a while slows
/// all of them alike. Fails with the first frame that fails. Precondition: there is something to
/// draw, 1 <= least_rounds <= most_rounds.
Result<Measurement> measure(std::span<const DrawFrame> frames, const MeasureOptions& options = {});

} // namespace reljef::bench
