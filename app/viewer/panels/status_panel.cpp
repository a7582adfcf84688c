#include "app/viewer/panels/status_panel.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/viewer/panels/panel_text.h"
#include "app/viewer/panels/toolkit/widgets.h"

namespace reljef::app {
namespace {

constexpr float plot_height = 34.0F;    // units of text
constexpr float min_plotted_ms = 20.0F; // the plot's upper edge at least

void draw_rate(const FrameContent& frame, const Fonts& fonts) {
    {
        const FontScope large(fonts.figure);
        text(fmt::format("{:.1f}", frame.last_ms));
    }
    const float base = ImGui::GetCursorPosY();
    ImGui::SameLine(0.0F, 4.0F);
    ImGui::SetCursorPosY(base - 1.45F * ImGui::GetTextLineHeightWithSpacing());
    muted_text("ms");
    const std::string rate = frame.frames_per_second
                                 ? fmt::format("{:.0f} fps", *frame.frames_per_second)
                                 : std::string("at rest");
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(rate.c_str()).x);
    text(rate);
    ImGui::SetCursorPosY(base);
}

// Twice the time of nine frames in ten: a single slow one does not flatten the others.
float upper_edge(std::vector<float> times) {
    if (times.empty()) {
        return min_plotted_ms;
    }
    const auto slow = times.begin() + static_cast<std::ptrdiff_t>((times.size() - 1) * 9 / 10);
    std::nth_element(times.begin(), slow, times.end());
    return std::max(min_plotted_ms, 2.0F * *slow);
}

void draw_plot(const FrameContent& frame, float scale) {
    const auto& times = frame.recent_ms;
    const float highest = upper_edge(times);
    ImGui::PlotHistogram("##times", times.data(), static_cast<int>(times.size()), 0, nullptr, 0.0F,
                         highest, {ImGui::GetContentRegionAvail().x, plot_height * scale});
    tip(fmt::format("The last {} frames; the upper edge is {:.0f} ms", times.size(), highest));
}

void draw_tiles(const view::FrameStats& stats) {
    const std::string loading =
        stats.tiles_missing > 0 ? fmt::format(", {} loading", stats.tiles_missing) : std::string();
    row("Tiles", fmt::format("{}{}", stats.tiles, loading));
    const auto& skipped = stats.skipped;
    row("Skipped", fmt::format("{} outside, {} hidden", skipped.tiles_outside_frustum,
                               skipped.tiles_occluded));
    tip(fmt::format("Tiles outside the view: {}. Tiles behind nearer ground: {}. Triangles of the "
                    "samples that the error bound saves: {}. Triangles outside: {}.",
                    skipped.tiles_outside_frustum, skipped.tiles_occluded,
                    count_text(skipped.triangles_under_error),
                    count_text(skipped.triangles_outside_frustum)));
}

} // namespace

void draw_status(const PanelContent& content, const Area& area, const Fonts& fonts) {
    const Card card("status", area);
    const FrameContent& frame = content.frame;
    {
        const FontScope bold(fonts.heading);
        fitted_text(content.terrain);
    }
    ImGui::PushStyleColor(ImGuiCol_Text, in_imgui(palette::muted));
    fitted_text(technique_summary(content.technique));
    ImGui::PopStyleColor();
    draw_rate(frame, fonts);
    draw_plot(frame, ImGui::GetFontSize() / 16.0F);
    const FontScope small(fonts.small);
    row("Error", error_summary(frame.stats, content.technique.requested));
    tip("How far from its true place a pixel may show a point. exact draws the surface itself: "
        "only "
        "rounding errs");
    if (frame.stats.rays > 0) {
        row("Rays", count_text(frame.stats.rays));
        tip("Exact rays on the CPU draw techniques with an error bound, too: they are within it");
    } else {
        row("Triangles", count_text(frame.stats.triangles));
    }
    draw_tiles(frame.stats);
    if (frame.stats.choice) {
        row("Choice", choice_summary(*frame.stats.choice));
        tip("What auto draws as triangles, and what by exact rays");
    }
    row("Picture", fmt::format("{} \u00d7 {}", frame.picture.x, frame.picture.y));
}

} // namespace reljef::app
