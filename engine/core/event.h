#pragma once

#include <variant>

#include <glm/vec2.hpp>

namespace reljef {

/// A key, named by its label on the US layout.
enum class Key {
    unknown,
    // clang-format off
    a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z,
    digit0, digit1, digit2, digit3, digit4, digit5, digit6, digit7, digit8, digit9,
    f1, f2, f3, f4, f5, f6, f7, f8, f9, f10, f11, f12,
    left, right, up, down,
    page_up, page_down, home, end, insert, erase,
    escape, enter, tab, backspace, space,
    plus, minus, comma, period, slash, backslash, semicolon, apostrophe, grave,
    left_bracket, right_bracket,
    // clang-format on
    shift,
    control,
    alt,
    super
};

enum class MouseButton { left, right, middle, other };

struct Modifiers {
    bool shift = false;
    bool control = false;
    bool alt = false;
    bool super = false;

    friend bool operator==(const Modifiers&, const Modifiers&) = default;
};

/// Left and right modifiers are the same key. Keypad keys are those of the main block. `=` is plus.
struct KeyEvent {
    Key key = Key::unknown;
    bool pressed = false; ///< false: released
    bool repeat = false;  ///< auto-repeat of a held key
    Modifiers modifiers{};
};

/// A character that the user typed, with the keyboard's layout and dead keys applied.
struct TextEvent {
    char32_t character = 0; ///< Unicode code point
};

/// Framebuffer pixels from the upper left corner; unbounded while the mouse is captured.
struct MouseMoveEvent {
    glm::dvec2 position{0.0, 0.0};
};

struct MouseButtonEvent {
    MouseButton button = MouseButton::left;
    bool pressed = false;
    glm::dvec2 position{0.0, 0.0}; ///< as in MouseMoveEvent
    Modifiers modifiers{};
    int clicks = 1; ///< of this press: 2 for a double click, see ClickCounter
};

/// Counts presses of one button that follow each other closely at one place.
class ClickCounter {
public:
    static constexpr double max_pause = 0.4; ///< between two presses, seconds
    static constexpr double max_way = 4.0;   ///< between two presses, pixels

    /// 1, 2, 1, 2, … for a press at a time in seconds.
    int press(MouseButton button, glm::dvec2 position, double seconds) {
        const glm::dvec2 way = position - last_position_;
        const bool follows = clicks_ == 1 && button == last_button_ &&
                             seconds - last_seconds_ <= max_pause &&
                             way.x * way.x + way.y * way.y <= max_way * max_way;
        clicks_ = follows ? 2 : 1;
        last_button_ = button;
        last_position_ = position;
        last_seconds_ = seconds;
        return clicks_;
    }

private:
    MouseButton last_button_ = MouseButton::other;
    glm::dvec2 last_position_{0.0, 0.0};
    double last_seconds_ = 0.0;
    int clicks_ = 0;
};

/// Wheel steps; y > 0 is away from the user, x > 0 to the left.
struct ScrollEvent {
    glm::dvec2 offset{0.0, 0.0};
    Modifiers modifiers{};
};

/// Framebuffer size in pixels; 0×0 while minimized. Same size: the window needs a redraw.
struct ResizeEvent {
    glm::ivec2 framebuffer{0, 0};
};

/// The user asked to close the window.
struct CloseEvent {};

/// The window gained or lost keyboard focus.
struct FocusEvent {
    bool focused = false;
};

using Event = std::variant<KeyEvent, TextEvent, MouseMoveEvent, MouseButtonEvent, ScrollEvent,
                           ResizeEvent, CloseEvent, FocusEvent>;

} // namespace reljef
