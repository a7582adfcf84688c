// Each control of the panels gives its action when it is clicked.
#include <cmath>
#include <optional>
#include <set>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/panels/panels.h"
#include "app/viewer/panels/toolkit/panel_layout.h"
#include "engine/geo/sun_position.h"
#include "engine/terrain/field/color_ramp.h"

namespace reljef::app {
namespace {

constexpr glm::ivec2 tall_window{1024, 1800}; // shows each tab without scrolling
constexpr double shown_seconds = 1.0 / 60.0;

PanelContent full_content() {
    PanelContent content;
    content.technique.requested = scene::Technique{scene::Relief{}};
    for (const scene::TechniqueInfo& info : scene::technique_catalogue()) {
        content.technique.choices.push_back({scene::make_technique(info.id), {}, {}});
    }
    AppearanceContent& appearance = content.appearance;
    appearance.light.azimuth = 200.0;
    appearance.light.altitude = 40.0;
    appearance.turbidity = 5.0;
    appearance.visibility = 1e5;
    appearance.ramp = "atlas";
    for (const std::string_view name : terrain::ramp_names()) {
        appearance.ramps.emplace_back(name);
    }
    appearance.imagery_share = 0.7;
    appearance.grain = 1.0;
    appearance.eye_dome = 0.5;
    appearance.contours = 50.0;
    appearance.exaggeration = 2.0;
    appearance.max_exaggeration = 100.0;
    appearance.samples = 2;
    content.frame.recent_ms = {1.0F};
    content.frame.window = tall_window;
    return content;
}

struct PanelControls : testing::Test {
    PanelActions draw() { return panels.draw(content, tall_window, shown_seconds); }

    PanelActions move_to(glm::dvec2 at) {
        panels.receive(MouseMoveEvent{at});
        return draw();
    }
    PanelActions button(glm::dvec2 at, bool pressed) {
        panels.receive(MouseButtonEvent{MouseButton::left, pressed, at});
        return draw();
    }
    PanelActions click(glm::dvec2 at) {
        PanelActions actions = move_to(at);
        actions += button(at, true);
        actions += button(at, false);
        actions += draw();
        return actions;
    }
    void open_tab(double column, double row) { // of four columns and two rows
        draw();
        draw();
        const double width = layout.inspector.size().x;
        click(layout.inspector.low + glm::dvec2((column + 0.5) / 4.0 * width, 20.0 + 27.0 * row));
        draw();
    }
    // A list that opens takes all clicks.
    [[nodiscard]] bool has_open_list() const {
        return panels.is_over_panel(0.5 * (layout.view.low + layout.view.high));
    }
    // Clicks downwards along a line, `left` from the panel's left side, and in lists that open.
    PanelActions click_down(double left) {
        PanelActions actions;
        for (double y = layout.inspector.low.y + 70.0; y < layout.inspector.high.y; y += 5.0) {
            const double x = layout.inspector.low.x + left;
            actions += click({x, y});
            for (double below = 20.0; below < 100.0 && has_open_list(); below += 20.0) {
                actions += click({x, y + below});
            }
        }
        return actions;
    }
    static std::set<std::size_t> kinds_of(const PanelActions& actions) {
        std::set<std::size_t> kinds;
        for (const PanelAction& action : actions) {
            kinds.insert(action.index());
        }
        return kinds;
    }
    template <class Action> static std::vector<Action> all_of_kind(const PanelActions& actions) {
        std::vector<Action> found;
        for (const PanelAction& action : actions) {
            if (const auto* const one = std::get_if<Action>(&action)) {
                found.push_back(*one);
            }
        }
        return found;
    }
    static std::set<Key> keys_of(const PanelActions& actions) {
        std::set<Key> keys;
        for (const PressKey& press : all_of_kind<PressKey>(actions)) {
            keys.insert(press.key);
        }
        return keys;
    }
    template <class... Actions> static void expect_kinds(const PanelActions& actions) {
        const std::set<std::size_t> kinds = kinds_of(actions);
        for (const PanelAction& expected : {PanelAction(Actions{})...}) {
            EXPECT_TRUE(kinds.contains(expected.index())) << expected.index();
        }
    }

    Panels panels{Interface::create({.draws = false}).value()};
    PanelLayout layout = layout_for(tall_window, 1.0);
    PanelContent content = full_content();
};

TEST_F(PanelControls, TheViewTabSetsSunAirColoursAndSamples) {
    open_tab(1, 0);
    const PanelActions actions = click_down(30.0);
    expect_kinds<SetSun, SetTurbidity, SetVisibility, SetRamp, SetImageryShare, SetContours,
                 SetContourLabels, SetGrain, SetEyeDome, SetExaggeration, SetSamples>(actions);
    EXPECT_THAT(keys_of(actions), testing::IsSupersetOf({Key::f, Key::o, Key::p, Key::g, Key::r}));
    for (const SetSun& sun : all_of_kind<SetSun>(actions)) {
        EXPECT_TRUE(sun.azimuth >= 0.0 && sun.azimuth <= 360.0);
        EXPECT_TRUE(sun.altitude >= -90.0 && sun.altitude <= 90.0);
    }
    for (const SetRamp& ramp : all_of_kind<SetRamp>(actions)) {
        EXPECT_TRUE(terrain::named_ramp(ramp.name)) << ramp.name;
    }
    for (const SetImageryShare& set : all_of_kind<SetImageryShare>(actions)) {
        EXPECT_TRUE(set.share >= 0.0 && set.share <= 1.0);
    }
}

TEST_F(PanelControls, WithoutImageryOrSkyTheirControlsAreGone) {
    content.appearance.imagery_share.reset();
    content.appearance.visibility.reset();
    content.appearance.ramp.clear();
    open_tab(1, 0);
    const std::set<std::size_t> kinds = kinds_of(click_down(30.0));
    for (const PanelAction& absent :
         {PanelAction(SetImageryShare{}), PanelAction(SetVisibility{}), PanelAction(SetRamp{})}) {
        EXPECT_FALSE(kinds.contains(absent.index())) << absent.index();
    }
}

TEST_F(PanelControls, WhatCannotChangeIsGreyedOut) {
    content.appearance.fixed_exaggeration = "models have no vertical exaggeration";
    content.appearance.exaggeration = 1.0;
    open_tab(1, 0);
    const std::set<std::size_t> kinds = kinds_of(click_down(30.0));
    for (const PanelAction& fixed :
         {PanelAction(SetImageryShare{}), PanelAction(SetExaggeration{}), PanelAction(SetRamp{})}) {
        EXPECT_FALSE(kinds.contains(fixed.index())) << fixed.index();
    }
}

// By date, both angles change; a slider of an angle changes one.
TEST_F(PanelControls, TheSunFollowsADateOnEarth) {
    content.appearance.on_earth = geo::Geodetic{46.0, 7.0, 0.0};
    open_tab(1, 0);
    std::size_t by_date = 0;
    for (const SetSun& sun : all_of_kind<SetSun>(click_down(150.0))) {
        const scene::Light& light = content.appearance.light;
        by_date += sun.azimuth != light.azimuth && sun.altitude != light.altitude ? 1U : 0U;
    }
    EXPECT_GT(by_date, 0U);
}

TEST_F(PanelControls, TheTechniqueTabEditsAModelAndItsParameters) {
    content.technique.models = {{"torus", scene::Technique{scene::Relief{}}},
                                {"bowl", scene::Technique{scene::Texture{}}}};
    open_tab(0, 0);
    const PanelActions actions = click_down(120.0);
    expect_kinds<SelectModel, SelectParameter, ChooseTechnique>(actions);
    for (const SelectModel& select : all_of_kind<SelectModel>(actions)) {
        EXPECT_LT(select.model.value_or(0), 2U);
    }
    for (const ChooseTechnique& choice : all_of_kind<ChooseTechnique>(actions)) {
        EXPECT_TRUE(scene::parse_technique(scene::to_string(choice.technique)));
    }
}

TEST_F(PanelControls, TheCompareTabChoosesAndSwapsTechniques) {
    content.compare.with = CompareWith::technique;
    content.compare.technique = scene::Technique{scene::Texture{}};
    draw();
    draw();
    const PanelActions actions = click_down(60.0);
    expect_kinds<SetComparison, SetOtherTechnique, SwapTechniques, SetWipe>(actions);
}

TEST_F(PanelControls, TheMeasureTabPressesItsKeys) {
    content.measure.points = {{"46.1, 7.2", "height 3 m", glm::dvec2(500.0, 300.0)},
                              {"46.2, 7.2", "height 4 m", std::nullopt}};
    content.measure.profile = ProfileContent{.heights = {3.0F, 5.0F, 4.0F}, .distance = 1000.0};
    open_tab(0, 1);
    const PanelActions actions = click_down(30.0);
    EXPECT_THAT(keys_of(actions), testing::IsSupersetOf({Key::x, Key::i, Key::u}));
    expect_kinds<ClearPoints>(actions);
}

TEST_F(PanelControls, ThePathTabPressesItsKeys) {
    content.path.keys = {0.0, 5.0, 10.0};
    open_tab(1, 1);
    PanelActions actions = click_down(60.0);
    actions += click_down(220.0);
    EXPECT_THAT(keys_of(actions),
                testing::IsSupersetOf({Key::p, Key::k, Key::insert, Key::j, Key::y}));
    expect_kinds<SeekPath, InsertPathKey, MovePathKey, RemovePathKey, SetPathDuration>(actions);
}

TEST_F(PanelControls, ADraggedKeyframeGetsAnotherTime) {
    content.path.keys = {0.0, 5.0, 10.0};
    open_tab(1, 1);
    std::optional<RetimePathKey> retimed;
    const double middle = 0.5 * (layout.inspector.low.x + layout.inspector.high.x);
    for (double y = layout.inspector.low.y + 70.0; y < layout.inspector.high.y && !retimed;
         y += 8.0) { // the second keyframe is in the middle of the line
        move_to({middle, y});
        button({middle, y}, true);
        move_to({middle + 40.0, y});
        PanelActions actions = button({middle + 40.0, y}, false);
        actions += draw();
        for (const RetimePathKey& found : all_of_kind<RetimePathKey>(actions)) {
            retimed = found;
        }
    }
    ASSERT_TRUE(retimed);
    EXPECT_EQ(retimed->key, 1U);
    EXPECT_GT(retimed->seconds, 5.0);
    EXPECT_LT(retimed->seconds, 10.0);
}

// A click is known before the frame that shows it; a move of the pointer alone is not waited for.
TEST_F(PanelControls, OnlyClicksKeysAndDragsAreInput) {
    draw();
    draw();
    EXPECT_FALSE(panels.has_input());
    const glm::dvec2 at = layout.inspector.low + glm::dvec2(40.0, 20.0);
    panels.receive(MouseMoveEvent{at});
    EXPECT_FALSE(panels.has_input());
    panels.receive(MouseButtonEvent{MouseButton::left, true, at});
    EXPECT_TRUE(panels.has_input());
    draw();
    EXPECT_FALSE(panels.has_input());
    panels.receive(MouseMoveEvent{at + glm::dvec2(5.0, 0.0)});
    EXPECT_TRUE(panels.has_input()) << "a drag";
    panels.receive(MouseButtonEvent{MouseButton::left, false, at});
    draw();
    panels.receive(ScrollEvent{{0.0, 1.0}});
    EXPECT_TRUE(panels.has_input());
    panels.set_visible(false);
    EXPECT_FALSE(panels.has_input());
}

} // namespace
} // namespace reljef::app
