#include "app/viewer/panels/panels.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "app/viewer/panels/appearance_panel.h"
#include "app/viewer/panels/compass_panel.h"
#include "app/viewer/panels/help_panel.h"
#include "app/viewer/panels/legend_panel.h"
#include "app/viewer/panels/message_panel.h"
#include "app/viewer/panels/panel_layout.h"
#include "app/viewer/panels/status_panel.h"
#include "app/viewer/panels/technique_panel.h"
#include "app/viewer/panels/toolkit/widgets.h"

namespace reljef::app {
namespace {

constexpr double tabs_height = 44.0; // units of text
constexpr double footer_height = 34.0;
constexpr double border_height = 14.0;

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
    tip("Copies the command that renders this view into a file");
    ImGui::SameLine();
    if (ImGui::Button("Save picture", {width, 0.0F})) {
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
    if (!ImGui::BeginTabBar("tabs")) {
        return actions;
    }
    const auto footer = static_cast<float>(scale * footer_height);
    const auto draw_tab = [&](const char* name, const auto& draw_content) {
        if (ImGui::BeginTabItem(name)) {
            ImGui::BeginChild(name, {0.0F, -footer});
            actions += draw_content();
            inspector_content_ = ImGui::GetCursorPosY();
            ImGui::EndChild();
            ImGui::EndTabItem();
        }
    };
    draw_tab("Technique", [&] { return draw_technique(content, fonts); });
    draw_tab("View", [&] { return draw_appearance(content, fonts); });
    draw_tab("Notes", [&] {
        draw_log(content, fonts);
        return PanelActions();
    });
    ImGui::EndTabBar();
    return actions += draw_footer();
}

} // namespace reljef::app
