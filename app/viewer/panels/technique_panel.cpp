#include "app/viewer/panels/technique_panel.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "app/viewer/panels/panel_text.h"
#include "app/viewer/panels/toolkit/number_control.h"
#include "app/viewer/panels/toolkit/widgets.h"

namespace reljef::app {
namespace {

constexpr double many_values = 100.0; // a slider over more is logarithmic

const scene::Technique& edited(const TechniqueContent& content) {
    return content.model ? content.models.at(*content.model).technique : content.requested;
}

PanelActions draw_models(const TechniqueContent& content) {
    PanelActions actions;
    const auto name_of = [&](std::optional<std::size_t> model) {
        return model ? content.models.at(*model).name : std::string("all models");
    };
    ImGui::SetNextItemWidth(-1.0F);
    ImGui::PushStyleColor(ImGuiCol_Text, in_imgui(content.model ? palette::accent : palette::text));
    const bool is_open = ImGui::BeginCombo("##model", name_of(content.model).c_str());
    ImGui::PopStyleColor();
    if (is_open) {
        if (ImGui::Selectable("all models", !content.model)) {
            actions.emplace_back(SelectModel{});
        }
        for (std::size_t i = 0; i < content.models.size(); ++i) {
            if (ImGui::Selectable(content.models[i].name.c_str(), content.model == i)) {
                actions.emplace_back(SelectModel{i});
            }
        }
        ImGui::EndCombo();
    }
    wrapped_muted_text(content.model
                           ? "Changes are for this model alone, which has a frame in the "
                             "view."
                           : "Changes are for all models. Choose a model to change it alone.");
    ImGui::BeginDisabled(content.is_as_at_start);
    if (wide_button("Initial techniques  (0)")) {
        actions.emplace_back(PressKey{Key::digit0});
    }
    ImGui::EndDisabled();
    tip("Gives each model the technique that it began with");
    return actions;
}

// Returns whether the user chooses it.
bool draw_choice(const TechniqueChoice& choice, bool is_chosen) {
    const scene::TechniqueInfo& info = scene::technique_info(choice.technique.id());
    ImGui::BeginDisabled(!choice.reason.empty());
    const bool is_clicked = ImGui::Selectable(std::string(info.name).c_str(), is_chosen);
    ImGui::EndDisabled();
    tip(choice.reason.empty() ? info.meaning : std::string_view(choice.reason));
    if (choice.digit) {
        const std::string digit = fmt::format("{}", *choice.digit);
        ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(digit.c_str()).x);
        muted_text(digit);
    }
    return is_clicked;
}

PanelActions draw_choices(const TechniqueContent& content) {
    PanelActions actions;
    const scene::TechniqueInfo& info = scene::technique_info(edited(content).id());
    ImGui::SetNextItemWidth(-1.0F);
    if (ImGui::BeginCombo("##technique", std::string(info.name).c_str(),
                          ImGuiComboFlags_HeightLargest)) {
        for (const TechniqueChoice& choice : content.choices) {
            if (draw_choice(choice, choice.technique.id() == info.id)) {
                actions.emplace_back(ChooseTechnique{choice.technique, content.model});
            }
        }
        ImGui::EndCombo();
    }
    return actions;
}

NumberControl control_of(const scene::NumberInfo& number) {
    const bool is_wide = number.low >= 0.0 && number.high - number.low >= many_values;
    const bool has_gap = number.min_above_low > number.low;
    return {.slider = {number.low, number.high},
            .decimals = {},
            .is_logarithmic = is_wide || has_gap,
            .meaning = number.meaning};
}

std::optional<double> draw_value(const scene::NumberInfo& number, double value, float width) {
    const auto typed = number_box(short_number(value), width, number.meaning);
    const auto moved = number_slider(control_of(number), value);
    const auto changed = typed ? typed : moved;
    return changed ? std::optional(scene::nearest_allowed(number, *changed)) : std::nullopt;
}

// A row of a number: its name, a way back to its default, and a slider or a box.
std::optional<double> draw_number(const scene::NumberInfo& number, double value, double usual,
                                  bool is_selected) {
    std::optional<double> chosen;
    const bool is_switch = number.whole && number.low == 0.0 && number.high == 1.0;
    ImGui::PushID(std::string(number.name).c_str());
    ImGui::PushStyleColor(ImGuiCol_Text, in_imgui(is_selected ? palette::accent : palette::text));
    text(number.name);
    ImGui::PopStyleColor();
    tip(number.meaning);
    if (value != usual) {
        ImGui::SameLine();
        const std::string label = "default " + short_number(usual);
        chosen = ImGui::SmallButton(label.c_str()) ? std::optional(usual) : chosen;
    }
    const float width = is_switch ? ImGui::GetFrameHeight() : number_box_width();
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - width);
    if (is_switch) {
        const double other = value == 0.0 ? 1.0 : 0.0;
        chosen = tick("##tick", value != 0.0) ? std::optional(other) : chosen;
        tip(number.meaning);
    } else if (const auto changed = draw_value(number, value, width)) {
        chosen = changed;
    }
    ImGui::PopID();
    return chosen != value ? chosen : std::nullopt;
}

// A word on a parameter that another one puts out of action.
void draw_replacement(std::span<const scene::ParameterInfo> all,
                      const scene::ParameterInfo& parameter, const scene::Technique& technique) {
    const auto other = std::find_if(all.begin(), all.end(), [&](const auto& candidate) {
        return candidate.name == parameter.replaced_by;
    });
    if (other != all.end() && other->get(technique) != other->default_value) {
        wrapped_muted_text(fmt::format("Not used beside {0}. A change here sets {0} to {1}.",
                                       other->name, short_number(other->default_value)));
    }
}

PanelActions draw_parameters(const TechniqueContent& content) {
    PanelActions actions;
    const scene::Technique& technique = edited(content);
    const auto parameters = scene::technique_info(technique.id()).parameters;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const bool is_selected = i == content.parameter;
        const double usual = parameters[i].get(content.usual.id() == technique.id()
                                                   ? content.usual
                                                   : scene::make_technique(technique.id()));
        const auto value =
            draw_number(parameters[i], parameters[i].get(technique), usual, is_selected);
        draw_replacement(parameters, parameters[i], technique);
        if (value) {
            actions.emplace_back(SelectParameter{i});
            actions.emplace_back(ChooseTechnique{
                scene::with_parameter(technique, parameters[i], *value), content.model});
        }
    }
    return actions;
}

// The words of an option; the first is its default if that is no word.
struct OptionWords {
    std::vector<std::string> words;
    std::size_t chosen = 0;
    bool has_default_first = false;
};

OptionWords words_of(const scene::OptionInfo& option, const scene::TechniqueOptions& options) {
    OptionWords result;
    const auto found = std::find(option.words.begin(), option.words.end(), option.default_value);
    result.has_default_first = found == option.words.end();
    if (result.has_default_first) {
        result.words.emplace_back(option.default_value);
    }
    result.words.insert(result.words.end(), option.words.begin(), option.words.end());
    if (option.words.empty()) {
        result.words.push_back(scene::form_of(option));
    }
    const std::size_t first = result.has_default_first ? 1 : 0;
    const auto chosen = option.chosen(options);
    result.chosen =
        chosen
            ? *chosen + first
            : static_cast<std::size_t>(result.has_default_first ? 0 : found - option.words.begin());
    return result;
}

std::optional<std::size_t> draw_words(const scene::OptionInfo& option, const OptionWords& words) {
    std::optional<std::size_t> clicked;
    ImGui::SetNextItemWidth(-1.0F);
    if (ImGui::BeginCombo("##words", words.words[words.chosen].c_str())) {
        for (std::size_t i = 0; i < words.words.size(); ++i) {
            if (ImGui::Selectable(words.words[i].c_str(), i == words.chosen)) {
                clicked = i;
            }
        }
        ImGui::EndCombo();
    }
    tip(option.meaning);
    return clicked;
}

std::optional<scene::TechniqueOptions> draw_option(const scene::OptionInfo& option,
                                                   const scene::TechniqueOptions& options) {
    scene::TechniqueOptions changed = options;
    const OptionWords words = words_of(option, options);
    if (const auto clicked = draw_words(option, words)) {
        const bool is_default =
            words.has_default_first ? *clicked == 0 : words.words[*clicked] == option.default_value;
        const std::size_t first = words.has_default_first ? 1 : 0;
        option.choose(changed, is_default ? std::nullopt : std::optional(*clicked - first));
        return changed;
    }
    const auto chosen = option.chosen(options);
    const bool has_numbers = chosen && (option.words.empty() || *chosen + 1 == option.words.size());
    for (const scene::OptionNumberInfo& number : option.numbers) {
        const auto value = has_numbers ? number.get(options) : std::nullopt;
        if (const auto moved =
                value ? draw_number(number, *value, number.default_value, false) : std::nullopt) {
            number.set(changed, *moved);
            return changed;
        }
    }
    return std::nullopt;
}

PanelActions draw_options(const TechniqueContent& content) {
    PanelActions actions;
    const scene::Technique& technique = edited(content);
    const auto options = scene::option_catalogue();
    for (std::size_t i = 0; i < options.size(); ++i) {
        const std::string reason =
            i < content.option_reasons.size() ? content.option_reasons[i] : std::string();
        ImGui::PushID(static_cast<int>(i));
        ImGui::BeginDisabled(!reason.empty());
        ImGui::AlignTextToFramePadding();
        text(options[i].name);
        tip(reason.empty() ? options[i].meaning : std::string_view(reason));
        ImGui::SameLine(0.38F * ImGui::GetWindowContentRegionMax().x);
        const auto changed = draw_option(options[i], technique.options);
        ImGui::EndDisabled();
        tip(reason);
        ImGui::PopID();
        if (changed) {
            scene::Technique other = technique;
            other.options = *changed;
            actions.emplace_back(ChooseTechnique{other, content.model});
        }
    }
    return actions;
}

} // namespace

PanelActions draw_technique(const PanelContent& content, const Fonts& fonts) {
    const TechniqueContent& technique = content.technique;
    PanelActions actions;
    if (!technique.models.empty()) {
        actions += draw_models(technique);
    }
    actions += draw_choices(technique);
    const scene::TechniqueInfo& info = scene::technique_info(edited(technique).id());
    const FontScope small(fonts.small);
    wrapped_muted_text(info.meaning);
    tip(info.source);
    if (!info.parameters.empty()) {
        section(fonts.heading, "Parameters");
        actions += draw_parameters(technique);
    }
    section(fonts.heading, "Options");
    actions += draw_options(technique);
    section(fonts.heading, "On the command line");
    wrapped_muted_text(scene::to_string(edited(technique)));
    return actions;
}

void draw_selected_model(const PanelContent& content, const Area& view, const Fonts& fonts) {
    constexpr float thick = 2.0F;
    constexpr float corner_share = 0.2F; // of the shorter side
    constexpr float margin = 6.0F;
    const TechniqueContent& technique = content.technique;
    const ModelContent* const model =
        technique.model ? &technique.models.at(*technique.model) : nullptr;
    if (model == nullptr || !model->box) {
        return;
    }
    const FontScope small(fonts.small);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImVec2 low{static_cast<float>(model->box->low.x) - margin,
                     static_cast<float>(model->box->low.y) - margin};
    const ImVec2 high{static_cast<float>(model->box->high.x) + margin,
                      static_cast<float>(model->box->high.y) + margin};
    const float length = corner_share * std::min(high.x - low.x, high.y - low.y);
    const ImU32 color = in_imgui(palette::accent);
    for (const float x : {low.x, high.x}) {
        for (const float y : {low.y, high.y}) {
            const float along = x == low.x ? length : -length;
            const float down = y == low.y ? length : -length;
            list.AddLine({x, y}, {x + along, y}, color, thick);
            list.AddLine({x, y}, {x, y + down}, color, thick);
        }
    }
    const ImVec2 size = ImGui::CalcTextSize(model->name.c_str());
    const ImVec2 label{low.x, std::max(low.y - size.y - margin, static_cast<float>(view.low.y))};
    list.AddRectFilled({label.x - 4.0F, label.y - 1.0F},
                       {label.x + size.x + 4.0F, label.y + size.y + 1.0F},
                       in_imgui(palette::surface), 3.0F);
    list.AddText(label, color, model->name.c_str());
}

} // namespace reljef::app
