#include "app/viewer/panels/toolkit/pointer_focus.h"

#include <algorithm>
#include <variant>

namespace reljef::app {

PointerFocus::Receiver PointerFocus::receiver_of(const Event& event, const PanelsShown& shown) {
    if (const auto* key = std::get_if<KeyEvent>(&event)) {
        const bool is_typed = shown.types_text || (shown.opens_list && key->key == Key::escape);
        return is_typed && key->pressed ? Receiver::panels
                                        : Receiver::both; // both learn what is released
    }
    if (std::holds_alternative<TextEvent>(event)) {
        return shown.types_text ? Receiver::panels : Receiver::view;
    }
    if (const auto* focus = std::get_if<FocusEvent>(&event)) {
        held_ = focus->focused ? held_ : 0;
        return Receiver::both;
    }
    return receiver_of_pointer(event, shown);
}

PointerFocus::Receiver PointerFocus::receiver_of_pointer(const Event& event,
                                                         const PanelsShown& shown) {
    const auto is_over = [&] { return shown.opens_list || shown.is_over(pointer_); };
    if (const auto* move = std::get_if<MouseMoveEvent>(&event)) {
        pointer_ = move->position;
        return held_ == 0 ? Receiver::both // panels highlight what is below the pointer
                          : dragged_;
    }
    if (const auto* button = std::get_if<MouseButtonEvent>(&event)) {
        pointer_ = button->position;
        return receiver_of_button(*button, is_over(), shown.types_text);
    }
    if (std::holds_alternative<ScrollEvent>(event)) {
        return is_over() ? Receiver::panels : Receiver::view;
    }
    return Receiver::both;
}

PointerFocus::Receiver PointerFocus::receiver_of_button(const MouseButtonEvent& event, bool is_over,
                                                        bool types_text) {
    if (held_ == 0) {
        dragged_ = is_over      ? Receiver::panels
                   : types_text ? Receiver::both // it ends the typing
                                : Receiver::view;
    }
    held_ = std::max(held_ + (event.pressed ? 1 : -1), 0);
    return dragged_;
}

} // namespace reljef::app
