#include "app/viewer/panels/toolkit/widgets.h"

#include <algorithm>

namespace reljef::app {
namespace {

constexpr float tip_width = 340.0F; // units of text
constexpr const char* dots = "...";

ImVec2 vector_of(glm::dvec2 pixels) {
    return {static_cast<float>(pixels.x), static_cast<float>(pixels.y)};
}

float width_of(std::string_view line) {
    return ImGui::CalcTextSize(line.data(), line.data() + line.size()).x;
}

// The start of a UTF-8 text without half a character at its end.
std::string_view whole_characters(std::string_view text) {
    const auto is_continued = [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
    };
    while (!text.empty() && is_continued(text.back())) {
        text.remove_suffix(1);
    }
    return text.empty() ? text : text.substr(0, text.size() - 1);
}

} // namespace

ImU32 in_imgui(Rgba8 color) {
    return IM_COL32(color.r, color.g, color.b, color.a);
}

Card::Card(const char* name, const Area& area, Scrolling scrolling, Order order) {
    ImGui::SetNextWindowPos(vector_of(area.low));
    ImGui::SetNextWindowSize(vector_of(area.size()));
    ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                             ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                             ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                             ImGuiWindowFlags_NoFocusOnAppearing;
    if (order == Order::usual) { // windows without this flag are drawn over those with it
        flags |= ImGuiWindowFlags_NoBringToFrontOnFocus;
    }
    if (scrolling == Scrolling::none) {
        flags |= ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
    }
    ImGui::Begin(name, nullptr, flags);
}

Card::~Card() {
    ImGui::End();
}

void text(std::string_view line) {
    ImGui::TextUnformatted(line.data(), line.data() + line.size());
}

void muted_text(std::string_view line) {
    ImGui::PushStyleColor(ImGuiCol_Text, in_imgui(palette::muted));
    text(line);
    ImGui::PopStyleColor();
}

void wrapped_muted_text(std::string_view paragraph) {
    ImGui::PushTextWrapPos(0.0F);
    muted_text(paragraph);
    ImGui::PopTextWrapPos();
}

void warning_text(std::string_view paragraph) {
    if (paragraph.empty()) {
        return;
    }
    ImGui::PushTextWrapPos(0.0F);
    ImGui::PushStyleColor(ImGuiCol_Text, in_imgui(palette::warning));
    text(paragraph);
    ImGui::PopStyleColor();
    ImGui::PopTextWrapPos();
}

void fitted_text(const std::string& line) {
    const float room = ImGui::GetContentRegionAvail().x;
    if (width_of(line) <= room) {
        text(line);
        return;
    }
    std::string_view shown = line;
    while (!shown.empty() && width_of(shown) + width_of(dots) > room) {
        shown = whole_characters(shown);
    }
    text(std::string(shown) + dots);
    tip(line);
}

void row(std::string_view name, const std::string& value) {
    const float room = ImGui::GetContentRegionAvail().x;
    const float at = ImGui::GetCursorPosX() + std::max(room - width_of(value), 0.0F);
    muted_text(name);
    ImGui::SameLine(at);
    text(value);
}

void section(ImFont* font, std::string_view heading) {
    ImGui::Dummy({0.0F, 2.0F});
    const FontScope in_font(font);
    text(heading);
}

void tip(std::string_view explanation) {
    if (!explanation.empty() && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(tip_width * ImGui::GetFontSize() / 16.0F);
        text(explanation);
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }
}

bool wide_button(const char* label) {
    return ImGui::Button(label, {-1.0F, 0.0F});
}

std::size_t tabs(std::span<const char* const> names, std::size_t chosen, std::size_t in_a_row) {
    constexpr float gap = 4.0F;
    const float width =
        (ImGui::GetContentRegionAvail().x - gap * static_cast<float>(in_a_row - 1)) /
        static_cast<float>(in_a_row);
    std::size_t result = chosen;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {gap, gap});
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0.0F, ImGui::GetStyle().FramePadding.y});
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i % in_a_row > 0) {
            ImGui::SameLine();
        }
        ImGui::PushStyleColor(ImGuiCol_Button,
                              in_imgui(i == chosen ? palette::accent_soft : palette::field));
        result = ImGui::Button(names[i], {width, 0.0F}) ? i : result;
        ImGui::PopStyleColor();
    }
    ImGui::PopStyleVar(2);
    return result;
}

bool tick(const char* label, bool is_on) {
    bool state = is_on;
    return ImGui::Checkbox(label, &state);
}

} // namespace reljef::app
