#pragma once

#include <cstddef>
#include <vector>

namespace reljef::app {

/// The times of the last frames, for a plot.
class RecentTimes {
public:
    static constexpr std::size_t max_frames = 96;

    void add(double milliseconds) {
        if (ms_.size() == max_frames) {
            ms_.erase(ms_.begin());
        }
        ms_.push_back(static_cast<float>(milliseconds));
    }
    /// Milliseconds, oldest first.
    [[nodiscard]] const std::vector<float>& all() const { return ms_; }

private:
    std::vector<float> ms_;
};

} // namespace reljef::app
