#include "app/viewer/panels/toolkit/pointer_focus.h"

#include <gtest/gtest.h>

namespace reljef::app {
namespace {

using Receiver = PointerFocus::Receiver;

// A panel covers the left half of a window 200 pixels wide.
PanelsShown left_panel() {
    return {[](glm::dvec2 pixel) { return pixel.x < 100.0; }, false, false};
}

MouseButtonEvent button(bool pressed, glm::dvec2 at) {
    return {.button = MouseButton::left, .pressed = pressed, .position = at};
}

constexpr glm::dvec2 over_panel{50.0, 10.0};
constexpr glm::dvec2 over_view{150.0, 10.0};

TEST(PointerFocus, ClicksAndTheWheelGoToWhatIsBelowThePointer) {
    PointerFocus focus;
    for (const auto& [at, receiver] :
         {std::pair{over_panel, Receiver::panels}, std::pair{over_view, Receiver::view}}) {
        focus.receiver_of(MouseMoveEvent{at}, left_panel());
        EXPECT_EQ(focus.receiver_of(ScrollEvent{{0.0, 1.0}}, left_panel()), receiver);
        EXPECT_EQ(focus.receiver_of(button(true, at), left_panel()), receiver);
        EXPECT_EQ(focus.receiver_of(button(false, at), left_panel()), receiver);
    }
}

TEST(PointerFocus, ADragStaysWhereItBegan) {
    for (const auto& [from, to, receiver] : {std::tuple{over_panel, over_view, Receiver::panels},
                                             std::tuple{over_view, over_panel, Receiver::view}}) {
        PointerFocus focus;
        focus.receiver_of(button(true, from), left_panel());
        EXPECT_EQ(focus.receiver_of(MouseMoveEvent{to}, left_panel()), receiver);
        EXPECT_EQ(focus.receiver_of(button(false, to), left_panel()), receiver);
        EXPECT_EQ(focus.receiver_of(MouseMoveEvent{to}, left_panel()), Receiver::both);
    }
}

TEST(PointerFocus, AWindowThatLosesTheFocusEndsTheDrag) {
    PointerFocus focus;
    focus.receiver_of(button(true, over_panel), left_panel());
    EXPECT_EQ(focus.receiver_of(FocusEvent{false}, left_panel()), Receiver::both);
    EXPECT_EQ(focus.receiver_of(button(true, over_view), left_panel()), Receiver::view);
}

TEST(PointerFocus, TypedKeysStayInTheTextFieldAndReleasesReachBoth) {
    PointerFocus focus;
    PanelsShown typing = left_panel();
    typing.types_text = true;
    const KeyEvent pressed{.key = Key::w, .pressed = true};
    const KeyEvent released{.key = Key::w, .pressed = false};
    EXPECT_EQ(focus.receiver_of(pressed, left_panel()), Receiver::both);
    EXPECT_EQ(focus.receiver_of(pressed, typing), Receiver::panels);
    EXPECT_EQ(focus.receiver_of(released, typing), Receiver::both);
    EXPECT_EQ(focus.receiver_of(TextEvent{U'w'}, typing), Receiver::panels);
    EXPECT_EQ(focus.receiver_of(TextEvent{U'w'}, left_panel()), Receiver::view);
}

TEST(PointerFocus, AClickBesideThePanelsEndsTypingAndIsTheViews) {
    PointerFocus focus;
    PanelsShown typing = left_panel();
    typing.types_text = true;
    EXPECT_EQ(focus.receiver_of(button(true, over_view), typing), Receiver::both);
    EXPECT_EQ(focus.receiver_of(button(false, over_view), left_panel()), Receiver::both)
        << "its release, too";
    EXPECT_EQ(focus.receiver_of(button(true, over_view), left_panel()), Receiver::view);
}

TEST(PointerFocus, AnOpenListTakesClicksAnywhere) {
    PointerFocus focus;
    PanelsShown listing = left_panel();
    listing.opens_list = true;
    EXPECT_EQ(focus.receiver_of(button(true, over_view), listing), Receiver::panels);
    const KeyEvent escape{.key = Key::escape, .pressed = true};
    EXPECT_EQ(focus.receiver_of(escape, listing), Receiver::panels);
    EXPECT_EQ(focus.receiver_of(escape, left_panel()), Receiver::both);
}

} // namespace
} // namespace reljef::app
