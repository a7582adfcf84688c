#include "app/viewer/panels/place_panel.h"

#include <fmt/format.h>

#include "app/viewer/panels/toolkit/widgets.h"

namespace reljef::app {
namespace {

std::string eye_text(const PanelContent& content, PlaceFormat format) {
    const PlaceContent& eye = content.eye;
    std::string line = place_text(eye, format);
    if (content.appearance.shows_map) {
        return line;
    }
    line += fmt::format("   {:.0f} m", eye.height);
    if (eye.above_ground) {
        line += fmt::format("   {} above ground", length_text(*eye.above_ground));
    }
    return line;
}

std::string cursor_text(const PlaceContent& cursor, PlaceFormat format) {
    const std::string object = cursor.object.empty() ? "" : "   " + cursor.object;
    return fmt::format("{}   {:.1f} m{}", place_text(cursor, format), cursor.height, object);
}

void draw_part(const char* name, const std::string& value) {
    muted_text(name);
    ImGui::SameLine();
    text(value);
}

} // namespace

void PlacePanel::draw(const PanelContent& content, const Area& area, const Fonts& fonts) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {14.0F, 0.0F});
    const Card card("place", area);
    ImGui::PopStyleVar();
    const FontScope small(fonts.small);
    const auto height = static_cast<float>(area.size().y);
    const auto width = static_cast<float>(area.size().x);
    ImGui::SetCursorPos({0.0F, 0.0F});
    if (ImGui::InvisibleButton("format", {width, height})) {
        format_ = next_format(format_, content.eye);
    }
    tip(content.eye.on_earth
            ? "Click: latitude and longitude, MGRS, coordinates of the source, or scene metres"
            : "Scene metres from the middle of the terrain: x east, y north");
    ImGui::SetCursorPos({14.0F, 0.5F * (height - ImGui::GetTextLineHeight())});
    draw_part(content.appearance.shows_map ? "Middle" : "Eye", eye_text(content, format_));
    if (content.cursor) {
        ImGui::SameLine(0.0F, 22.0F);
        draw_part("Pointer", cursor_text(*content.cursor, format_));
    }
    const std::string keys = "H  help     Tab  hide panels";
    const float at = width - 14.0F - ImGui::CalcTextSize(keys.c_str()).x;
    ImGui::SameLine();
    if (ImGui::GetCursorPosX() < at) { // it is the first to go in narrow windows
        ImGui::SetCursorPosX(at);
        muted_text(keys);
    }
}

} // namespace reljef::app
