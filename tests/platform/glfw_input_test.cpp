#include "engine/platform/glfw_input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

namespace reljef::platform {
namespace {

TEST(GlfwInputTest, runs_of_keys_keep_their_order_to_the_end) {
    EXPECT_EQ(key_from_glfw(GLFW_KEY_A), Key::a);
    EXPECT_EQ(key_from_glfw(GLFW_KEY_W), Key::w);
    EXPECT_EQ(key_from_glfw(GLFW_KEY_Z), Key::z);
    EXPECT_EQ(key_from_glfw(GLFW_KEY_0), Key::digit0);
    EXPECT_EQ(key_from_glfw(GLFW_KEY_9), Key::digit9);
    EXPECT_EQ(key_from_glfw(GLFW_KEY_KP_5), Key::digit5);
    EXPECT_EQ(key_from_glfw(GLFW_KEY_F1), Key::f1);
    EXPECT_EQ(key_from_glfw(GLFW_KEY_F12), Key::f12);
}

TEST(GlfwInputTest, twins_are_one_key) {
    EXPECT_EQ(key_from_glfw(GLFW_KEY_LEFT_SHIFT), Key::shift);
    EXPECT_EQ(key_from_glfw(GLFW_KEY_RIGHT_SHIFT), Key::shift);
    EXPECT_EQ(key_from_glfw(GLFW_KEY_EQUAL), Key::plus);
    EXPECT_EQ(key_from_glfw(GLFW_KEY_KP_ADD), Key::plus);
    EXPECT_EQ(key_from_glfw(GLFW_KEY_KP_SUBTRACT), Key::minus);
    EXPECT_EQ(key_from_glfw(GLFW_KEY_KP_ENTER), Key::enter);
}

TEST(GlfwInputTest, other_numbers_are_unknown) {
    EXPECT_EQ(key_from_glfw(GLFW_KEY_UNKNOWN), Key::unknown);
    EXPECT_EQ(key_from_glfw(GLFW_KEY_F13), Key::unknown);
    EXPECT_EQ(key_from_glfw(100000), Key::unknown);
}

TEST(GlfwInputTest, buttons_and_modifiers) {
    EXPECT_EQ(mouse_button_from_glfw(GLFW_MOUSE_BUTTON_LEFT), MouseButton::left);
    EXPECT_EQ(mouse_button_from_glfw(GLFW_MOUSE_BUTTON_MIDDLE), MouseButton::middle);
    EXPECT_EQ(mouse_button_from_glfw(GLFW_MOUSE_BUTTON_RIGHT), MouseButton::right);
    EXPECT_EQ(mouse_button_from_glfw(GLFW_MOUSE_BUTTON_8), MouseButton::other);
    EXPECT_EQ(modifiers_from_glfw(0), Modifiers{});
    EXPECT_EQ(modifiers_from_glfw(GLFW_MOD_SHIFT | GLFW_MOD_ALT),
              (Modifiers{.shift = true, .alt = true}));
    EXPECT_EQ(modifiers_from_glfw(GLFW_MOD_CONTROL | GLFW_MOD_SUPER | GLFW_MOD_CAPS_LOCK),
              (Modifiers{.control = true, .super = true}));
}

} // namespace
} // namespace reljef::platform
