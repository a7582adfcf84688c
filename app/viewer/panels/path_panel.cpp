#include "app/viewer/panels/path_panel.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "app/viewer/panels/toolkit/number_control.h"
#include "app/viewer/panels/toolkit/widgets.h"

namespace reljef::app {
namespace {

constexpr float timeline_height = 34.0F; // pixels
constexpr float line_margin = 8.0F;      // of the timeline, for the first and the last keyframe
constexpr float key_size = 6.0F;
constexpr double reach = 8.0; // of a keyframe, pixels
constexpr double step = 0.05; // of times, seconds
constexpr double min_duration = 1.0;
constexpr double max_duration = 600.0;

// Seconds and pixels of the timeline.
struct Scale {
    double seconds = 1.0; // of the whole line
    float left = 0.0F;
    float width = 1.0F;

    [[nodiscard]] float x_of(double time) const {
        return left + width * static_cast<float>(time / seconds);
    }
    [[nodiscard]] double time_at(float x) const {
        const double share = std::clamp(static_cast<double>((x - left) / width), 0.0, 1.0);
        return std::round(share * seconds / step) * step;
    }
};

double duration_of(const PathContent& path) {
    return path.keys.empty() ? 0.0 : path.keys.back();
}

std::optional<std::size_t> key_at(const PathContent& path, const Scale& scale, float x) {
    std::optional<std::size_t> nearest;
    double distance = reach;
    for (std::size_t i = 0; i < path.keys.size(); ++i) {
        const double away = std::abs(scale.x_of(path.keys[i]) - x);
        if (away < distance) {
            distance = away;
            nearest = i;
        }
    }
    return nearest;
}

void draw_diamond(ImVec2 at, float half, Rgba8 color) {
    ImGui::GetWindowDrawList()->AddQuadFilled({at.x, at.y - key_size}, {at.x + half, at.y},
                                              {at.x, at.y + key_size}, {at.x - half, at.y},
                                              in_imgui(color));
}

// A button of half the width, beside the last one if `beside`.
bool half_button(const char* label, bool beside) {
    if (beside) {
        ImGui::SameLine();
    }
    const float width =
        0.5F * (ImGui::GetWindowContentRegionMax().x - ImGui::GetStyle().ItemSpacing.x);
    return ImGui::Button(label, {width, 0.0F});
}

PanelActions draw_duration(const PathContent& path) {
    if (path.keys.size() < 2) {
        return {};
    }
    const auto seconds = number_row("Duration",
                                    {.slider = {min_duration, max_duration},
                                     .typed = Interval{0.1, 1e5},
                                     .decimals = 1,
                                     .is_logarithmic = true,
                                     .unit = "s",
                                     .meaning = "Stretches all times"},
                                    duration_of(path));
    return seconds ? PanelActions{SetPathDuration{*seconds}} : PanelActions();
}

PanelActions draw_video(const PathContent& path) {
    PanelActions actions;
    if (path.video) {
        muted_text(fmt::format("Rendering the video: {:.0f} %", 100.0 * *path.video));
        ImGui::ProgressBar(static_cast<float>(*path.video), {-1.0F, 5.0F}, "");
        if (wide_button("Cancel  (Esc)")) {
            actions.emplace_back(CancelVideo{});
        }
        return actions;
    }
    if (half_button("Save  (J)", false)) {
        actions.emplace_back(PressKey{Key::j});
    }
    tip("A path file, and GPX on Earth, in the current folder");
    ImGui::BeginDisabled(path.keys.size() < 2);
    if (half_button("Video  (Y)", true)) {
        actions.emplace_back(PressKey{Key::y});
    }
    ImGui::EndDisabled();
    tip("Renders the path into the current folder; Esc cancels");
    return actions;
}

// Where a key is dragged, its time there.
struct ShownKeys {
    std::vector<double> times;
    std::size_t selected = 0;
};

void draw_line(const Scale& scale, float top, double time, const ShownKeys& keys) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float middle = top + 0.5F * timeline_height;
    const float right = scale.left + scale.width;
    list.AddRectFilled({scale.left - line_margin, top},
                       {right + line_margin, top + timeline_height}, in_imgui(palette::field),
                       5.0F);
    list.AddLine({scale.left, middle}, {right, middle}, in_imgui(palette::muted));
    const float now = scale.x_of(time);
    list.AddLine({now, top + 3.0F}, {now, top + timeline_height - 3.0F}, in_imgui(palette::text),
                 2.0F);
    const float half = // narrower where there are many
        std::clamp(0.4F * scale.width / static_cast<float>(keys.times.size() + 1), 1.0F, key_size);
    for (std::size_t i = 0; i < keys.times.size(); ++i) {
        draw_diamond({scale.x_of(keys.times[i]), middle}, half,
                     i == keys.selected ? palette::accent : palette::muted);
    }
}

} // namespace

PanelActions PathPanel::draw_timeline(const PathContent& path) {
    PanelActions actions;
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    const Scale scale{std::max(duration_of(path), min_duration), low.x + line_margin,
                      width - 2.0F * line_margin};
    ImGui::InvisibleButton("timeline", {width, timeline_height});
    tip("Click: show the path there. Drag a keyframe: change its time");
    const float x = ImGui::GetIO().MousePos.x;
    if (ImGui::IsItemActivated()) {
        drag_ = Drag{key_at(path, scale, x), scale.time_at(x), false};
        key_ = drag_->key.value_or(key_);
        actions.emplace_back(SeekPath{drag_->key ? path.keys[*drag_->key] : drag_->seconds});
    } else if (drag_ && ImGui::IsItemActive() && scale.time_at(x) != drag_->seconds) {
        drag_->seconds = scale.time_at(x);
        drag_->has_moved = true;
        if (!drag_->key) {
            actions.emplace_back(SeekPath{drag_->seconds});
        }
    } else if (drag_ && !ImGui::IsItemActive()) {
        if (drag_->key && drag_->has_moved) {
            actions.emplace_back(RetimePathKey{*drag_->key, drag_->seconds});
        }
        drag_.reset();
    }
    ShownKeys keys{path.keys, key_};
    if (drag_ && drag_->has_moved && drag_->key) {
        keys.times[*drag_->key] = drag_->seconds;
    }
    draw_line(scale, low.y, path.time, keys);
    return actions;
}

PanelActions PathPanel::draw_key(const PathContent& path) {
    PanelActions actions;
    if (half_button("Append  (Ins)", false)) {
        actions.emplace_back(PressKey{Key::insert});
    }
    tip("This view as a keyframe after the last one. The first one begins a path of your own");
    if (half_button("Insert here", true)) {
        actions.emplace_back(InsertPathKey{path.time});
    }
    tip("This view as a keyframe at the time of the line; fly to another view first");
    if (path.keys.empty()) {
        return actions;
    }
    key_ = std::min(key_, path.keys.size() - 1);
    row(fmt::format("Keyframe {} of {}", key_ + 1, path.keys.size()),
        fmt::format("at {:.2f} s", path.keys[key_]));
    if (half_button("Take this view", false)) {
        actions.emplace_back(MovePathKey{key_});
    }
    tip("The keyframe moves to where you look from now");
    ImGui::BeginDisabled(path.keys.size() < 2);
    if (half_button("Remove  (Del)", true)) {
        actions.emplace_back(RemovePathKey{key_});
    }
    ImGui::EndDisabled();
    return actions;
}

PanelActions PathPanel::draw(const PanelContent& content, const Fonts& fonts) {
    const PathContent& path = content.path;
    const FontScope small(fonts.small);
    PanelActions actions;
    section(fonts.heading, "Path");
    ImGui::BeginDisabled(path.video.has_value());
    if (half_button(path.is_playing ? "Stop  (P)" : "Play  (P)", false)) {
        actions.emplace_back(PressKey{Key::p});
    }
    if (half_button(path.is_recording ? "End recording  (K)" : "Record  (K)", true)) {
        actions.emplace_back(PressKey{Key::k});
    }
    tip("Records your flight as the path, until K ends it and saves it");
    row("Time", fmt::format("{:.1f} of {:.1f} s", path.time, duration_of(path)));
    actions += draw_timeline(path);
    actions += draw_key(path);
    actions += draw_duration(path);
    ImGui::EndDisabled();
    section(fonts.heading, "Files");
    return actions += draw_video(path);
}

} // namespace reljef::app
