#include "app/viewer/panels/measure_panel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/viewer/panels/panel_text.h"
#include "app/viewer/panels/toolkit/number_control.h"
#include "app/viewer/panels/toolkit/widgets.h"

namespace reljef::app {
namespace {

constexpr float profile_height = 96.0F; // units of text, of the plotted area
constexpr float plot_gap = 5.0F;        // between the area and its numbers
constexpr double height_tick = 18.0;    // pixels at least between two numbers
constexpr double distance_tick = 58.0;  // the same
constexpr double max_metres = 3000.0;   // longer profiles have kilometres
constexpr double metres_in_kilometre = 1e3;

// A profile's area on the window, and what it shows there.
struct ProfilePlot {
    ImVec2 low;          // upper left, pixels
    ImVec2 high;         // lower right
    double bottom = 0.0; // metres
    double top = 1.0;
    double length = 1.0; // in `unit`
    const char* unit = "m";

    [[nodiscard]] float x_of(double distance) const {
        return low.x + static_cast<float>(distance / length) * (high.x - low.x);
    }
    [[nodiscard]] float y_of(double height) const {
        return high.y - static_cast<float>((height - bottom) / (top - bottom)) * (high.y - low.y);
    }
};

ProfilePlot plot_of(const ProfileContent& profile) {
    constexpr double air = 0.06; // of the range, above and below
    constexpr double min_range = 1.0;
    ProfilePlot plot;
    const double range = std::max(profile.highest - profile.lowest, min_range);
    const double middle = 0.5 * (profile.lowest + profile.highest);
    plot.bottom = middle - (0.5 + air) * range;
    plot.top = middle + (0.5 + air) * range;
    const bool is_long = profile.distance > max_metres;
    plot.unit = is_long ? "km" : "m";
    plot.length = std::max(profile.distance, 1e-3) / (is_long ? metres_in_kilometre : 1.0);
    return plot;
}

void draw_height_axis(const ProfilePlot& plot, const std::vector<AxisTick>& ticks) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (const AxisTick& tick : ticks) {
        const float y = plot.y_of(tick.value);
        const ImVec2 size = ImGui::CalcTextSize(tick.text.c_str());
        list.AddLine({plot.low.x, y}, {plot.high.x, y}, in_imgui(palette::line));
        list.AddText({plot.low.x - plot_gap - size.x, y - 0.5F * size.y}, in_imgui(palette::muted),
                     tick.text.c_str());
    }
}

void draw_distance_axis(const ProfilePlot& plot) {
    constexpr float tick_length = 4.0F;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const double width = static_cast<double>(plot.high.x - plot.low.x);
    for (const AxisTick& tick : axis_ticks(0.0, plot.length, width / distance_tick)) {
        const float x = plot.x_of(tick.value);
        const ImVec2 size = ImGui::CalcTextSize(tick.text.c_str());
        const float left = std::min(x - 0.5F * size.x, plot.high.x - size.x);
        list.AddLine({x, plot.high.y}, {x, plot.high.y + tick_length}, in_imgui(palette::muted));
        list.AddText({left, plot.high.y + plot_gap}, in_imgui(palette::muted), tick.text.c_str());
    }
    list.AddLine({plot.low.x, plot.low.y}, {plot.low.x, plot.high.y}, in_imgui(palette::muted));
    list.AddLine({plot.low.x, plot.high.y}, plot.high, in_imgui(palette::muted));
}

void draw_profile_line(const ProfileContent& profile, const ProfilePlot& plot) {
    constexpr float thick = 1.5F;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const auto count = profile.heights.size();
    for (std::size_t i = 0; i < count; ++i) {
        const double share =
            static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(count - 1, 1));
        list.PathLineTo(
            {plot.x_of(share * plot.length), plot.y_of(static_cast<double>(profile.heights[i]))});
    }
    list.PathStroke(in_imgui(palette::accent), 0, thick);
}

// The place under the pointer.
void draw_profile_tip(const ProfileContent& profile, const ProfilePlot& plot) {
    const float x = ImGui::GetIO().MousePos.x;
    if (!ImGui::IsItemHovered() || x < plot.low.x || x > plot.high.x || profile.heights.empty()) {
        return;
    }
    const double share = static_cast<double>((x - plot.low.x) / (plot.high.x - plot.low.x));
    const auto last = static_cast<double>(profile.heights.size() - 1);
    const float height = profile.heights[static_cast<std::size_t>(std::lround(share * last))];
    ImGui::GetWindowDrawList()->AddLine({x, plot.low.y}, {x, plot.high.y},
                                        in_imgui(palette::muted));
    tip(fmt::format("{} {}: {:.1f} m", number_text(share * plot.length, 2), plot.unit, height));
}

void draw_plot_of(const ProfileContent& profile, float scale) {
    ProfilePlot plot = plot_of(profile);
    const double pixels = static_cast<double>(profile_height * scale);
    const auto heights = axis_ticks(plot.bottom, plot.top, pixels / height_tick);
    float labels = 0.0F;
    for (const AxisTick& tick : heights) {
        labels = std::max(labels, ImGui::CalcTextSize(tick.text.c_str()).x);
    }
    muted_text("Height, m");
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    plot.low = {corner.x + labels + plot_gap, corner.y};
    plot.high = {corner.x + width - 1.0F, corner.y + profile_height * scale};
    ImGui::GetWindowDrawList()->AddRectFilled(plot.low, plot.high, in_imgui(palette::field));
    draw_height_axis(plot, heights);
    draw_distance_axis(plot);
    draw_profile_line(profile, plot);
    ImGui::InvisibleButton("profile", {width, profile_height * scale});
    draw_profile_tip(profile, plot);
    ImGui::Dummy({width, ImGui::GetTextLineHeight()});
    const std::string title = fmt::format("Distance from the last point but one, {}", plot.unit);
    muted_text(title);
}

void draw_profile(const ProfileContent& profile, float scale) {
    if (std::isfinite(profile.lowest)) {
        draw_plot_of(profile, scale);
    } else {
        muted_text("There are no heights along it");
    }
    row("Lowest, highest", fmt::format("{:.1f} m, {:.1f} m", profile.lowest, profile.highest));
    row("Distance", length_text(profile.distance));
    row("Over the ground", length_text(profile.over_ground));
    row("Climb, descent", fmt::format("{:.1f} m, {:.1f} m", profile.climb, profile.descent));
    row("Line of sight", profile.in_sight ? "free" : "hidden");
    tip("Between both points, 2 m above the ground, by exact rays");
}

} // namespace

PanelActions draw_measure(const PanelContent& content, const Fonts& fonts) {
    const MeasureContent& measure = content.measure;
    const FontScope small(fonts.small);
    PanelActions actions;
    section(fonts.heading, "Points");
    if (tick("Clicks pick points of the ground and of objects  (X)", measure.is_on)) {
        actions.emplace_back(PressKey{Key::x});
    }
    for (std::size_t i = 0; i < measure.points.size(); ++i) {
        muted_text(fmt::format("{}  {}", i + 1, measure.points[i].place));
        text(measure.points[i].ground);
    }
    if (!measure.points.empty() && wide_button("Forget the points")) {
        actions.emplace_back(ClearPoints{});
    }
    if (measure.profile) {
        section(fonts.heading, "Profile");
        draw_profile(*measure.profile, ImGui::GetFontSize() / 14.0F);
    } else {
        wrapped_muted_text("The profile and the line of sight between two points appear here.");
    }
    section(fonts.heading, "Save");
    ImGui::BeginDisabled(!measure.profile);
    if (wide_button("Profile as CSV  (I)")) {
        actions.emplace_back(PressKey{Key::i});
    }
    ImGui::EndDisabled();
    ImGui::BeginDisabled(measure.points.empty());
    if (wide_button("Viewshed of the last point  (U)")) {
        actions.emplace_back(PressKey{Key::u});
    }
    ImGui::EndDisabled();
    tip("What an eye 2 m above the last point sees, by exact rays: a GeoTIFF in the current "
        "folder. Its colours lie on the ground: green where it sees, blue where it does not.");
    if (measure.viewshed) {
        const bool is_on = *measure.viewshed;
        if (tick("Colour the ground by the viewshed  (F2)", is_on)) {
            actions.emplace_back(ShowViewshed{!is_on});
        }
        tip("Green: seen from the point. Blue: hidden.");
    }
    return actions;
}

void draw_points(const PanelContent& content, const Fonts& fonts) {
    constexpr float radius = 5.0F;
    constexpr float thick = 2.0F;
    const FontScope small(fonts.small);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    std::optional<ImVec2> last;
    for (std::size_t i = 0; i < content.measure.points.size(); ++i) {
        const auto& pixel = content.measure.points[i].pixel;
        if (!pixel) {
            last.reset();
            continue;
        }
        const ImVec2 at{static_cast<float>(pixel->x), static_cast<float>(pixel->y)};
        if (last) {
            list.AddLine(*last, at, in_imgui(palette::accent), thick);
        }
        list.AddCircleFilled(at, radius, in_imgui(palette::raised));
        list.AddCircle(at, radius, in_imgui(palette::accent), 0, thick);
        const std::string number = fmt::format("{}", i + 1);
        const ImVec2 size = ImGui::CalcTextSize(number.c_str());
        const ImVec2 label{at.x + 1.6F * radius, at.y - size.y - 2.0F};
        list.AddRectFilled({label.x - 4.0F, label.y - 1.0F},
                           {label.x + size.x + 4.0F, label.y + size.y + 1.0F},
                           in_imgui(palette::surface), 3.0F);
        list.AddText(label, in_imgui(palette::text), number.c_str());
        last = at;
    }
}

} // namespace reljef::app
