#include "app/viewer/render_command_text.h"

#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/command_line.h"
#include "tests/app/made_hill.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::app {
namespace {

using testing::HasSubstr;
using testing::Not;

StartOptions start_of(const std::string& terrain) {
    StartOptions start;
    start.source.terrain = terrain;
    return start;
}

ShownState shown_of(const session::TerrainScene& scene) {
    return {.technique = scene.materials().front()->technique,
            .light = *scene.light->get<scene::Light>(),
            .size = {400, 300}};
}

std::string value_after(const std::string& command, const std::string& option) {
    const auto at = command.find(option);
    const auto begin = at + option.size();
    return at == std::string::npos ? "" : command.substr(begin, command.find(' ', begin) - begin);
}

std::vector<double> numbers_in(const std::string& list) {
    std::vector<double> numbers;
    std::istringstream stream(list);
    for (std::string number; std::getline(stream, number, ',');) {
        numbers.push_back(std::stod(number));
    }
    return numbers;
}

TEST(ShellWord, IsOneWordForTheShell) {
    for (const std::string text :
         {"plain", "a b", "it's", "$HOME `x` \"q\" \\", "*", "", "Höhe;rm -rf", "line\nbreak"}) {
        const auto echoed =
            test::run_program("/bin/sh", {"-c", "printf %s " + shell_word(text)}, {});
        EXPECT_EQ(echoed.out, text);
    }
    EXPECT_EQ(shell_word("polygons:error=1"), "polygons:error=1");
}

TEST(CopiedText, SaysWhatTheCommandDoesNotDraw) {
    ShownState shown;
    EXPECT_EQ(copied_text("reljef render a.tif", shown), "copied: reljef render a.tif\n");
    shown.shows_viewshed = true;
    EXPECT_EQ(copied_text("reljef render a.tif", shown),
              "copied without the colours of the viewshed, which render cannot draw: reljef render "
              "a.tif\n");
}

TEST(RenderCommand, NamesTheViewAndWhatChangedSinceTheStart) {
    session::TerrainScene scene = hill_scene();
    StartOptions start = start_of("my hill.tif");
    start.source.imagery = {"photo 1.tif"};
    start.source.index = session::IndexUse::none;
    scene.terrain->get<scene::TerrainNode>()->grain = 0.5F;
    scene.terrain->get<scene::TerrainNode>()->contours = 25.0;
    scene.terrain->get<scene::TerrainNode>()->labels_contours = false;
    scene.scene.set_eye_dome(0.4);
    ShownState shown = shown_of(scene);
    shown.technique = scene::Technique{scene::Relief{}};
    shown.exaggeration = 2.5;
    shown.samples = 8;
    shown.light.azimuth = 12.5;
    shown.compare = "errors";
    shown.wipe = 0.25;
    const auto command = render_command(start, scene, shown);
    ASSERT_TRUE(command) << command.error().message;
    for (const std::string part :
         {"reljef render 'my hill.tif'", "--imagery 'photo 1.tif'", "--no-index",
          "--technique relief:n=11,k=8", "--exaggeration 2.5", "--samples 8", "--sun 12.5,40",
          "--placement plane", "--grain 0.5", "--contours 25 --contour-labels off",
          "--eye-dome 0.4", "--compare errors --wipe 0.250", "--size 400x300", "-o view.png"}) {
        EXPECT_THAT(*command, HasSubstr(part));
    }
}

TEST(RenderCommand, NamesEachBase) {
    session::TerrainScene scene = hill_scene();
    StartOptions start = start_of("natural");
    for (const auto base :
         {session::BaseKind::plane, session::BaseKind::solid, session::BaseKind::none}) {
        start.scene.base = base;
        const auto command = render_command(start, scene, shown_of(scene));
        ASSERT_TRUE(command) << command.error().message;
        EXPECT_THAT(*command, HasSubstr(fmt::format("--base {} ", session::to_string(base))));
    }
}

TEST(RenderCommand, NamesThePointLights) {
    session::TerrainScene scene = hill_scene();
    StartOptions start = start_of("natural");
    start.scene.point_lights = {
        {.at = glm::dvec2(1.5, -2.0),
         .height = 6.0,
         .intensity = 60.0,
         .range = 80.0,
         .color = {255, 204, 136, 255}},
        {.at = glm::dvec2(3.0, 4.0), .height = 5.0, .intensity = 25.0, .range = {}, .color = {}}};
    const auto command = render_command(start, scene, shown_of(scene));
    ASSERT_TRUE(command) << command.error().message;
    EXPECT_THAT(*command, HasSubstr("--point-light '1.5,-2:height=6,intensity=60,range=80,"
                                    "color=#ffcc88' --point-light "
                                    "'3,4:height=5,intensity=25,color=#000000'"));
}

TEST(RenderCommand, NamesTheLightsBesidesTheSun) {
    session::TerrainScene scene = hill_scene();
    StartOptions start = start_of("natural");
    start.scene.lights = {{.azimuth = 85.0, .altitude = 30.0, .intensity = 0.2}};
    const auto command = render_command(start, scene, shown_of(scene));
    ASSERT_TRUE(command) << command.error().message;
    EXPECT_THAT(*command, HasSubstr("--light '85,30:intensity=0.2,color=#ffffff'"));
}

TEST(RenderCommand, NamesTheSurfaceShader) {
    session::TerrainScene scene = hill_scene();
    StartOptions start = start_of("natural");
    start.scene.surface_shader = {.file = "my snow.glsl", .constants = {{"line", {2.5}}}};
    const auto command = render_command(start, scene, shown_of(scene));
    ASSERT_TRUE(command) << command.error().message;
    EXPECT_THAT(*command, HasSubstr("--surface-shader 'my snow.glsl:line=2.5'"));
}

TEST(RenderCommand, NamesThePictureOfTheSky) {
    session::TerrainScene scene = hill_scene();
    StartOptions start = start_of("natural");
    start.scene.sky = "red sky.png";
    start.scene.sky_turn = -20.0;
    const auto command = render_command(start, scene, shown_of(scene));
    ASSERT_TRUE(command) << command.error().message;
    EXPECT_THAT(*command, HasSubstr("--sky 'red sky.png' --sky-turn -20"));
}

// The options give the same camera to the last bit on a plane.
TEST(RenderCommand, ItsCameraIsTheViewsOnAPlane) {
    session::SceneOptions view;
    view.eye = glm::dvec3(12.3456789, -170.1, 55.5);
    view.target = glm::dvec3(0.1, 0.2, 0.3);
    session::TerrainScene scene = hill_scene(view);
    const auto command = render_command(start_of("hill"), scene, shown_of(scene));
    ASSERT_TRUE(command);
    EXPECT_EQ(numbers_in(value_after(*command, "--eye=")),
              (std::vector{view.eye->x, view.eye->y, view.eye->z}));
    EXPECT_EQ(numbers_in(value_after(*command, "--look=")),
              (std::vector{view.target->x, view.target->y, view.target->z}));
}

TEST(RenderCommand, ItsCameraIsTheViewsOnTheEllipsoid) {
    const auto scene_with = [](const session::GeodeticView& geodetic) {
        session::TerrainSource source;
        source.terrain.heightfield =
            test::geographic_heightfield(Grid<float>(33, 33, 1000.0F), 46.0, 7.0, 1e-1);
        session::SceneOptions view;
        view.geodetic = geodetic;
        return test::make_scene(std::move(source), {}, view).value();
    };
    const session::TerrainScene scene = scene_with({45.99, 8.01, 4500.0, 250.0, -30.0});
    const auto command = render_command(start_of("alps"), scene, shown_of(scene));
    ASSERT_TRUE(command);
    EXPECT_THAT(*command, HasSubstr("--placement ellipsoid"));
    const auto numbers = numbers_in(value_after(*command, "--camera="));
    ASSERT_EQ(numbers.size(), 5U);
    const session::TerrainScene again =
        scene_with({numbers[0], numbers[1], numbers[2], numbers[3], numbers[4]});
    const auto& before = *scene.camera->get<scene::Camera>();
    const auto& after = *again.camera->get<scene::Camera>();
    // Positions on the Earth err by 1e-8 m (LocalFrame). Directions: a millionth of the angle of a
    // pixel, 3e-3, is enough for the same picture.
    constexpr double max_turn = 3e-9;
    EXPECT_LT(glm::distance(before.eye, after.eye), 1e-7);
    EXPECT_LT(glm::distance(scene::view_axes(before).forward, scene::view_axes(after).forward),
              max_turn);
    EXPECT_LT(glm::distance(scene::view_axes(before).up, scene::view_axes(after).up), max_turn);
}

TEST(RenderCommand, OfTheMapIsOrthographicWithItsHeight) {
    session::SceneOptions view;
    view.pose = scene::Pose::map;
    session::TerrainScene scene = hill_scene(view);
    const auto command = render_command(start_of("hill"), scene, shown_of(scene));
    ASSERT_TRUE(command);
    EXPECT_THAT(*command, HasSubstr("--projection orthographic"));
    session::SceneOptions again;
    const auto eye = numbers_in(value_after(*command, "--eye="));
    const auto look = numbers_in(value_after(*command, "--look="));
    again.eye = glm::dvec3(eye.at(0), eye.at(1), eye.at(2));
    again.target = glm::dvec3(look.at(0), look.at(1), look.at(2));
    again.projection = scene::ProjectionKind::orthographic;
    const session::TerrainScene map = hill_scene(again);
    const auto& before = *scene.camera->get<scene::Camera>();
    const auto& after = *map.camera->get<scene::Camera>();
    EXPECT_NEAR(after.view_height, before.view_height, 1e-9 * before.view_height);
    EXPECT_EQ(scene::view_axes(after).up, scene::view_axes(before).up);
}

} // namespace
} // namespace reljef::app
