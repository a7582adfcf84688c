#pragma once

#include <functional>
#include <stop_token>

namespace reljef {

/// Told how far a long operation has come, in [0,1], from whichever thread did the work, one call
/// at a time. Empty: nobody listens.
using Progress = std::function<void(double fraction)>;

/// Worker threads to use when `requested` is 0: as many as the machine has, at least 1.
unsigned thread_count(unsigned requested);

struct ParallelOptions {
    unsigned threads = 0; ///< 0: as many as the machine has
    std::stop_token stop; ///< no new item begins once a stop is asked for
    Progress progress;    ///< see Progress
};

/// Calls `body(index)` once for every index in [0, count), from several threads at a time, and
/// returns when all are done. `body` must not throw. Returns false when it was stopped early.
bool parallel_for(int count, const std::function<void(int index)>& body,
                  const ParallelOptions& options = {});

} // namespace reljef
