#include "app/viewer/panels/legend_panel.h"

#include <cstdint>

#include "app/viewer/panels/panel_text.h"
#include "app/viewer/panels/toolkit/widgets.h"

namespace reljef::app {
namespace {

constexpr float ramp_width = 14.0F;
constexpr double label_distance = 30.0; // pixels at least between two labels

void draw_ramp(const std::vector<LegendStop>& stops, ImVec2 low, ImVec2 high) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const auto height_at = [&](std::size_t index) {
        const float share = static_cast<float>(index) / static_cast<float>(stops.size() - 1);
        return high.y + share * (low.y - high.y);
    };
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
        const ImU32 below = in_imgui(stops[i].color);
        const ImU32 above = in_imgui(stops[i + 1].color);
        list.AddRectFilledMultiColor({low.x, height_at(i + 1)}, {low.x + ramp_width, height_at(i)},
                                     above, above, below, below);
    }
}

// As it lies over grey ground.
Rgba8 over_ground(Rgba8 color) {
    constexpr int ground = 140;
    constexpr int opaque = 255;
    const auto channel = [&](int above) {
        return static_cast<std::uint8_t>((above * color.a + ground * (opaque - color.a)) / opaque);
    };
    return {channel(color.r), channel(color.g), channel(color.b), opaque};
}

void draw_ground_colors(const PanelContent& content, const Area& area, const Fonts& fonts) {
    const Card card("legend", area);
    const FontScope small(fonts.small);
    muted_text("Viewshed");
    const float side = ImGui::GetTextLineHeight();
    for (const NamedColor& named : content.measure.ground_colors) {
        const ImVec2 low = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddRectFilled(low, {low.x + side, low.y + side},
                                                  in_imgui(over_ground(named.color)));
        ImGui::Dummy({side, side});
        ImGui::SameLine();
        text(named.name);
    }
    muted_text("F2: the colours of heights");
}

} // namespace

void draw_legend(const PanelContent& content, const Area& area, const Fonts& fonts) {
    if (!content.measure.ground_colors.empty()) {
        draw_ground_colors(content, area, fonts);
        return;
    }
    const auto& stops = content.legend;
    if (stops.size() < 2) {
        return;
    }
    const Card card("legend", area);
    const FontScope small(fonts.small);
    muted_text("Height, metres");
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const ImVec2 high{low.x, static_cast<float>(area.high.y) - 16.0F};
    draw_ramp(stops, {low.x, low.y + 4.0F}, high);
    const double bottom = stops.front().height;
    const double range = stops.back().height - bottom;
    const double pixels = static_cast<double>(high.y) - low.y - 4.0;
    if (!(range > 0.0 && pixels > 0.0)) {
        return;
    }
    const float half_line = 0.5F * ImGui::GetTextLineHeight();
    for (const AxisTick& tick : axis_ticks(bottom, bottom + range, pixels / label_distance)) {
        const auto share = static_cast<float>((tick.value - bottom) / range);
        const float y = high.y + share * (low.y + 4.0F - high.y);
        ImGui::SetCursorScreenPos({low.x + ramp_width + 10.0F, y - half_line});
        text(tick.text);
    }
}

} // namespace reljef::app
