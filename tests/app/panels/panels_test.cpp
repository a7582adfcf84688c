#include "app/viewer/panels/panels.h"

#include <optional>
#include <string>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/panels/toolkit/panel_layout.h"

namespace reljef::app {
namespace {

constexpr glm::ivec2 made_window{1024, 768};
constexpr double frame_seconds = 1.0 / 60.0;

PanelContent made_content() {
    PanelContent content;
    content.terrain = "Höhe über Čačak Ελλάδα";
    content.technique.requested = scene::Technique{scene::Relief{}};
    for (const scene::TechniqueInfo& info : scene::technique_catalogue()) {
        content.technique.choices.push_back({scene::make_technique(info.id), {}, {}});
    }
    content.frame.recent_ms = {1.0F, 2.0F, 3.0F};
    content.metres_per_pixel = 10.0;
    content.legend = {{0.0, {0, 0, 0, 255}}, {1000.0, {255, 255, 255, 255}}};
    content.messages = {{"a note", false, 0.0}, {"an error", true, 1.0}};
    content.task = {"bounding", 0.5};
    content.keys = {{"H", "help"}};
    return content;
}

// Panels without a window or OpenGL.
struct PanelsTest : testing::Test {
    PanelActions draw() { return panels.draw(content, made_window, frame_seconds); }

    PanelActions click(glm::dvec2 at, Modifiers with = {}) {
        panels.receive(MouseMoveEvent{at});
        draw();
        used = panels.receive(MouseButtonEvent{MouseButton::left, true, at, with});
        PanelActions actions = draw();
        panels.receive(MouseButtonEvent{MouseButton::left, false, at, with});
        actions += draw();
        actions += draw();
        return actions;
    }

    // Clicks over an area until a click does that; no action otherwise.
    template <class Action> std::optional<Action> found_in(const Area& area, double step = 12.0) {
        for (double y = area.high.y - 6.0; y > area.low.y; y -= step) {
            for (double x = area.low.x + 24.0; x < area.high.x; x += 40.0) {
                for (const PanelAction& action : click({x, y})) {
                    if (const auto* found = std::get_if<Action>(&action)) {
                        return *found;
                    }
                }
            }
        }
        return std::nullopt;
    }

    // Clicks over an area until a click presses the key.
    bool presses(const Area& area, Key key, double step = 12.0) {
        for (double y = area.high.y - 6.0; y > area.low.y; y -= step) {
            for (double x = area.low.x + 24.0; x < area.high.x; x += 40.0) {
                for (const PanelAction& action : click({x, y})) {
                    const auto* const pressed = std::get_if<PressKey>(&action);
                    if (pressed != nullptr && pressed->key == key) {
                        return true;
                    }
                }
            }
        }
        return false;
    }

    // The third of four tabs in the first row.
    void show_places() {
        draw();
        draw();
        click(layout.inspector.low + glm::dvec2(182.0, 22.0));
        draw();
    }

    // Where found_in() clicks one below the other; `from_right`: of the inspector, pixels.
    Area column(double from_right) const {
        const double x = layout.inspector.high.x - from_right;
        return {{x - 24.0, layout.inspector.low.y + 76.0}, {x + 1.0, layout.inspector.high.y}};
    }

    PanelActions type(const std::string& text) {
        for (const char letter : text) {
            panels.receive(TextEvent{static_cast<char32_t>(letter)});
        }
        press(Key::enter); // down and up before the next frame
        PanelActions actions = draw();
        actions += draw();
        return actions += draw();
    }

    void press(Key key) {
        used = panels.receive(KeyEvent{.key = key, .pressed = true});
        panels.receive(KeyEvent{.key = key, .pressed = false});
    }

    Panels panels{Interface::create({.draws = false}).value()};
    PanelLayout layout = layout_for(made_window, 1.0);
    PanelContent content = made_content();
    bool used = false; // whether the last press was for the panels alone
};

TEST_F(PanelsTest, ClicksOnButtonsAreActions) {
    draw();
    draw();
    EXPECT_TRUE(found_in<CopyCommand>(layout.inspector));
    const auto picture = found_in<PressKey>(layout.inspector);
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->key, Key::c);
}

TEST_F(PanelsTest, TheCameraCanBeCopied) {
    draw();
    draw();
    EXPECT_TRUE(presses(layout.inspector, Key::v));
}

TEST_F(PanelsTest, BookmarksAreAddedFlownToAndDeleted) {
    const Bookmark ridge{"alps.tif", "Grat Süd", "--camera 46,8,2000,10,-5"};
    content.bookmarks = {{ridge, {"alps.tif", "", "--camera 46,8,2000,20,-5"}}, "a note"};
    show_places();
    const auto added = found_in<AddBookmark>(column(40.0), 6.0);
    ASSERT_TRUE(added);
    EXPECT_EQ(added->name, "");
    const auto gone = found_in<RemoveBookmark>(column(40.0), 6.0);
    ASSERT_TRUE(gone);
    EXPECT_EQ(gone->bookmark, content.bookmarks.bookmarks[1]);
    const auto there = found_in<GoToBookmark>(column(250.0), 6.0);
    ASSERT_TRUE(there);
    EXPECT_EQ(there->bookmark, content.bookmarks.bookmarks[1]);
}

TEST_F(PanelsTest, ABookmarkIsRenamedInItsRow) {
    const Bookmark ridge{"alps.tif", "ridge", "--camera 46,8,2000,10,-5"};
    content.bookmarks.bookmarks = {ridge};
    show_places();
    std::optional<RenameBookmark> renamed;
    for (double y = layout.inspector.low.y + 80.0; y < layout.inspector.low.y + 200.0 && !renamed;
         y += 5.0) {
        for (double x = layout.inspector.high.x - 150.0; x < layout.inspector.high.x - 80.0;
             x += 20.0) {
            click({x, y});
            draw();
            draw();
            for (const PanelAction& action : type("summit")) {
                const auto* const found = std::get_if<RenameBookmark>(&action);
                renamed = found != nullptr ? std::optional(*found) : renamed;
            }
        }
    }
    ASSERT_TRUE(renamed);
    EXPECT_EQ(renamed->bookmark, ridge);
    EXPECT_EQ(renamed->name, "summit");
}

TEST_F(PanelsTest, TheSpeedHasASlider) {
    content.speed = 1.0;
    show_places();
    const auto set = found_in<SetSpeed>(layout.inspector, 6.0);
    ASSERT_TRUE(set);
    EXPECT_GT(set->speed, 0.0);
}

TEST_F(PanelsTest, TheGalleryGetsItsTechniquesBackOnlyIfTheyChanged) {
    content.technique.models = {{"box", content.technique.requested}};
    draw();
    draw();
    EXPECT_FALSE(presses(column(200.0), Key::digit0, 6.0));
    content.technique.is_as_at_start = false;
    EXPECT_TRUE(presses(column(200.0), Key::digit0, 6.0));
}

TEST_F(PanelsTest, ASliderChangesAParameterToAnAllowedValue) {
    draw();
    draw();
    const auto choice = found_in<ChooseTechnique>(layout.inspector);
    ASSERT_TRUE(choice);
    EXPECT_NE(choice->technique, content.technique.requested);
    EXPECT_EQ(choice->technique.id(), scene::TechniqueId::relief);
    const auto read_back = scene::parse_technique(scene::to_string(choice->technique));
    ASSERT_TRUE(read_back) << read_back.error().message;
    EXPECT_EQ(*read_back, choice->technique);
}

TEST_F(PanelsTest, OnlyEventsOverPanelsAreTheirs) {
    draw();
    draw();
    click(0.5 * (layout.compass.low + layout.compass.high));
    EXPECT_TRUE(used);
    click({512.0, 300.0});
    EXPECT_FALSE(used);
    EXPECT_FALSE(panels.is_over_panel({512.0, 300.0}));
    press(Key::w);
    EXPECT_FALSE(used);
}

TEST_F(PanelsTest, HiddenPanelsTakeNoEventsAndDrawNothing) {
    draw();
    press(Key::tab);
    EXPECT_TRUE(used);
    EXPECT_FALSE(panels.is_visible());
    EXPECT_TRUE(panels.is_stale()); // one frame without them
    EXPECT_TRUE(draw().empty());
    EXPECT_FALSE(panels.is_stale());
    click(0.5 * (layout.compass.low + layout.compass.high));
    EXPECT_FALSE(used);
    EXPECT_FALSE(panels.is_stale());
    press(Key::tab);
    EXPECT_TRUE(panels.is_visible());
}

TEST_F(PanelsTest, TheyRestWhereNothingHappens) {
    for (int i = 0; i < 4; ++i) {
        draw();
    }
    EXPECT_FALSE(panels.is_stale());
    panels.receive(MouseMoveEvent{{10.0, 10.0}});
    EXPECT_TRUE(panels.is_stale());
}

TEST_F(PanelsTest, HelpCoversTheViewUntilEscape) {
    const glm::dvec2 middle = 0.5 * glm::dvec2(made_window);
    draw();
    draw();
    EXPECT_FALSE(panels.is_over_panel(middle));
    panels.toggle_help();
    draw();
    draw();
    EXPECT_TRUE(panels.is_over_panel(middle));
    press(Key::escape);
    EXPECT_TRUE(used);
    draw();
    draw();
    EXPECT_FALSE(panels.is_over_panel(middle));
    press(Key::escape);
    EXPECT_FALSE(used); // the viewer's
}

TEST_F(PanelsTest, HelpLiesOverTheOtherPanels) {
    const glm::ivec2 small(800, 600);
    const PanelLayout small_layout = layout_for(small, 1.0);
    panels.toggle_help();
    const auto draw_small = [&] { return panels.draw(content, small, frame_seconds); };
    draw_small();
    draw_small();
    const Area& help = small_layout.help;
    PanelActions actions;
    for (double y = help.low.y + 60.0; y < help.high.y; y += 8.0) { // below its button
        const glm::dvec2 at{small_layout.inspector.low.x + 60.0, y};
        panels.receive(MouseMoveEvent{at});
        draw_small();
        for (const bool pressed : {true, false}) {
            panels.receive(MouseButtonEvent{MouseButton::left, pressed, at, {}});
            actions += draw_small();
        }
    }
    EXPECT_TRUE(actions.empty());
    panels.toggle_help();
    draw_small();
    EXPECT_TRUE(panels.is_over_panel(small_layout.inspector.low + 20.0));
}

// A slider that is clicked with control becomes a text field.
TEST_F(PanelsTest, KeysTypedIntoAFieldAreNotTheViews) {
    draw();
    draw();
    const Modifiers control{.control = true};
    panels.receive(KeyEvent{.key = Key::control, .pressed = true, .modifiers = control});
    bool types = false;
    for (double y = layout.inspector.low.y + 60.0; y < layout.inspector.low.y + 300.0 && !types;
         y += 8.0) {
        click({layout.inspector.low.x + 60.0, y}, control);
        draw();
        draw();
        press(Key::w);
        types = used;
    }
    EXPECT_TRUE(types);
}

TEST_F(PanelsTest, TinyAndHugeWindowsWork) {
    for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(320, 240), glm::ivec2(7680, 4320)}) {
        panels.draw(content, size, frame_seconds);
        EXPECT_TRUE(panels.draw(content, size, frame_seconds).empty());
    }
    panels.draw(content, {1, 1}, frame_seconds);
    EXPECT_FALSE(panels.is_over_panel({0.0, 0.0}));
}

TEST_F(PanelsTest, EveryTechniqueOfTheCatalogueHasItsPanel) {
    for (const scene::TechniqueInfo& info : scene::technique_catalogue()) {
        content.technique.requested = scene::make_technique(info.id);
        for (const scene::OptionInfo& option : scene::options_of(info.id)) {
            option.choose(content.technique.requested.options,
                          option.words.empty() ? 0 : option.words.size() - 1);
        }
        EXPECT_TRUE(draw().empty());
    }
}

TEST_F(PanelsTest, ComparingBringsItsTabToTheFrontAndMovesTheLine) {
    content.compare.with = CompareWith::truth;
    content.compare.figures = {{"Wrong pixels", "0 %", "1 %"}};
    draw();
    draw();
    EXPECT_TRUE(found_in<SetComparison>(layout.inspector));
    const auto wipe = found_in<SetWipe>(layout.inspector);
    ASSERT_TRUE(wipe);
    EXPECT_GE(wipe->share, 0.0);
    EXPECT_LE(wipe->share, 1.0);
}

TEST_F(PanelsTest, MeasuringShowsItsPointsAndProfile) {
    content.measure.is_on = true;
    content.measure.points = {{"46.1, 7.2", "height 3 m", glm::dvec2(500.0, 300.0)},
                              {"46.2, 7.2", "height 4 m", std::nullopt}};
    content.measure.profile = ProfileContent{.heights = {3.0F, 5.0F, 4.0F}, .distance = 1000.0};
    draw();
    draw();
    EXPECT_TRUE(found_in<ClearPoints>(layout.inspector));
    content.measure.viewshed = true;
    const auto shown = found_in<ShowViewshed>(layout.inspector, 6.0);
    ASSERT_TRUE(shown);
    EXPECT_FALSE(shown->shown);
    const auto saved = found_in<PressKey>(layout.inspector);
    ASSERT_TRUE(saved);
}

TEST_F(PanelsTest, TheTimelineSeeksAndMovesKeyframes) {
    content.path.keys = {0.0, 5.0, 10.0};
    content.path.is_recording = true; // its tab comes to the front
    draw();
    draw();
    const auto seek = found_in<SeekPath>(layout.inspector, 6.0);
    ASSERT_TRUE(seek);
    EXPECT_GE(seek->seconds, 0.0);
    EXPECT_LE(seek->seconds, 10.0);
    EXPECT_TRUE(found_in<InsertPathKey>(layout.inspector, 6.0));
    EXPECT_TRUE(found_in<MovePathKey>(layout.inspector, 6.0));
    EXPECT_TRUE(found_in<RemovePathKey>(layout.inspector, 6.0));
    EXPECT_TRUE(found_in<SetPathDuration>(layout.inspector, 6.0));
}

TEST_F(PanelsTest, AVideoCanBeCancelled) {
    content.path.video = 0.5;
    draw();
    draw();
    EXPECT_TRUE(found_in<CancelVideo>(layout.inspector, 6.0));
}

} // namespace
} // namespace reljef::app
