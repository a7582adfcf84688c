#pragma once

#include <algorithm>
#include <chrono>

namespace reljef {

/// When to try again what fails: after a pause, then after four times as long, and so on; what has
/// failed `max_attempts` times is given up for half a minute, tried once more, and so on. Failures
/// within one pause are one, however many threads meet them.
class BackOff {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr int max_attempts = 4;
    static constexpr std::chrono::milliseconds usual_first_pause{200};
    static constexpr std::chrono::seconds long_pause{30};

    explicit BackOff(std::chrono::milliseconds first_pause = usual_first_pause)
        : pause_(first_pause) {}

    void fail(Clock::time_point now) {
        if (now >= again_) {
            attempts_ = std::min(attempts_ + 1, max_attempts);
            again_ = now + (attempts_ < max_attempts ? pause_ : long_pause);
            pause_ = attempts_ < max_attempts ? 4 * pause_ : pause_;
        }
    }
    /// When the pause is over.
    [[nodiscard]] Clock::time_point again() const { return again_; }
    /// Whether it has failed `max_attempts` times, if it be tried once in a while since.
    [[nodiscard]] bool has_failed_for_good() const { return attempts_ >= max_attempts; }
    [[nodiscard]] bool is_given_up(Clock::time_point now) const {
        return has_failed_for_good() && now < again_;
    }

private:
    std::chrono::milliseconds pause_;
    int attempts_ = 0;
    Clock::time_point again_;
};

} // namespace reljef
