#include "engine/platform/glfw_input.h"

#include <array>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace reljef::platform {

namespace {

struct KeyPair {
    int glfw;
    Key key;
};

constexpr std::array other_keys{KeyPair{GLFW_KEY_LEFT, Key::left},
                                KeyPair{GLFW_KEY_RIGHT, Key::right},
                                KeyPair{GLFW_KEY_UP, Key::up},
                                KeyPair{GLFW_KEY_DOWN, Key::down},
                                KeyPair{GLFW_KEY_PAGE_UP, Key::page_up},
                                KeyPair{GLFW_KEY_PAGE_DOWN, Key::page_down},
                                KeyPair{GLFW_KEY_HOME, Key::home},
                                KeyPair{GLFW_KEY_END, Key::end},
                                KeyPair{GLFW_KEY_INSERT, Key::insert},
                                KeyPair{GLFW_KEY_DELETE, Key::erase},
                                KeyPair{GLFW_KEY_ESCAPE, Key::escape},
                                KeyPair{GLFW_KEY_ENTER, Key::enter},
                                KeyPair{GLFW_KEY_KP_ENTER, Key::enter},
                                KeyPair{GLFW_KEY_TAB, Key::tab},
                                KeyPair{GLFW_KEY_BACKSPACE, Key::backspace},
                                KeyPair{GLFW_KEY_SPACE, Key::space},
                                KeyPair{GLFW_KEY_EQUAL, Key::plus},
                                KeyPair{GLFW_KEY_KP_ADD, Key::plus},
                                KeyPair{GLFW_KEY_MINUS, Key::minus},
                                KeyPair{GLFW_KEY_KP_SUBTRACT, Key::minus},
                                KeyPair{GLFW_KEY_COMMA, Key::comma},
                                KeyPair{GLFW_KEY_PERIOD, Key::period},
                                KeyPair{GLFW_KEY_KP_DECIMAL, Key::period},
                                KeyPair{GLFW_KEY_SLASH, Key::slash},
                                KeyPair{GLFW_KEY_BACKSLASH, Key::backslash},
                                KeyPair{GLFW_KEY_SEMICOLON, Key::semicolon},
                                KeyPair{GLFW_KEY_APOSTROPHE, Key::apostrophe},
                                KeyPair{GLFW_KEY_GRAVE_ACCENT, Key::grave},
                                KeyPair{GLFW_KEY_LEFT_BRACKET, Key::left_bracket},
                                KeyPair{GLFW_KEY_RIGHT_BRACKET, Key::right_bracket},
                                KeyPair{GLFW_KEY_LEFT_SHIFT, Key::shift},
                                KeyPair{GLFW_KEY_RIGHT_SHIFT, Key::shift},
                                KeyPair{GLFW_KEY_LEFT_CONTROL, Key::control},
                                KeyPair{GLFW_KEY_RIGHT_CONTROL, Key::control},
                                KeyPair{GLFW_KEY_LEFT_ALT, Key::alt},
                                KeyPair{GLFW_KEY_RIGHT_ALT, Key::alt},
                                KeyPair{GLFW_KEY_LEFT_SUPER, Key::super},
                                KeyPair{GLFW_KEY_RIGHT_SUPER, Key::super}};

bool within(int value, int first, int last) {
    return value >= first && value <= last;
}

Key shifted(Key first, int steps) {
    return static_cast<Key>(static_cast<int>(first) + steps);
}

} // namespace

Key key_from_glfw(int key) {
    if (within(key, GLFW_KEY_A, GLFW_KEY_Z)) {
        return shifted(Key::a, key - GLFW_KEY_A);
    }
    if (within(key, GLFW_KEY_0, GLFW_KEY_9)) {
        return shifted(Key::digit0, key - GLFW_KEY_0);
    }
    if (within(key, GLFW_KEY_KP_0, GLFW_KEY_KP_9)) {
        return shifted(Key::digit0, key - GLFW_KEY_KP_0);
    }
    if (within(key, GLFW_KEY_F1, GLFW_KEY_F12)) {
        return shifted(Key::f1, key - GLFW_KEY_F1);
    }
    for (const KeyPair& pair : other_keys) {
        if (pair.glfw == key) {
            return pair.key;
        }
    }
    return Key::unknown;
}

MouseButton mouse_button_from_glfw(int button) {
    switch (button) {
    case GLFW_MOUSE_BUTTON_LEFT:
        return MouseButton::left;
    case GLFW_MOUSE_BUTTON_RIGHT:
        return MouseButton::right;
    case GLFW_MOUSE_BUTTON_MIDDLE:
        return MouseButton::middle;
    default:
        return MouseButton::other;
    }
}

Modifiers modifiers_from_glfw(int bits) {
    const auto has = [bits](int bit) { return (bits & bit) != 0; };
    return {.shift = has(GLFW_MOD_SHIFT),
            .control = has(GLFW_MOD_CONTROL),
            .alt = has(GLFW_MOD_ALT),
            .super = has(GLFW_MOD_SUPER)};
}

} // namespace reljef::platform
