#include "app/viewer/panels/measure_panel.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/viewer/panels/panel_text.h"
#include "app/viewer/panels/toolkit/widgets.h"

namespace reljef::app {
namespace {

constexpr float profile_height = 90.0F; // units of text

void draw_profile(const ProfileContent& profile, float scale) {
    const auto low = static_cast<float>(profile.lowest);
    const auto high = static_cast<float>(std::max(profile.highest, profile.lowest + 1.0));
    ImGui::PlotLines("##profile", profile.heights.data(), static_cast<int>(profile.heights.size()),
                     0, nullptr, low, high,
                     {ImGui::GetContentRegionAvail().x, profile_height * scale});
    tip("Heights from the last point but one to the last one");
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
