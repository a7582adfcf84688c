#pragma once

#include <algorithm>
#include <chrono>

namespace reljef {

/// Retry times: each pause is four times the one before. After `max_attempts` failures the pause
/// is `long_pause`. All failures within one pause count as one.
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
    /// End of the pause.
    [[nodiscard]] Clock::time_point again() const { return again_; }
    /// Whether it has failed `max_attempts` times; retries still happen every `long_pause`.
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
