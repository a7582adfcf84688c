#pragma once

#include <functional>
#include <memory>
#include <string>

#include <glm/vec2.hpp>

#include "app/viewer/panels/toolkit/pointer_focus.h"
#include "app/viewer/panels/toolkit/theme.h"
#include "engine/core/event.h"
#include "engine/core/result.h"

namespace reljef::app {

struct InterfaceOptions {
    double scale = 1.0; ///< pixels per unit of text
    bool draws = true;  ///< with the current OpenGL context; false: tests
    /// The CPU draws what changes in panels and keeps it. False: OpenGL draws each frame.
    bool keeps_unchanged = true;
    std::function<std::string()> clipboard = {};
    std::function<void(const std::string&)> set_clipboard = {};
};

/// A rectangle of the window, pixels from the upper left corner.
struct Area {
    glm::dvec2 low{0.0};
    glm::dvec2 high{0.0};

    [[nodiscard]] glm::dvec2 size() const { return high - low; }
    [[nodiscard]] bool contains(glm::dvec2 pixel) const {
        return pixel.x >= low.x && pixel.y >= low.y && pixel.x < high.x && pixel.y < high.y;
    }
};

/// Dear ImGui with the theme, without files of its own. Use and destroy it on the thread of its
/// OpenGL context, while the context is current.
class Interface {
public:
    /// Fails without a context of OpenGL that can draw panels.
    static Result<Interface> create(const InterfaceOptions& options = {});
    Interface(Interface&& other) noexcept;
    Interface& operator=(Interface&& other) noexcept;
    ~Interface();

    /// Returns whether the event is for the panels alone.
    bool receive(const Event& event);
    /// Whether received events change what the next frame shows.
    [[nodiscard]] bool is_stale() const;
    /// Whether keys, buttons or the wheel, or the pointer with a button held, await the next frame.
    [[nodiscard]] bool has_input() const;
    /// Whether the last frame was kept and can be shown again in a window of that size, pixels.
    [[nodiscard]] bool is_kept(glm::ivec2 size) const;
    /// Copies the kept frame over the window's back buffer. Precondition: is_kept().
    void show_again() const;
    /// Whether a text field has the keyboard.
    [[nodiscard]] bool types_text() const;
    /// The pointer, if it is over the view and not over a panel.
    [[nodiscard]] bool is_over_panel(glm::dvec2 pixel) const;
    /// Makes it stale: the content has changed.
    void refresh();
    /// Releases keys and buttons, and the areas of the last frame.
    void forget();

    /// Begins a frame for a window of `size` pixels, `seconds` after the last one.
    void begin(glm::ivec2 size, double seconds);
    /// Ends the frame and draws it over the window's back buffer. Precondition: begin().
    void end();

    [[nodiscard]] const Fonts& fonts() const;
    [[nodiscard]] float scale() const;

private:
    struct State;
    explicit Interface(std::unique_ptr<State> state);

    std::unique_ptr<State> state_;
};

} // namespace reljef::app
