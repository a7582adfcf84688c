// Numbers that are typed arrive as typed.
#include "app/viewer/panels/toolkit/number_control.h"

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/panels/panels.h"
#include "app/viewer/panels/toolkit/panel_layout.h"
#include "app/viewer/render_command_text.h"
#include "app/viewer/viewer_content.h"
#include "engine/scene/graph/daylight.h"
#include "tests/app/effects/keyed_viewer.h"

namespace reljef::app {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr glm::ivec2 typed_window{1024, 1800}; // shows each tab without scrolling
constexpr double typed_seconds = 1.0 / 60.0;

struct NumberControlTest : testing::Test {
    PanelActions draw() { return panels.draw(content, typed_window, typed_seconds); }
    PanelActions button(glm::dvec2 at, bool pressed, Modifiers with = {}) {
        panels.receive(MouseMoveEvent{at});
        panels.receive(MouseButtonEvent{MouseButton::left, pressed, at, with});
        return draw();
    }
    PanelActions click(glm::dvec2 at, Modifiers with = {}) {
        PanelActions actions = button(at, true, with);
        actions += button(at, false, with);
        actions += draw();
        return actions += draw();
    }
    void write(const std::string& text) {
        for (const char letter : text) {
            panels.receive(TextEvent{static_cast<char32_t>(letter)});
            draw();
        }
    }
    PanelActions enter() {
        panels.receive(KeyEvent{.key = Key::enter, .pressed = true});
        panels.receive(KeyEvent{.key = Key::enter, .pressed = false});
        PanelActions actions = draw();
        actions += draw();
        return actions += draw();
    }
    void open_view() {
        draw();
        draw();
        click(layout.inspector.low + glm::dvec2(1.5 / 4.0 * layout.inspector.size().x, 20.0));
        draw();
    }
    // The first action of that kind that typing gives somewhere below the tabs; `x`: from the
    // panel's right side.
    template <class Action>
    std::vector<Action> typed_everywhere(double x, const std::string& text) {
        std::vector<Action> found;
        for (double y = layout.inspector.low.y + 74.0; y < layout.inspector.high.y - 70.0;
             y += 4.0) {
            const auto passed = [&](const PanelActions& actions) {
                for (const PanelAction& action : actions) {
                    if (const auto* const one = std::get_if<Action>(&action)) {
                        found.push_back(*one);
                    }
                }
            };
            click({layout.inspector.high.x - x, y});
            if (panels.types_text()) {
                write(text);
                passed(enter());
            }
        }
        return found;
    }

    KeyedViewer tested;
    Panels panels{Interface::create({.draws = false}).value()};
    PanelLayout layout = layout_for(typed_window, 1.0);
    PanelContent content = content_of(tested.viewer, tested.scene, typed_window);
};

constexpr double box_from_right = 60.0;

TEST_F(NumberControlTest, TypedNumbersArriveExactlyInTheSceneAndInTheCommand) {
    open_view();
    const auto suns = typed_everywhere<SetSun>(box_from_right, "31.4159");
    ASSERT_EQ(suns.size() % 2, 0U);
    ASSERT_FALSE(suns.empty());
    EXPECT_EQ(suns.front().azimuth, 31.4159);
    EXPECT_EQ(suns.back().altitude, 31.4159);
    const auto contours = typed_everywhere<SetContours>(box_from_right, "12.345");
    ASSERT_FALSE(contours.empty());
    EXPECT_EQ(contours.front().metres, 12.345);
    const auto factors = typed_everywhere<SetExaggeration>(box_from_right, "25.125");
    ASSERT_FALSE(factors.empty());
    EXPECT_EQ(factors.front().factor, 25.125) << "beyond the slider";
    ASSERT_TRUE(tested.viewer.act(suns.front()));
    ASSERT_TRUE(tested.viewer.act(contours.front()));
    ASSERT_TRUE(tested.viewer.act(factors.front()));
    tested.settle();
    EXPECT_EQ(tested.viewer.light().azimuth, 31.4159);
    const auto command = render_command({}, tested.scene,
                                        shown_state(tested.viewer, tested.scene, typed_window, {}));
    ASSERT_TRUE(command) << command.error().message;
    EXPECT_THAT(*command, HasSubstr("--sun 31.4159,"));
    EXPECT_THAT(*command, HasSubstr("--contours 12.345"));
    EXPECT_THAT(*command, HasSubstr("--exaggeration 25.125"));
}

TEST_F(NumberControlTest, AClickIntoABoxAboveOrBelowSetsWhatWasTyped) {
    open_view();
    const double x = layout.inspector.high.x - box_from_right;
    std::optional<double> azimuth;
    std::optional<double> altitude;
    for (double y = layout.inspector.low.y + 74.0; y < layout.inspector.high.y - 70.0; y += 4.0) {
        click({x, y});
        if (!panels.types_text()) {
            continue;
        }
        write("31.4159");
        for (const PanelAction& action : enter()) {
            if (const auto* const sun = std::get_if<SetSun>(&action)) {
                (sun->azimuth == 31.4159 ? azimuth : altitude) = y;
            }
        }
    }
    ASSERT_TRUE(azimuth && altitude);
    ASSERT_LT(*azimuth, *altitude);
    for (const auto& [from, to] : {std::pair(*altitude, *azimuth), {*azimuth, *altitude}}) {
        click({x, from});
        write("12.5");
        std::optional<SetSun> set;
        for (const PanelAction& action : click({x, to})) {
            if (const auto* const sun = std::get_if<SetSun>(&action)) {
                set = *sun;
            }
        }
        ASSERT_TRUE(set) << from << " to " << to;
        EXPECT_EQ(from > to ? set->altitude : set->azimuth, 12.5);
    }
}

TEST_F(NumberControlTest, EnterWithoutTypingKeepsTheDigitsThatAreNotShown) {
    open_view();
    content.appearance.turbidity = 1.23456789;
    EXPECT_TRUE(typed_everywhere<SetTurbidity>(box_from_right, "").empty());
    const auto typed = typed_everywhere<SetTurbidity>(box_from_right, "1.2346");
    ASSERT_FALSE(typed.empty());
    EXPECT_EQ(typed.front().turbidity, 1.2346) << "as it was shown";
}

TEST_F(NumberControlTest, NumbersBeyondTheAllowedOnesBecomeTheNearest) {
    open_view();
    const auto grains = typed_everywhere<SetGrain>(box_from_right, "77");
    ASSERT_FALSE(grains.empty());
    EXPECT_EQ(grains.front().strength, scene::max_grain);
    EXPECT_TRUE(typed_everywhere<SetGrain>(box_from_right, "--").empty()) << "no number";
    EXPECT_TRUE(typed_everywhere<SetGrain>(box_from_right, "1e").empty()) << "no number";
}

// The parameters of a technique.
TEST_F(NumberControlTest, AParameterIsTypedAfterControlClickOrDoubleClickOnItsSlider) {
    content.technique.requested = scene::Technique{scene::Polygons{.error = 1.0}};
    draw();
    draw();
    const auto typed = [&](bool is_double) {
        std::optional<double> error;
        const Modifiers with{.control = !is_double};
        for (double y = layout.inspector.low.y + 74.0; y < layout.inspector.high.y - 70.0 && !error;
             y += 4.0) {
            const glm::dvec2 at{layout.inspector.low.x + 100.0, y};
            panels.draw(content, typed_window, 1.0); // no click follows the last ones at once
            click(at, with);
            if (is_double) {
                click(at, with);
            }
            panels.receive(KeyEvent{.key = Key::control, .pressed = false});
            draw();
            draw();
            if (!panels.types_text()) {
                continue;
            }
            write("4.1484375");
            for (const PanelAction& action : enter()) {
                const auto* const choice = std::get_if<ChooseTechnique>(&action);
                const auto* const polygons =
                    choice != nullptr ? std::get_if<scene::Polygons>(&choice->technique.parameters)
                                      : nullptr;
                if (polygons != nullptr && polygons->error > 1.0) {
                    error = polygons->error;
                }
            }
        }
        return error;
    };
    EXPECT_EQ(typed(false), 4.1484375);
    EXPECT_EQ(typed(true), 4.1484375);
}

// The first click of the two moves the slider.
TEST_F(NumberControlTest, ADoubleClickOnASliderBeginsWithTheNumberOfBeforeIt) {
    open_view();
    constexpr double before = 3.0625; // more digits than the slider gives
    content.appearance.turbidity = before;
    std::optional<double> typed_at;
    bool has_moved = false;
    const auto follow = [&](const PanelActions& actions) {
        for (const PanelAction& action : actions) {
            if (const auto* const set = std::get_if<SetTurbidity>(&action)) {
                content.appearance.turbidity = set->turbidity;
                has_moved = true;
            }
        }
    };
    for (double y = layout.inspector.low.y + 74.0; y < layout.inspector.high.y - 70.0 && !typed_at;
         y += 4.0) {
        const glm::dvec2 at{layout.inspector.low.x + 200.0, y};
        panels.draw(content, typed_window, 1.0); // no click follows the last ones at once
        follow(click(at));
        if (has_moved) {
            EXPECT_NE(content.appearance.turbidity, before);
            follow(click(at));
            typed_at = y;
        }
    }
    ASSERT_TRUE(typed_at);
    ASSERT_TRUE(panels.types_text());
    EXPECT_EQ(content.appearance.turbidity, before);
    panels.receive(KeyEvent{.key = Key::escape, .pressed = true});
    panels.receive(KeyEvent{.key = Key::escape, .pressed = false});
    for (int frame = 0; frame < 4; ++frame) {
        follow(draw());
    }
    EXPECT_FALSE(panels.types_text());
    EXPECT_EQ(content.appearance.turbidity, before) << "given up";
}

TEST_F(NumberControlTest, AClickBesideASliderIsNotTheFirstOfADoubleClickOnIt) {
    open_view();
    const double before = content.appearance.turbidity;
    for (double y = layout.inspector.low.y + 74.0; y < layout.inspector.high.y - 70.0; y += 4.0) {
        const glm::dvec2 at{layout.inspector.low.x + 200.0, y};
        panels.draw(content, typed_window, 1.0);
        click(at - glm::dvec2(0.0, 4.0));
        for (const PanelAction& action : click(at)) {
            if (const auto* const set = std::get_if<SetTurbidity>(&action)) {
                EXPECT_GE(set->turbidity, scene::min_turbidity);
                EXPECT_LE(set->turbidity, scene::max_turbidity);
                content.appearance.turbidity = before;
            }
        }
        panels.receive(KeyEvent{.key = Key::escape, .pressed = true});
        panels.receive(KeyEvent{.key = Key::escape, .pressed = false});
        draw();
    }
}

// "0" would be a factor that is refused.
TEST_F(NumberControlTest, ASmallExaggerationIsShownAndKeptAsItIs) {
    std::string copied;
    panels =
        Panels(Interface::create({.draws = false,
                                  .set_clipboard = [&](const std::string& text) { copied = text; }})
                   .value());
    open_view();
    content.appearance.exaggeration = 1e-6;
    std::vector<std::string> shown;
    for (double y = layout.inspector.low.y + 74.0; y < layout.inspector.high.y - 70.0; y += 4.0) {
        click({layout.inspector.high.x - box_from_right, y});
        if (panels.types_text()) {
            copied.clear();
            panels.receive(
                KeyEvent{.key = Key::c, .pressed = true, .modifiers = {.control = true}});
            panels.receive(KeyEvent{.key = Key::c, .pressed = false});
            panels.receive(KeyEvent{.key = Key::control, .pressed = false});
            draw();
            draw();
            shown.push_back(copied);
            enter();
        }
    }
    EXPECT_THAT(shown, Contains("1e-06"));
}

TEST_F(NumberControlTest, AClickElsewhereEndsTypingAndEscapeGivesItUp) {
    open_view();
    const auto leave = [&](const std::function<PanelActions()>& how) {
        std::optional<double> turbidity;
        for (double y = layout.inspector.low.y + 74.0;
             y < layout.inspector.low.y + 400.0 && !turbidity; y += 4.0) {
            click({layout.inspector.high.x - box_from_right, y});
            if (panels.types_text()) {
                write("7.25");
                for (const PanelAction& action : how()) {
                    const auto* const set = std::get_if<SetTurbidity>(&action);
                    turbidity = set != nullptr ? std::optional(set->turbidity) : turbidity;
                }
            }
        }
        return turbidity;
    };
    const glm::dvec2 above{layout.inspector.low.x + 100.0, layout.inspector.low.y + 116.0};
    const glm::dvec2 beside{0.5 * (layout.view.low + layout.view.high)};
    EXPECT_EQ(leave([&] { return click(above); }), 7.25) << "a slider that is drawn before";
    EXPECT_EQ(leave([&] { return click(beside); }), 7.25) << "the view";
    EXPECT_EQ(leave([&] {
                  panels.receive(KeyEvent{.key = Key::escape, .pressed = true});
                  panels.receive(KeyEvent{.key = Key::escape, .pressed = false});
                  PanelActions actions = draw();
                  return actions += draw();
              }),
              std::nullopt);
}

TEST(NumberText, HasNoTrailingZeros) {
    EXPECT_EQ(number_text(200.0, 3), "200");
    EXPECT_EQ(number_text(1.4, 4), "1.4");
    EXPECT_EQ(number_text(-0.0001, 2), "0");
    EXPECT_EQ(number_text(0.125, 2), "0.12");
}

} // namespace
} // namespace reljef::app
