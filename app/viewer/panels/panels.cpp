#include "app/viewer/panels/panels.h"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "app/viewer/panels/appearance_panel.h"
#include "app/viewer/panels/compare_panel.h"
#include "app/viewer/panels/compass_panel.h"
#include "app/viewer/panels/help_panel.h"
#include "app/viewer/panels/legend_panel.h"
#include "app/viewer/panels/measure_panel.h"
#include "app/viewer/panels/message_panel.h"
#include "app/viewer/panels/status_panel.h"
#include "app/viewer/panels/technique_panel.h"
#include "app/viewer/panels/toolkit/panel_layout.h"
#include "app/viewer/panels/toolkit/widgets.h"

namespace reljef::app {
namespace {

constexpr double tabs_height = 72.0; // units of text
constexpr double footer_height = 64.0;
constexpr double border_height = 14.0;

enum class Tab : std::size_t { technique, view, places, compare, measure, path, notes };
constexpr std::array tab_names{"Technique", "View", "Places", "Compare",
                               "Measure",   "Path", "Notes"};
constexpr std::size_t tabs_in_a_row = 4;

// The key without modifiers, when it goes down.
bool presses(const Event& event, Key key) {
    const auto* const pressed = std::get_if<KeyEvent>(&event);
    return pressed != nullptr && pressed->key == key && pressed->pressed && !pressed->repeat &&
           pressed->modifiers == Modifiers{};
}

PanelActions draw_footer() {
    PanelActions actions;
    const float width = 0.5F * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
    if (ImGui::Button("Copy as command", {width, 0.0F})) {
        actions.emplace_back(CopyCommand{});
    }
    tip("Copies the command that renders this view into a file (Z)");
    ImGui::SameLine();
    if (ImGui::Button("Copy camera", {width, 0.0F})) {
        actions.emplace_back(PressKey{Key::v});
    }
    tip("Copies the --camera of this view (V)");
    if (wide_button("Save picture")) {
        actions.emplace_back(PressKey{Key::c});
    }
    tip("Saves the picture, without panels, into the current folder (C)");
    return actions;
}

} // namespace

bool Panels::receive(const Event& event) {
    if (presses(event, Key::tab) && !(is_visible_ && interface_.types_text())) {
        set_visible(!is_visible_);
        return true;
    }
    if (!is_visible_) {
        return false;
    }
    if (shows_help_ && presses(event, Key::escape)) {
        toggle_help();
        return true;
    }
    return interface_.receive(event);
}

void Panels::set_visible(bool visible) {
    is_hiding_ = is_visible_ && !visible;
    is_visible_ = visible;
    interface_.forget();
}

bool Panels::has_room(glm::ivec2 window) const {
    return layout_for(window, interface_.scale()).has_room;
}

void Panels::toggle_help() {
    if (!is_visible_) {
        set_visible(true);
        shows_help_ = true;
    } else {
        shows_help_ = !shows_help_;
        interface_.forget();
    }
}

PanelActions Panels::draw(const PanelContent& content, glm::ivec2 window, double seconds) {
    is_hiding_ = false;
    const PanelLayout layout = layout_for(window, interface_.scale());
    if (!is_visible_) {
        return {};
    }
    const Fonts& fonts = interface_.fonts();
    PanelActions actions;
    interface_.begin(window, seconds);
    if (layout.has_room) {
        follow(content);
        draw_wipe(content, layout.view, fonts);
        draw_selected_model(content, layout.view, fonts);
        draw_points(content, fonts);
        draw_status(content, layout.status, fonts);
        if (layout.legend.size() != glm::dvec2(0.0)) {
            draw_legend(content, layout.legend, fonts);
        }
        draw_compass(content, layout.compass, fonts);
        place_.draw(content, layout.place, fonts);
        actions = draw_inspector(content, layout.inspector);
        draw_messages(content, layout.messages, fonts);
        if (shows_help_ && draw_help(content, layout.help, fonts)) {
            shows_help_ = false;
        }
    }
    interface_.end();
    return actions;
}

void Panels::draw_failure(const std::string& sentence, glm::ivec2 window, double seconds) {
    interface_.begin(window, seconds);
    if (has_room(window)) {
        app::draw_failure(sentence, {{0.0, 0.0}, glm::dvec2(window)}, interface_.fonts());
    }
    interface_.end();
}

PanelActions Panels::draw_inspector(const PanelContent& content, const Area& area) {
    const Fonts& fonts = interface_.fonts();
    PanelActions actions;
    // As high as what it showed last, if there is room.
    const double scale = interface_.scale();
    const double height =
        scale * (tabs_height + footer_height + border_height) + inspector_content_;
    Area fitted = area;
    fitted.high.y = std::min(area.high.y, area.low.y + height);
    const Card card("inspector", fitted);
    {
        const FontScope small(fonts.small);
        tab_ = tabs(tab_names, tab_, tabs_in_a_row);
    }
    const auto footer = static_cast<float>(scale * footer_height);
    ImGui::BeginChild(tab_names.at(tab_), {0.0F, -footer});
    actions += draw_tab(content);
    inspector_content_ = ImGui::GetCursorPosY();
    ImGui::EndChild();
    return actions += draw_footer();
}

PanelActions Panels::draw_tab(const PanelContent& content) {
    const Fonts& fonts = interface_.fonts();
    switch (static_cast<Tab>(tab_)) {
    case Tab::technique:
        return draw_technique(content, fonts);
    case Tab::view:
        return appearance_.draw(content, fonts);
    case Tab::places:
        return bookmarks_.draw(content, fonts);
    case Tab::compare:
        return draw_compare(content, fonts);
    case Tab::measure:
        return draw_measure(content, fonts);
    case Tab::path:
        return path_.draw(content, fonts);
    case Tab::notes:
        draw_log(content, fonts);
        return {};
    }
    return {};
}

// The tab of what has begun comes to the front.
void Panels::follow(const PanelContent& content) {
    const std::array shown{std::pair(content.compare.with != CompareWith::nothing, Tab::compare),
                           std::pair(content.measure.is_on, Tab::measure),
                           std::pair(content.path.is_recording || content.path.video, Tab::path)};
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const auto& [is_on, tab] = shown.at(i);
        if (is_on && !was_on_.at(i)) {
            tab_ = static_cast<std::size_t>(tab);
        }
        was_on_.at(i) = is_on;
    }
}

} // namespace reljef::app
