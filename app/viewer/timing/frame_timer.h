#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>

#include "app/viewer/timing/viewer_times.h"
#include "engine/core/event.h"

namespace reljef::app {

/// From where the viewer has its times.
struct TimeSource {
    std::function<double()> now;        ///< seconds since the program began
    std::function<void()> wait_for_gpu; ///< until all that was drawn is in its picture
};

/// Takes the times of a window's loop. Without a source it does nothing.
class FrameTimer {
public:
    FrameTimer() = default;
    explicit FrameTimer(TimeSource source) : source_(std::move(source)) {}

    /// From its construction to its end the panels are drawn. Several in a frame are added.
    class PanelScope {
    public:
        explicit PanelScope(FrameTimer& timer);
        ~PanelScope();
        PanelScope(const PanelScope&) = delete;
        PanelScope& operator=(const PanelScope&) = delete;
        void set(PanelWork work) { work_ = work; }

    private:
        FrameTimer& timer_;
        double begin_ = 0.0;
        PanelWork work_ = PanelWork::hidden;
    };

    void receive(const Event& event, const OpenWork& work);
    /// So many actions of the panels take effect.
    void act(std::size_t actions);
    /// The window shows a frame. Times: see ShownFrame.
    void show(const OpenWork& work, std::optional<double> picture_ms = {}, double frame_ms = 0.0);
    /// At the end of each round of the loop.
    void end_round(const OpenWork& work);

    [[nodiscard]] bool is_on() const { return static_cast<bool>(source_.now); }
    [[nodiscard]] const ViewerTimes& times() const { return times_; }

private:
    TimeSource source_;
    ViewerTimes times_;
    double panels_ms_ = 0.0; // since the last frame
    PanelWork panels_ = PanelWork::hidden;
    bool has_shown_ = false; // in this round
};

/// Whether the viewer answers an event at once: not those that only follow from others.
bool asks_for_answer(const Event& event);

} // namespace reljef::app
