#pragma once

#include <functional>

#include <glm/vec2.hpp>

#include "engine/core/event.h"

namespace reljef::app {

/// What the panels showed in their last frame.
struct PanelsShown {
    std::function<bool(glm::dvec2 pixel)> is_over; ///< whether a panel covers the pixel
    bool types_text = false; ///< a text field has the keyboard; a click elsewhere ends that
    bool opens_list = false; ///< a list is open; a click elsewhere or Escape closes it
};

/// Decides who receives an event: the panels or the view. A drag stays where it began.
class PointerFocus {
public:
    enum class Receiver { panels, view, both };

    Receiver receiver_of(const Event& event, const PanelsShown& shown);

private:
    Receiver receiver_of_pointer(const Event& event, const PanelsShown& shown);
    Receiver receiver_of_button(const MouseButtonEvent& event, bool is_over, bool types_text);

    glm::dvec2 pointer_{-1.0};
    int held_ = 0;                      // mouse buttons
    Receiver dragged_ = Receiver::view; // while buttons are held
};

} // namespace reljef::app
