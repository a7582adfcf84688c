#pragma once

#include "engine/core/event.h"

namespace reljef::platform {

/// GLFW's numbers (GLFW_KEY_…, GLFW_MOUSE_BUTTON_…, GLFW_MOD_…) as the engine's events say it.
Key key_from_glfw(int key);
MouseButton mouse_button_from_glfw(int button);
Modifiers modifiers_from_glfw(int bits);

} // namespace reljef::platform
