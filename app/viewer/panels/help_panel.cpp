#include "app/viewer/panels/help_panel.h"

#include "app/viewer/panels/toolkit/widgets.h"

namespace reljef::app {

bool draw_help(const PanelContent& content, const Area& area, const Fonts& fonts) {
    ImGui::PushStyleColor(ImGuiCol_WindowBg, in_imgui(palette::raised));
    const Card card("help", area, Card::Scrolling::none, Card::Order::top);
    ImGui::PopStyleColor();
    {
        const FontScope bold(fonts.heading);
        text("Keys");
    }
    constexpr const char* close = "Close";
    const float width = ImGui::CalcTextSize(close).x + 2.0F * ImGui::GetStyle().FramePadding.x;
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - width);
    const bool is_closed = ImGui::Button(close);
    const FontScope small(fonts.small);
    if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollY)) {
        ImGui::TableSetupColumn("names");
        ImGui::TableSetupColumn("meaning", ImGuiTableColumnFlags_WidthStretch);
        for (const KeyContent& key : content.keys) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::PushStyleColor(ImGuiCol_Text, in_imgui(palette::accent));
            text(key.names);
            ImGui::PopStyleColor();
            ImGui::TableNextColumn();
            ImGui::PushTextWrapPos(0.0F);
            text(key.meaning);
            ImGui::PopTextWrapPos();
        }
        ImGui::EndTable();
    }
    return is_closed;
}

} // namespace reljef::app
