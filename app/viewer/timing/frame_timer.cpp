#include "app/viewer/timing/frame_timer.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace reljef::app {

bool asks_for_answer(const Event& event) {
    const auto* const key = std::get_if<KeyEvent>(&event);
    return (key != nullptr && key->pressed && !key->repeat) ||
           std::holds_alternative<MouseButtonEvent>(event) ||
           std::holds_alternative<ScrollEvent>(event);
}

FrameTimer::PanelScope::PanelScope(FrameTimer& timer) : timer_(timer) {
    if (timer_.is_on()) {
        timer_.source_.wait_for_gpu();
        begin_ = timer_.source_.now();
    }
}

// Hidden panels draw nothing that could be waited for.
FrameTimer::PanelScope::~PanelScope() {
    if (!timer_.is_on()) {
        return;
    }
    if (work_ != PanelWork::hidden) {
        timer_.source_.wait_for_gpu();
    }
    constexpr double ms_per_second = 1000.0;
    timer_.panels_ms_ += ms_per_second * (timer_.source_.now() - begin_);
    timer_.panels_ = std::max(timer_.panels_, work_);
}

void FrameTimer::receive(const Event& event, const OpenWork& work) {
    if (is_on() && asks_for_answer(event)) {
        times_.receive(source_.now(), work);
    }
}

void FrameTimer::act(std::size_t actions) {
    if (is_on() && actions > 0) {
        times_.act();
    }
}

void FrameTimer::show(const OpenWork& work, std::optional<double> picture_ms, double frame_ms) {
    if (!is_on()) {
        return;
    }
    times_.show({.at = source_.now(),
                 .picture_ms = picture_ms,
                 .frame_ms = frame_ms,
                 .panels_ms = std::exchange(panels_ms_, 0.0),
                 .panels = std::exchange(panels_, PanelWork::hidden)},
                work);
    has_shown_ = true;
}

void FrameTimer::end_round(const OpenWork& work) {
    const bool has_shown = std::exchange(has_shown_, false);
    if (!has_shown && !work.is_preparing && !work.has_actions && !work.is_stale) {
        times_.rest();
    }
}

} // namespace reljef::app
