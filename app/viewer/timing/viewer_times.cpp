#include "app/viewer/timing/viewer_times.h"

#include <algorithm>
#include <utility>

namespace reljef::app {
namespace {

constexpr double ms_per_second = 1000.0;

} // namespace

void ViewerTimes::receive(double at, const OpenWork& work) {
    inputs_.push_back({.at = at, .is_loading = work.is_loading, .is_preparing = work.is_preparing});
}

void ViewerTimes::act() {
    for (Input& input : inputs_) {
        input.is_control = true;
    }
}

void ViewerTimes::show(const ShownFrame& frame, const OpenWork& work) {
    frames_.push_back(frame);
    if (frame.picture_ms) {
        const bool is_complete =
            !work.is_preparing && !work.is_loading && !work.has_actions && !work.is_reduced;
        first_picture_ = first_picture_.value_or(frame.at);
        complete_picture_ =
            complete_picture_ || !is_complete ? complete_picture_ : std::optional(frame.at);
    }
    std::vector<Input> open;
    for (Input input : std::exchange(inputs_, {})) {
        ++input.frames;
        const bool waits = work.is_preparing && !input.is_preparing;
        input.has_waited = input.has_waited || waits;
        // A slider that is held asks for its value again and again.
        if (waits || (work.has_actions && !input.is_control)) {
            open.push_back(input);
        } else {
            answers_.push_back({input, ms_per_second * (frame.at - input.at)});
        }
    }
    inputs_ = std::move(open);
}

void ViewerTimes::rest() {
    inputs_.clear();
}

TimeReport ViewerTimes::report() const {
    const auto frame_row = [&](std::string_view key, std::string_view name, auto is_of, auto time) {
        TimeRow row{key, name, {}};
        for (const ShownFrame& frame : frames_) {
            if (is_of(frame)) {
                row.ms.push_back(time(frame));
            }
        }
        return row;
    };
    const auto answer_row = [&](std::string_view key, std::string_view name, auto is_of) {
        TimeRow row{key, name, {}};
        for (const Answer& answer : answers_) {
            if (is_of(answer.input)) {
                row.ms.push_back(answer.ms);
                row.max_frames = std::max(row.max_frames.value_or(0), answer.input.frames);
            }
        }
        return row;
    };
    const auto with = [](PanelWork work) {
        return [work](const ShownFrame& frame) { return frame.panels == work; };
    };
    const auto has_panels = [](const ShownFrame& frame) {
        return frame.panels != PanelWork::hidden;
    };
    const auto of_panels = [](const ShownFrame& frame) { return frame.panels_ms; };
    const auto of_frame = [](const ShownFrame& frame) { return frame.frame_ms; };
    TimeReport report{first_picture_, complete_picture_, {}};
    report.rows = {
        frame_row(
            "frames_with_panels", "frames with panels",
            [&](const ShownFrame& frame) { return frame.picture_ms && has_panels(frame); },
            of_frame),
        frame_row(
            "frames_without_panels", "frames without panels",
            [&](const ShownFrame& frame) { return frame.picture_ms && !has_panels(frame); },
            of_frame),
        frame_row("panels", "panels, of each frame", has_panels, of_panels),
        frame_row("panels_drawn", "  drawn", with(PanelWork::drawn), of_panels),
        frame_row("panels_copied", "  copied", with(PanelWork::copied), of_panels),
        frame_row("panels_hidden", "  hidden", with(PanelWork::hidden), of_panels),
        answer_row("keys", "answers to keys and mouse",
                   [](const Input& input) { return !input.is_control && !input.has_waited; }),
        answer_row("controls", "answers of controls",
                   [](const Input& input) { return input.is_control && !input.has_waited; }),
        answer_row("controls_while_loading", "  while tiles load",
                   [](const Input& input) {
                       return input.is_control && input.is_loading && !input.has_waited;
                   }),
        answer_row("prepared", "answers after preparation",
                   [](const Input& input) { return input.has_waited; })};
    return report;
}

} // namespace reljef::app
