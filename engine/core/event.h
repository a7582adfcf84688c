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

/// Framebuffer pixels from the upper left corner; unbounded while the mouse is captured.
struct MouseMoveEvent {
    glm::dvec2 position{0.0, 0.0};
};

struct MouseButtonEvent {
    MouseButton button = MouseButton::left;
    bool pressed = false;
    glm::dvec2 position{0.0, 0.0}; ///< as in MouseMoveEvent
    Modifiers modifiers{};
};

/// Wheel steps; y > 0 is away from the user, x > 0 to the left.
struct ScrollEvent {
    glm::dvec2 offset{0.0, 0.0};
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

using Event = std::variant<KeyEvent, MouseMoveEvent, MouseButtonEvent, ScrollEvent, ResizeEvent,
                           CloseEvent, FocusEvent>;

} // namespace reljef
