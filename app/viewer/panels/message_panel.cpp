#include "app/viewer/panels/message_panel.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/viewer/panels/toolkit/widgets.h"

namespace reljef::app {
namespace {

constexpr std::size_t max_shown = 3;

void draw_message(const MessageContent& message) {
    ImGui::PushTextWrapPos(0.0F);
    ImGui::PushStyleColor(ImGuiCol_Text,
                          in_imgui(message.is_error ? palette::warning : palette::text));
    text(message.text);
    ImGui::PopStyleColor();
    ImGui::PopTextWrapPos();
}

void draw_task(const TaskContent& task) {
    text(task.label);
    const std::string share = fmt::format("{:.0f} %", 100.0 * task.fraction);
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(share.c_str()).x);
    muted_text(share);
    ImGui::ProgressBar(static_cast<float>(task.fraction), {-1.0F, 5.0F}, "");
}

} // namespace

void draw_messages(const PanelContent& content, const Area& area, const Fonts& fonts) {
    std::vector<const MessageContent*> fresh;
    for (const MessageContent& message : content.messages) {
        if (message.age < message_seconds) {
            fresh.push_back(&message);
        }
    }
    fresh.erase(fresh.begin(),
                fresh.end() - static_cast<std::ptrdiff_t>(std::min(fresh.size(), max_shown)));
    if (fresh.empty() && content.task.label.empty()) {
        return;
    }
    const auto width = static_cast<float>(area.size().x);
    // It grows upwards with its lines.
    ImGui::SetNextWindowPos({static_cast<float>(area.low.x), static_cast<float>(area.high.y)},
                            ImGuiCond_Always, {0.0F, 1.0F});
    ImGui::SetNextWindowSizeConstraints({width, 0.0F}, {width, static_cast<float>(area.size().y)});
    ImGui::Begin("messages", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBringToFrontOnFocus |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoScrollbar);
    {
        const FontScope small(fonts.small);
        for (const MessageContent* const message : fresh) {
            draw_message(*message);
        }
        if (!content.task.label.empty()) {
            draw_task(content.task);
        }
    }
    ImGui::End();
}

void draw_failure(const std::string& sentence, const Area& area, const Fonts& fonts) {
    constexpr float lines = 40.0F; // widths of a letter "m"
    const Card card("failure", area);
    const glm::dvec2 size = area.size();
    const float width = std::min(lines * ImGui::GetFontSize(), 0.8F * static_cast<float>(size.x));
    const float left = 0.5F * (static_cast<float>(size.x) - width);
    ImGui::SetCursorPos({left, 0.33F * static_cast<float>(size.y)});
    ImGui::BeginGroup();
    {
        const FontScope bold(fonts.heading);
        text("Nothing can be shown");
    }
    ImGui::PushTextWrapPos(left + width);
    ImGui::PushStyleColor(ImGuiCol_Text, in_imgui(palette::warning));
    text(sentence);
    ImGui::PopStyleColor();
    muted_text("Esc closes the window. The sentence stands in the terminal, too.");
    ImGui::PopTextWrapPos();
    ImGui::EndGroup();
}

void draw_log(const PanelContent& content, const Fonts& fonts) {
    const FontScope small(fonts.small);
    if (content.messages.empty()) {
        wrapped_muted_text("No notes so far. Notes and errors appear here as they arrive.");
    }
    for (auto message = content.messages.rbegin(); message != content.messages.rend(); ++message) {
        draw_message(*message);
        ImGui::Separator();
    }
}

} // namespace reljef::app
