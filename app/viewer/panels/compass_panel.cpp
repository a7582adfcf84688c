#include "app/viewer/panels/compass_panel.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "app/viewer/panels/panel_text.h"
#include "app/viewer/panels/toolkit/widgets.h"

namespace reljef::app {
namespace {

constexpr float rose_radius = 23.0F; // units of text
constexpr float max_bar = 128.0F;

ImVec2 at_angle(ImVec2 middle, float radius, double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    return {middle.x + radius * static_cast<float>(std::sin(angle)),
            middle.y - radius * static_cast<float>(std::cos(angle))};
}

// The needle points to north; `heading` is up in the window.
void draw_rose(ImVec2 middle, float radius, double heading) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    constexpr float thin = 1.5F;
    list.AddCircle(middle, radius, in_imgui(palette::field_hovered), 0, thin);
    for (const double mark : {0.0, 90.0, 180.0, 270.0}) {
        list.AddLine(at_angle(middle, radius, mark - heading),
                     at_angle(middle, 0.84F * radius, mark - heading), in_imgui(palette::muted),
                     thin);
    }
    const ImVec2 north = at_angle(middle, 0.74F * radius, -heading);
    const ImVec2 south = at_angle(middle, 0.74F * radius, 180.0 - heading);
    const ImVec2 east = at_angle(middle, 0.24F * radius, 90.0 - heading);
    const ImVec2 west = at_angle(middle, 0.24F * radius, 270.0 - heading);
    list.AddTriangleFilled(north, east, west, in_imgui(palette::accent));
    list.AddTriangleFilled(south, west, east, in_imgui(palette::muted));
}

const char* wind_of(double heading) {
    constexpr const char* winds[] = {"N", "NE", "E", "SE", "S", "SW", "W", "NW"};
    return winds[static_cast<std::size_t>(std::lround(heading / 45.0)) % 8];
}

void draw_bar(const ScaleBar& bar) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 left = ImGui::GetCursorScreenPos();
    const ImVec2 right{left.x + static_cast<float>(bar.pixels), left.y};
    constexpr float tick_height = 5.0F;
    constexpr float thick = 2.0F;
    const ImU32 color = in_imgui(palette::text);
    list.AddLine(left, right, color, thick);
    list.AddLine({left.x, left.y - tick_height}, {left.x, left.y + 1.0F}, color, thick);
    list.AddLine({right.x, right.y - tick_height}, {right.x, right.y + 1.0F}, color, thick);
}

} // namespace

void draw_compass(const PanelContent& content, const Area& area, const Fonts& fonts) {
    const Card card("compass", area);
    const FontScope small(fonts.small);
    const auto height = static_cast<float>(area.size().y);
    const float radius = rose_radius * height / 72.0F;
    const auto low = ImVec2(static_cast<float>(area.low.x), static_cast<float>(area.low.y));
    const double heading = content.heading.value_or(0.0);
    draw_rose({low.x + 14.0F + radius, low.y + 0.5F * height}, radius, heading);
    const float column = 30.0F + 2.0F * radius;
    ImGui::SetCursorPos({column, 0.14F * height});
    text(content.appearance.shows_map ? std::string("north is up")
                                      : fmt::format("{:.0f}\u00b0 {}", heading, wind_of(heading)));
    if (content.metres_per_pixel && *content.metres_per_pixel > 0.0) {
        const ScaleBar bar = scale_bar(*content.metres_per_pixel, max_bar * height / 72.0F);
        ImGui::SetCursorPos({column, 0.46F * height});
        text(length_text(bar.metres));
        ImGui::SetCursorPos({column, 0.84F * height});
        draw_bar(bar);
    }
}

} // namespace reljef::app
