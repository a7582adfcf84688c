#pragma once

#include "engine/core/event.h"

namespace reljef::platform {

/// Convert GLFW_KEY_…, GLFW_MOUSE_BUTTON_… and GLFW_MOD_… values.
Key key_from_glfw(int key);
MouseButton mouse_button_from_glfw(int button);
Modifiers modifiers_from_glfw(int bits);

} // namespace reljef::platform
