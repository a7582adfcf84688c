#pragma once

#include <chrono>
#include <utility>

namespace reljef {

/// Time since construction or the last restart, by the steady clock.
class Stopwatch {
public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(Clock::now() - start_).count();
    }
    [[nodiscard]] double milliseconds() const { return 1000.0 * seconds(); }

    /// Returns the elapsed seconds.
    double restart() {
        const Clock::time_point start = std::exchange(start_, Clock::now());
        return std::chrono::duration<double>(start_ - start).count();
    }

private:
    using Clock = std::chrono::steady_clock;

    Clock::time_point start_ = Clock::now();
};

} // namespace reljef
