#pragma once

#include <algorithm>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "engine/session/scene_renderer.h"

namespace reljef::app {

/// How finely a frame is drawn.
struct FrameQuality {
    int samples = render::automatic_samples; ///< of a pixel
    int divisor = 1;                         ///< of the window's sides

    /// Of the picture for a window of that size, pixels.
    [[nodiscard]] glm::ivec2 picture_size(glm::ivec2 window) const {
        return glm::max(window / divisor, glm::ivec2(1));
    }
    friend bool operator==(const FrameQuality&, const FrameQuality&) = default;
};

/// Chooses how finely a view is drawn: in full while it rests. While it moves and its frames are
/// slow, first with one sample a pixel, then at a half and a third of the window's
/// resolution. One slow frame, as when tiles arrive, changes nothing.
class MotionQuality {
public:
    /// Frames that take longer are slow, milliseconds.
    static constexpr double max_smooth_ms = 40.0;
    static constexpr int max_slow_frames = 2; // in a row
    static constexpr int max_divisor = 3;

    void add_frame(double milliseconds) {
        slow_frames_ = milliseconds > max_smooth_ms ? slow_frames_ + 1 : 0;
    }
    /// Of the next frame.
    FrameQuality choose(bool is_moving) {
        if (!is_moving) {
            step_ = 0;
        } else if (slow_frames_ >= max_slow_frames) {
            step_ = std::min(step_ + 1, max_divisor);
            slow_frames_ = 0;
        }
        return step_ == 0 ? FrameQuality{} : FrameQuality{1, step_};
    }
    /// Whether the last frame was less than a view at rest has.
    [[nodiscard]] bool is_reduced() const { return step_ > 0; }

private:
    int slow_frames_ = 0; // in a row, of this step
    int step_ = 0;        // 1: one sample; from 2 on the divisor
};

} // namespace reljef::app
