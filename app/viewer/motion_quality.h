#pragma once

#include <algorithm>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "engine/session/scene_renderer.h"
#include "engine/view/sample_count.h"

namespace reljef::app {

struct FrameQuality {
    int samples = view::automatic_samples; ///< per pixel
    int divisor = 1;                       ///< of the window's sides

    [[nodiscard]] glm::ivec2 picture_size(glm::ivec2 window) const {
        return glm::max(window / divisor, glm::ivec2(1));
    }
    friend bool operator==(const FrameQuality&, const FrameQuality&) = default;
};

/// Chooses the quality of a view. A view at rest has full quality, but the first one counts as
/// moving. A moving view with several slow frames in a row gets one sample per pixel, then a half
/// and a third of the resolution. A moving view that rays draw always has one sample.
class MotionQuality {
public:
    static constexpr double max_smooth_ms = 40.0; // slower frames are slow
    static constexpr int max_slow_frames = 2;     // in a row
    static constexpr int max_divisor = 3;

    void add_frame(double milliseconds) {
        slow_frames_ = milliseconds > max_smooth_ms ? slow_frames_ + 1 : 0;
    }
    FrameQuality choose(bool is_moving, bool by_rays = false) {
        if (!is_moving) {
            step_ = 0;
        } else if (slow_frames_ >= max_slow_frames) {
            step_ = std::min(step_ + 1, max_divisor);
            slow_frames_ = 0;
        }
        last_ = step_ > 0 ? FrameQuality{1, step_} : FrameQuality{};
        if (is_moving && by_rays) {
            last_.samples = 1;
        }
        return last_;
    }
    /// Whether the last frame had less than full quality.
    [[nodiscard]] bool is_reduced() const { return last_ != FrameQuality{}; }

private:
    int slow_frames_ = 0; // in a row
    int step_ = 0;        // 0: full quality; else one sample, with this divisor
    FrameQuality last_;
};

} // namespace reljef::app
