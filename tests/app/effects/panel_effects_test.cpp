// Each action of the panels has its effect on the viewer. An action without a row here fails the
// test.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/viewer.h"
#include "app/viewer/viewer_content.h"
#include "engine/view/terrain_maps.h"
#include "tests/app/made_hill.h"
#include "tests/session/made_session.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

constexpr glm::ivec2 acted_window{400, 300};
constexpr double acted_step = 1.0 / 60.0;

void settle_viewer(Viewer& viewer) {
    viewer.advance(acted_step);
    while (viewer.is_preparing()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1)); // leaves the work a processor
        viewer.advance(acted_step);
    }
}

// A hill under a red image.
session::TerrainScene pictured_hill() {
    session::TerrainSource source;
    source.terrain.name = "hill";
    auto& heightfield = source.terrain.heightfield;
    heightfield.heights = Grid<float>(33, 33, 10.0F);
    heightfield.heights(16, 16) = 60.0F;
    heightfield.spacing = {10.0, 10.0};
    heightfield.range = terrain::height_range(heightfield.heights, {});
    source.terrain.color = Image(33, 33, Rgba8{255, 0, 0, 255});
    session::SceneOptions view;
    view.max_error = 0.0;
    return test::make_scene(std::move(source), {}, view).value();
}

struct ActedViewer {
    [[nodiscard]] scene::TerrainNode& node() { return *scene.terrain->get<scene::TerrainNode>(); }
    [[nodiscard]] AppearanceContent appearance() const {
        return content_of(viewer, scene, acted_window).appearance;
    }
    [[nodiscard]] std::vector<double> key_times() const {
        return content_of(viewer, scene, acted_window).path.keys;
    }
    void append_keys(int count) {
        for (int i = 0; i < count; ++i) {
            viewer.receive(KeyEvent{.key = Key::insert, .pressed = true});
        }
    }
    // The colour of the hill's top, without light. Level ground would be water.
    [[nodiscard]] Rgba8 ground_color() {
        const Image albedo = view::ground_map(*node().surface, std::nullopt, 4096).albedo;
        return albedo(albedo.cols() / 2, albedo.rows() / 2);
    }

    [[nodiscard]] std::vector<Bookmark> bookmarks() const {
        return content_of(viewer, scene, acted_window).bookmarks.bookmarks;
    }
    [[nodiscard]] glm::dvec3 eye() const { return scene.camera->get<scene::Camera>()->eye; }

    test::TemporaryFolder folder;
    session::TerrainScene scene = pictured_hill();
    Viewer viewer{scene,
                  scene::orbit_path(scene.bounds, 10.0),
                  acted_window,
                  {.maps = {}, .terrain = "hill.tif", .bookmarks = folder.path() / "marks.txt"}};
};

void expect_done(ActedViewer& acted, const PanelAction& action) {
    const auto done = std::visit(
        [&](const auto& chosen) -> Result<void> {
            if constexpr (requires { acted.viewer.act(chosen); }) {
                return acted.viewer.act(chosen);
            }
            return Error{"the window does this"};
        },
        action);
    EXPECT_TRUE(done) << done.error().message;
}

struct ActionCase {
    PanelAction action;
    void (*check)(ActedViewer&, const PanelAction&);
};

void check_technique(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, action);
    settle_viewer(acted.viewer);
    EXPECT_EQ(acted.node().material.technique, std::get<ChooseTechnique>(action).technique);
    EXPECT_TRUE(acted.viewer.take_redraw());
}

void check_parameter(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, ChooseTechnique{scene::Technique{scene::Relief{}}, {}});
    expect_done(acted, action);
    EXPECT_EQ(content_of(acted.viewer, acted.scene, acted_window).technique.parameter, 1U);
}

// See GalleryEffects.AModelIsEditedAloneUntilAllAreSelected.
void check_model(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, action);
    EXPECT_FALSE(content_of(acted.viewer, acted.scene, acted_window).technique.model);
}

void check_sun(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, action);
    settle_viewer(acted.viewer);
    const auto& light = *acted.scene.light->get<scene::Light>();
    EXPECT_EQ(light.azimuth, std::get<SetSun>(action).azimuth);
    EXPECT_EQ(light.altitude, std::get<SetSun>(action).altitude);
    EXPECT_NE(acted.viewer.take_light(), nullptr) << "the shadows and shades follow";
}

void check_turbidity(ActedViewer& acted, const PanelAction& action) {
    const scene::Sky before = *acted.scene.scene.sky();
    expect_done(acted, action);
    settle_viewer(acted.viewer);
    EXPECT_EQ(acted.appearance().turbidity, std::get<SetTurbidity>(action).turbidity);
    EXPECT_NE(acted.scene.scene.sky()->horizon, before.horizon);
}

void check_visibility(ActedViewer& acted, const PanelAction& action) {
    for (const double metres : {std::get<SetVisibility>(action).metres, 0.0}) {
        acted.viewer.take_redraw();
        expect_done(acted, SetVisibility{metres});
        EXPECT_EQ(acted.scene.scene.sky()->visibility, metres);
        EXPECT_EQ(acted.appearance().visibility, metres);
        EXPECT_TRUE(acted.viewer.take_redraw());
    }
}

void check_grain(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, action);
    EXPECT_EQ(acted.node().grain, 0.5F);
    EXPECT_TRUE(acted.viewer.take_redraw());
}

void check_contours(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, action);
    EXPECT_EQ(acted.node().contours, std::get<SetContours>(action).metres);
    EXPECT_TRUE(acted.viewer.take_redraw());
}

void check_labels(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, action);
    EXPECT_FALSE(acted.node().labels_contours);
    EXPECT_TRUE(acted.viewer.take_redraw());
}

void check_eye_dome(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, action);
    EXPECT_EQ(acted.scene.scene.eye_dome(), std::get<SetEyeDome>(action).strength);
    EXPECT_TRUE(acted.viewer.take_redraw());
}

void check_ramp(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, SetImageryShare{0.0});
    settle_viewer(acted.viewer);
    const Rgba8 before = acted.ground_color();
    expect_done(acted, action);
    settle_viewer(acted.viewer);
    EXPECT_EQ(acted.node().surface->ramp().name, std::get<SetRamp>(action).name);
    EXPECT_NE(acted.ground_color(), before);
}

void check_imagery(ActedViewer& acted, const PanelAction& action) {
    EXPECT_EQ(acted.ground_color(), (Rgba8{255, 0, 0, 255}));
    expect_done(acted, action);
    settle_viewer(acted.viewer);
    EXPECT_EQ(acted.appearance().imagery_share, std::get<SetImageryShare>(action).share);
    const Rgba8 blended = acted.ground_color();
    EXPECT_LT(blended.r, 255);
    EXPECT_GT(blended.g, 0);
}

void check_exaggeration(ActedViewer& acted, const PanelAction& action) {
    const double before = *acted.node().surface->height_at(0.0, 0.0);
    const glm::dvec3 eye = acted.scene.camera->get<scene::Camera>()->eye;
    expect_done(acted, action);
    settle_viewer(acted.viewer);
    EXPECT_NEAR(*acted.node().surface->height_at(0.0, 0.0), 2.0 * before, 1e-6);
    EXPECT_EQ(acted.scene.camera->get<scene::Camera>()->eye, eye) << "the eye does not move";
}

void check_compared(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, action);
    EXPECT_EQ(acted.viewer.comparison().with(), std::get<SetComparison>(action).with);
    EXPECT_EQ(acted.viewer.comparison().option(), "errors");
}

void check_other(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, action);
    EXPECT_EQ(acted.viewer.comparison().with(), CompareWith::technique);
    EXPECT_EQ(acted.viewer.comparison().technique().id(), scene::TechniqueId::texture);
}

void check_wipe(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, SetComparison{CompareWith::truth});
    acted.viewer.comparison().take_redraw();
    expect_done(acted, action);
    EXPECT_EQ(acted.viewer.comparison().share(), std::get<SetWipe>(action).share);
}

void check_swap(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, SetOtherTechnique{scene::Technique{scene::Texture{}}});
    const scene::Technique left = acted.viewer.technique();
    expect_done(acted, action);
    EXPECT_EQ(acted.viewer.technique().id(), scene::TechniqueId::texture);
    EXPECT_EQ(acted.viewer.comparison().technique(), left);
}

void check_seek(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, action);
    const double seconds = std::get<SeekPath>(action).seconds;
    EXPECT_EQ(acted.viewer.path_time(), seconds);
    const scene::CameraPath& path = acted.viewer.path_desk().path();
    EXPECT_LT(glm::distance(acted.scene.camera->get<scene::Camera>()->eye,
                            path.at(path.begin() + seconds).eye),
              1e-6);
}

void check_insert(ActedViewer& acted, const PanelAction& action) {
    acted.append_keys(2);
    expect_done(acted, action);
    EXPECT_THAT(acted.key_times(), testing::ElementsAre(0.0, 1.0, 3.0));
}

void check_move(ActedViewer& acted, const PanelAction& action) {
    acted.append_keys(2);
    expect_done(acted, SeekPath{0.0});
    acted.viewer.receive(KeyEvent{.key = Key::e, .pressed = true});
    acted.viewer.advance(acted_step);
    acted.viewer.receive(KeyEvent{.key = Key::e, .pressed = false});
    const glm::dvec3 eye = acted.scene.camera->get<scene::Camera>()->eye;
    EXPECT_NE(acted.viewer.path_desk().path().keys()[1].eye, eye);
    expect_done(acted, action);
    EXPECT_EQ(acted.viewer.path_desk().path().keys()[1].eye, eye);
}

void check_retime(ActedViewer& acted, const PanelAction& action) {
    acted.append_keys(3);
    expect_done(acted, action);
    EXPECT_THAT(acted.key_times(), testing::ElementsAre(0.0, 2.0, 6.0));
}

void check_removed(ActedViewer& acted, const PanelAction& action) {
    acted.append_keys(3);
    expect_done(acted, action);
    EXPECT_THAT(acted.key_times(), testing::ElementsAre(0.0, 6.0));
}

void check_duration(ActedViewer& acted, const PanelAction& action) {
    acted.append_keys(3);
    expect_done(acted, action);
    EXPECT_THAT(acted.key_times(), testing::ElementsAre(0.0, 6.0, 12.0));
}

void check_cleared(ActedViewer& acted, const PanelAction& action) {
    ASSERT_TRUE(acted.viewer.measuring().pick(session::PickedPlace{{0.0, 0.0, 60.0}}));
    expect_done(acted, action);
    EXPECT_TRUE(acted.viewer.measuring().points().empty());
}

void check_added_bookmark(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, action);
    ASSERT_EQ(acted.bookmarks().size(), 1U);
    EXPECT_EQ(acted.bookmarks().front().name, std::get<AddBookmark>(action).name);
}

void check_flight_to_bookmark(ActedViewer& acted, const PanelAction& /*action*/) {
    const glm::dvec3 marked = acted.eye();
    expect_done(acted, AddBookmark{"here"});
    acted.viewer.receive(KeyEvent{.key = Key::e, .pressed = true});
    acted.viewer.advance(acted_step);
    acted.viewer.receive(KeyEvent{.key = Key::e, .pressed = false});
    EXPECT_NE(acted.eye(), marked);
    expect_done(acted, GoToBookmark{acted.bookmarks().front()});
    for (int i = 0; i < 20; ++i) {
        acted.viewer.advance(0.1);
    }
    EXPECT_LT(glm::distance(acted.eye(), marked), 1e-3);
}

void check_renamed_bookmark(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, AddBookmark{"here"});
    const std::string& name = std::get<RenameBookmark>(action).name;
    expect_done(acted, RenameBookmark{acted.bookmarks().front(), name});
    ASSERT_EQ(acted.bookmarks().size(), 1U);
    EXPECT_EQ(acted.bookmarks().front().name, name);
}

// A name that was free again is not given twice.
void check_removed_bookmark(ActedViewer& acted, const PanelAction& /*action*/) {
    expect_done(acted, AddBookmark{});
    expect_done(acted, AddBookmark{});
    expect_done(acted, RemoveBookmark{acted.bookmarks().front()});
    ASSERT_EQ(acted.bookmarks().size(), 1U);
    EXPECT_EQ(acted.bookmarks().front().name, "view 2");
    expect_done(acted, AddBookmark{});
    EXPECT_EQ(acted.bookmarks().back().name, "view 1");
}

void check_speed(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, action);
    EXPECT_EQ(content_of(acted.viewer, acted.scene, acted_window).speed,
              std::get<SetSpeed>(action).speed);
}

// See KeyEffects.AViewshedIsSavedFromTheLastPoint.
void check_viewshed_off(ActedViewer& acted, const PanelAction& action) {
    expect_done(acted, action);
    EXPECT_FALSE(acted.viewer.shows_viewshed());
    EXPECT_FALSE(acted.viewer.act(ShowViewshed{true})) << "there is none";
}

std::vector<ActionCase> action_cases() {
    return {{ChooseTechnique{scene::Technique{scene::Texture{}}, {}}, check_technique},
            {SelectModel{}, check_model},
            {SelectParameter{1}, check_parameter},
            {SetSun{123.0, 17.0}, check_sun},
            {SetTurbidity{6.0}, check_turbidity},
            {SetVisibility{5000.0}, check_visibility},
            {SetGrain{0.5}, check_grain},
            {SetContours{20.0}, check_contours},
            {SetContourLabels{false}, check_labels},
            {SetEyeDome{0.3}, check_eye_dome},
            {SetRamp{"swiss"}, check_ramp},
            {SetImageryShare{0.25}, check_imagery},
            {SetExaggeration{2.0}, check_exaggeration},
            {SetComparison{CompareWith::errors}, check_compared},
            {SetOtherTechnique{scene::Technique{scene::Texture{}}}, check_other},
            {SetWipe{0.125}, check_wipe},
            {SwapTechniques{}, check_swap},
            {SeekPath{2.5}, check_seek},
            {InsertPathKey{1.0}, check_insert},
            {MovePathKey{1}, check_move},
            {RetimePathKey{1, 2.0}, check_retime},
            {RemovePathKey{1}, check_removed},
            {SetPathDuration{12.0}, check_duration},
            {ClearPoints{}, check_cleared},
            {AddBookmark{"summit"}, check_added_bookmark},
            {GoToBookmark{}, check_flight_to_bookmark},
            {RenameBookmark{{}, "saddle"}, check_renamed_bookmark},
            {RemoveBookmark{}, check_removed_bookmark},
            {SetSpeed{7.0}, check_speed},
            {ShowViewshed{false}, check_viewshed_off}};
}

TEST(PanelEffects, EachActionHasItsEffect) {
    // Those of the window: tests/app/window presses them.
    std::set<std::size_t> tested{PanelAction(SetSamples{}).index(), PanelAction(PressKey{}).index(),
                                 PanelAction(CopyCommand{}).index(),
                                 PanelAction(CancelVideo{}).index()};
    for (const ActionCase& each : action_cases()) {
        SCOPED_TRACE(each.action.index());
        ActedViewer acted;
        acted.viewer.take_redraw();
        each.check(acted, each.action);
        tested.insert(each.action.index());
    }
    for (std::size_t i = 0; i < std::variant_size_v<PanelAction>; ++i) {
        EXPECT_TRUE(tested.contains(i)) << "action " << i << " of PanelAction has no test";
    }
}

TEST(PanelEffects, WrongActionsAreRefusedAndChangeNothing) {
    ActedViewer acted;
    acted.append_keys(2);
    const auto times = acted.key_times();
    for (const PanelAction& action : std::vector<PanelAction>{
             SetRamp{"mauve"}, RetimePathKey{1, 0.0}, RetimePathKey{9, 1.0}, MovePathKey{9},
             RemovePathKey{9}, InsertPathKey{std::nan("")}, SetPathDuration{0.0},
             SetPathDuration{std::nan("")},
             ChooseTechnique{scene::make_technique(scene::TechniqueId::bump), {}},
             SetOtherTechnique{scene::make_technique(scene::TechniqueId::bump)}}) {
        const auto done = std::visit(
            [&](const auto& chosen) -> Result<void> {
                if constexpr (requires { acted.viewer.act(chosen); }) {
                    return acted.viewer.act(chosen);
                }
                return {};
            },
            action);
        EXPECT_FALSE(done) << action.index();
    }
    EXPECT_EQ(acted.key_times(), times);
    EXPECT_FALSE(acted.viewer.comparison().is_on());
}

} // namespace
} // namespace reljef::app
