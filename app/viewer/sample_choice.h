#pragma once

#include "engine/render/driver.h"

namespace reljef::app {

/// Chooses the samples of a pixel: one while a moving view is too slow, the automatic number again
/// when it rests. One slow frame, as when tiles arrive, changes nothing.
class SampleChoice {
public:
    /// Frames that take longer are too slow, milliseconds.
    static constexpr double max_smooth_ms = 33.0;
    static constexpr int max_slow_frames = 2;

    void add_frame(double milliseconds) {
        slow_frames_ = milliseconds > max_smooth_ms ? slow_frames_ + 1 : 0;
    }
    /// Of the next frame.
    int choose(bool is_moving) {
        is_reduced_ = is_moving && (is_reduced_ || slow_frames_ >= max_slow_frames);
        return is_reduced_ ? 1 : render::automatic_samples;
    }
    /// Whether the last frame had one sample for its speed.
    [[nodiscard]] bool is_reduced() const { return is_reduced_; }

private:
    int slow_frames_ = 0; // in a row
    bool is_reduced_ = false;
};

} // namespace reljef::app
