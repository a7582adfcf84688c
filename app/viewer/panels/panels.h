#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include <glm/vec2.hpp>

#include "app/viewer/panels/appearance_panel.h"
#include "app/viewer/panels/bookmark_panel.h"
#include "app/viewer/panels/panel_action.h"
#include "app/viewer/panels/panel_content.h"
#include "app/viewer/panels/path_panel.h"
#include "app/viewer/panels/place_panel.h"
#include "app/viewer/panels/toolkit/interface.h"
#include "engine/core/event.h"

namespace reljef::app {

/// All panels of the viewer. Hidden ones do nothing. Destroy while the OpenGL context is current.
class Panels {
public:
    explicit Panels(Interface interface) : interface_(std::move(interface)) {}

    /// Tab hides and shows all. Returns whether the event is for the panels alone.
    bool receive(const Event& event);
    /// Whether the next frame differs from the last one, whatever the content.
    [[nodiscard]] bool is_stale() const { return is_visible_ ? interface_.is_stale() : is_hiding_; }
    /// Whether something is done to them that no frame has seen, besides moves of the pointer.
    [[nodiscard]] bool has_input() const { return is_visible_ && interface_.has_input(); }
    /// Whether a frame `seconds` after the last one of the panels needs them drawn anew. While
    /// nothing is done to them, they are drawn ten times a second.
    [[nodiscard]] bool is_due(glm::ivec2 window, double seconds) const {
        return is_stale() || seconds >= max_age || !interface_.is_kept(window);
    }
    /// Shows them as they were drawn last. Precondition: not due.
    void show_again() const { interface_.show_again(); }
    /// Has the panels drawn in the next frame.
    void refresh() { interface_.refresh(); }
    /// A sentence about fonts that are not installed, or empty.
    [[nodiscard]] const std::string& note() const { return interface_.fonts().note; }
    [[nodiscard]] bool is_visible() const { return is_visible_; }
    /// Whether the keys go to a text field.
    [[nodiscard]] bool types_text() const { return is_visible_ && interface_.types_text(); }
    [[nodiscard]] bool is_over_panel(glm::dvec2 pixel) const {
        return is_visible_ && interface_.is_over_panel(pixel);
    }
    void set_visible(bool visible);
    /// Whether a window of that size, pixels, has panels.
    [[nodiscard]] bool has_room(glm::ivec2 window) const;
    /// Shows or hides the keys; shows the panels.
    void toggle_help();

    /// Draws over the window's back buffer, `seconds` after the last frame. Returns what the user
    /// asks for. A window that is too small for panels has none.
    PanelActions draw(const PanelContent& content, glm::ivec2 window, double seconds);

    /// Draws a sentence over the whole window, in place of everything else.
    void draw_failure(const std::string& sentence, glm::ivec2 window, double seconds);

private:
    PanelActions draw_inspector(const PanelContent& content, const Area& area);
    PanelActions draw_tab(const PanelContent& content);
    void follow(const PanelContent& content);

    static constexpr double max_age = 0.1; // seconds

    Interface interface_;
    AppearancePanel appearance_;
    BookmarkPanel bookmarks_;
    PlacePanel place_;
    PathPanel path_;
    double inspector_content_ = 0.0; // height in the last frame, pixels
    std::size_t tab_ = 0;            // that the inspector shows
    std::array<bool, 3> was_on_{};   // what has a tab, in the last frame
    bool is_visible_ = true;
    bool is_hiding_ = false; // since the last frame
    bool shows_help_ = false;
};

} // namespace reljef::app
