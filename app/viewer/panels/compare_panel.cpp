#include "app/viewer/panels/compare_panel.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "app/viewer/panels/toolkit/number_control.h"
#include "app/viewer/panels/toolkit/widgets.h"

namespace reljef::app {
namespace {

struct Choice {
    CompareWith with;
    const char* label;
    const char* meaning;
};
constexpr std::array choices{
    Choice{CompareWith::nothing, "Nothing", "Only the picture of the technique"},
    Choice{CompareWith::truth, "The truth", "The exact picture by rays in double precision"},
    Choice{CompareWith::errors, "Its errors",
           "How many pixels each point is from its true place, in colours"},
    Choice{CompareWith::technique, "Another technique", "The same view, drawn otherwise"}};

std::string duration_text(const std::optional<double>& time) {
    constexpr double second = 1000.0;
    return !time            ? std::string()
           : *time < second ? fmt::format("{:.1f} ms", *time)
                            : fmt::format("{:.1f} s", *time / second);
}

PanelActions draw_choices(const CompareContent& compare) {
    PanelActions actions;
    for (const Choice& choice : choices) {
        const bool needs_truth =
            choice.with == CompareWith::truth || choice.with == CompareWith::errors;
        ImGui::BeginDisabled(needs_truth && !compare.obstacle.empty());
        if (ImGui::RadioButton(choice.label, compare.with == choice.with)) {
            actions.emplace_back(SetComparison{choice.with});
        }
        ImGui::EndDisabled();
        tip(needs_truth && !compare.obstacle.empty() ? compare.obstacle.c_str() : choice.meaning);
    }
    return actions;
}

PanelActions draw_other_technique(const PanelContent& content) {
    PanelActions actions;
    const CompareContent& compare = content.compare;
    const auto& info = scene::technique_info(compare.technique.id());
    ImGui::SetNextItemWidth(-1.0F);
    if (ImGui::BeginCombo("##other", std::string(info.name).c_str(),
                          ImGuiComboFlags_HeightLargest)) {
        for (const TechniqueChoice& choice : content.technique.choices) {
            const auto& other = scene::technique_info(choice.technique.id());
            ImGui::BeginDisabled(!choice.reason.empty());
            if (ImGui::Selectable(std::string(other.name).c_str(), other.id == info.id)) {
                actions.emplace_back(SetOtherTechnique{choice.technique});
            }
            ImGui::EndDisabled();
            tip(choice.reason.empty() ? other.meaning : std::string_view(choice.reason));
        }
        ImGui::EndCombo();
    }
    if (wide_button("Swap left and right")) {
        actions.emplace_back(SwapTechniques{});
    }
    tip("The parameters of the left technique are in the Technique tab");
    return actions;
}

PanelActions draw_line(const CompareContent& compare) {
    constexpr double percent = 100.0;
    const auto share = number_row("Line between the pictures",
                                  {.slider = {0.0, percent},
                                   .decimals = 1,
                                   .unit = "%",
                                   .meaning = "Drag the line in the picture, too; keys - and ="},
                                  percent * compare.share);
    return share ? PanelActions{SetWipe{*share / percent}} : PanelActions();
}

void draw_cells(const std::array<std::string, 3>& cells) {
    ImGui::TableNextRow();
    for (std::size_t i = 0; i < cells.size(); ++i) {
        ImGui::TableNextColumn();
        if (i == 0) {
            muted_text(cells[i]);
        } else {
            text(cells[i]);
        }
    }
}

void draw_figures(const CompareContent& compare) {
    if (!ImGui::BeginTable("figures", 3)) {
        return;
    }
    // Shares of the width, so that columns do not move with their figures.
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch, 1.2F);
    ImGui::TableSetupColumn("left", ImGuiTableColumnFlags_WidthStretch, 1.0F);
    ImGui::TableSetupColumn("right", ImGuiTableColumnFlags_WidthStretch, 1.0F);
    draw_cells({"", "left", "right"});
    draw_cells({"Time", duration_text(compare.left_ms), duration_text(compare.right_ms)});
    for (const FigureContent& figure : compare.figures) {
        draw_cells({figure.name, figure.left, figure.right});
    }
    ImGui::EndTable();
}

void draw_colors(const CompareContent& compare) {
    constexpr float height = 12.0F;
    if (compare.colors.size() < 2) {
        return;
    }
    muted_text("Colours of errors, pixels");
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    const float step = width / static_cast<float>(compare.colors.size() - 1);
    for (std::size_t i = 0; i + 1 < compare.colors.size(); ++i) {
        const float left = low.x + step * static_cast<float>(i);
        const ImU32 from = in_imgui(compare.colors[i].color);
        const ImU32 to = in_imgui(compare.colors[i + 1].color);
        list.AddRectFilledMultiColor({left, low.y}, {left + step, low.y + height}, from, to, to,
                                     from);
    }
    ImGui::Dummy({width, height});
    const std::size_t middle = compare.colors.size() / 2;
    text(fmt::format("{:.2g}", compare.colors.front().height));
    ImGui::SameLine(0.5F * width);
    text(fmt::format("{:.2g}", compare.colors[middle].height));
    const std::string last = fmt::format("{:.2g} or more", compare.colors.back().height);
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(last.c_str()).x);
    text(last);
    wrapped_muted_text("Grey: less. Green: less, but ground behind the true one. Light blue: a "
                       "hole. Pink: terrain where there is sky, or an error without bound.");
}

void draw_state(const CompareContent& compare) {
    if (!compare.state.empty()) {
        wrapped_muted_text(compare.state);
        ImGui::ProgressBar(static_cast<float>(compare.progress), {-1.0F, 5.0F}, "");
    }
}

// A label whose right or left edge is at x; none where it would be beyond the area.
void draw_label(const std::string& line, ImVec2 at, float alignment, const Area& area) {
    constexpr float margin = 8.0F;
    const ImVec2 size = ImGui::CalcTextSize(line.c_str());
    const float width = size.x + 2.0F * margin;
    const ImVec2 low{at.x - alignment * width, at.y};
    if (low.x < static_cast<float>(area.low.x) || low.x + width > static_cast<float>(area.high.x)) {
        return;
    }
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddRectFilled(low, {low.x + size.x + 2.0F * margin, low.y + size.y + margin},
                       in_imgui(palette::surface), 4.0F);
    list.AddText({low.x + margin, low.y + 0.5F * margin}, in_imgui(palette::text), line.c_str());
}

std::string label_of(const std::string& name, const std::optional<double>& time) {
    return time ? fmt::format("{}   {}", name, duration_text(time)) : name;
}

} // namespace

PanelActions draw_compare(const PanelContent& content, const Fonts& fonts) {
    const CompareContent& compare = content.compare;
    const FontScope small(fonts.small);
    PanelActions actions;
    section(fonts.heading, "Compare with  (Space, Enter)");
    actions += draw_choices(compare);
    if (compare.with == CompareWith::technique) {
        actions += draw_other_technique(content);
    }
    if (compare.with == CompareWith::nothing) {
        wrapped_muted_text("A line divides the picture: the technique on the left, and on the "
                           "right what you choose here.");
        return actions;
    }
    actions += draw_line(compare);
    section(fonts.heading, "This view");
    draw_figures(compare);
    draw_state(compare);
    if (compare.with == CompareWith::errors) {
        draw_colors(compare);
    }
    return actions;
}

void draw_wipe(const PanelContent& content, const Area& view, const Fonts& fonts) {
    constexpr float gap = 10.0F;
    constexpr float radius = 9.0F;
    const CompareContent& compare = content.compare;
    if (compare.with == CompareWith::nothing) {
        return;
    }
    const FontScope small(fonts.small);
    const auto line = static_cast<float>(compare.share * content.frame.window.x);
    const auto top = static_cast<float>(view.low.y);
    draw_label(label_of(compare.left_name, compare.left_ms), {line - gap, top}, 1.0F, view);
    const std::string& waits = compare.state;
    draw_label(waits.empty() ? label_of(compare.right_name, compare.right_ms)
                             : fmt::format("{}: {}", compare.right_name, waits),
               {line + gap, top}, 0.0F, view);
    const ImVec2 handle{line, 0.5F * static_cast<float>(view.low.y + view.high.y)};
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddCircleFilled(handle, radius, in_imgui(palette::text));
    for (const float side : {-1.0F, 1.0F}) {
        list.AddTriangleFilled(
            {handle.x + side * 7.0F, handle.y}, {handle.x + side * 2.0F, handle.y - 4.0F},
            {handle.x + side * 2.0F, handle.y + 4.0F}, in_imgui(palette::raised));
    }
}

} // namespace reljef::app
