#include "app/viewer/measuring.h"

#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/paths/path_desk.h"
#include "app/viewer/paths/path_video.h"
#include "app/viewer/viewer.h"
#include "engine/io/formats/flight_file.h"
#include "engine/scene/streaming/terrain_light.h"
#include "engine/session/flight_keys.h"
#include "engine/session/measuring/ground_measure.h"
#include "tests/app/made_hill.h"
#include "tests/support/temporary_folder.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::app {
namespace {

using testing::HasSubstr;

// 5 m to the east, 1 m down: a slope of 11.3 degrees that faces east. A wall at x = 0.
session::TerrainScene slope_with_wall(double wall) {
    Grid<float> heights(33, 33);
    for (int row = 0; row < 33; ++row) {
        for (int col = 0; col < 33; ++col) {
            heights(col, row) = static_cast<float>(-2.0 * col + (col == 16 ? wall : 0.0));
        }
    }
    return scene_of(std::move(heights));
}

const scene::TerrainNode& node_of(const session::TerrainScene& scene) {
    return *scene.terrain->get<scene::TerrainNode>();
}

session::PickedPlace on_ground(double x, double y, double z) {
    return {{x, y, z}};
}

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

TEST(Measuring, PointTellsHeightSlopeAndAspect) {
    const session::TerrainScene scene = slope_with_wall(0.0);
    Measuring measuring(scene);
    const auto text = measuring.pick(on_ground(50.0, 20.0, -42.0));
    ASSERT_TRUE(text);
    EXPECT_EQ(*text,
              "1  x 50.00 m, y 20.00 m: height -42.0 m, slope 11.3\u00b0, aspect 90\u00b0\n");
}

TEST(Measuring, TwoPointsTellTheirDistanceAndSight) {
    for (const double wall : {0.0, 30.0}) {
        const session::TerrainScene scene = slope_with_wall(wall);
        Measuring measuring(scene);
        ASSERT_TRUE(measuring.pick(on_ground(-100.0, 0.0, -12.0)));
        const auto text = measuring.pick(on_ground(100.0, 0.0, -52.0));
        ASSERT_TRUE(text);
        EXPECT_THAT(*text, HasSubstr("distance 200.0 m"));
        EXPECT_THAT(*text, HasSubstr("lower by 40.0 m"));
        EXPECT_THAT(*text, HasSubstr(wall > 0.0 ? "hidden from each other by x " : "in sight"));
        if (wall == 0.0) {
            EXPECT_THAT(*text, HasSubstr("over the ground 204.0 m")); // hypot(200, 40)
        }
        EXPECT_NEAR(measuring.profile().back().distance, 200.0, 1e-9);
    }
}

TEST(Measuring, TheSkyIsOneSentenceAndNothingIsLost) {
    const session::TerrainScene scene = slope_with_wall(0.0);
    Measuring measuring(scene);
    ASSERT_TRUE(measuring.pick(on_ground(-100.0, 0.0, -12.0)));
    const auto sky = measuring.pick(std::nullopt);
    ASSERT_FALSE(sky);
    EXPECT_THAT(sky.error().message, HasSubstr("the sky found"));
    EXPECT_EQ(measuring.points().size(), 1U);
    EXPECT_THAT(*measuring.pick(on_ground(9000.0, 0.0, 0.0)), HasSubstr("beside the terrain"));
    EXPECT_TRUE(std::isnan(measuring.profile().back().height));
}

void add_block(session::TerrainScene& scene, glm::dvec3 middle) {
    scene.scene.root()
        .add("block",
             scene::MeshNode{
                 std::make_shared<const scene::Mesh>(scene::box_mesh({20.0F, 20.0F, 60.0F})), {}})
        .set_position(middle);
}

TEST(Measuring, PointsOnObjectsTellNameAndHeight) {
    session::TerrainScene scene = slope_with_wall(0.0);
    add_block(scene, {50.0, 0.0, -42.0});
    const auto place = session::pick_place(scene, {{52.0, 3.0, 500.0}, {0.0, 0.0, -1.0}});
    ASSERT_TRUE(place);
    EXPECT_EQ(place->object, "block");
    Measuring measuring(scene);
    EXPECT_THAT(*measuring.pick(place), testing::StrEq("1  x 52.00 m, y 3.00 m: height -12.0 m on "
                                                       "'block', 30.4 m above the ground\n"));
    const auto text = measuring.pick(on_ground(-100.0, 0.0, -12.0));
    EXPECT_THAT(*text, HasSubstr("higher by 0.0 m"));
    EXPECT_THAT(*text, HasSubstr("in sight"));
}

TEST(Measuring, ObjectsHideTheView) {
    for (const bool has_block : {false, true}) {
        session::TerrainScene scene = slope_with_wall(0.0);
        if (has_block) {
            add_block(scene, {0.0, 0.0, -30.0});
        }
        Measuring measuring(scene);
        ASSERT_TRUE(measuring.pick(on_ground(-100.0, 0.0, -12.0)));
        EXPECT_THAT(*measuring.pick(on_ground(100.0, 0.0, -52.0)),
                    HasSubstr(has_block ? "hidden from each other by x -10.00 m, y 0.00 m: height"
                                        : "in sight"));
    }
}

// A point on a wall is on either side of it by what rounds, and the way up is along the wall, or
// into one that leans over it.
TEST(Measuring, AWallHidesItsPointsFromBehindOnly) {
    for (const double lean : {-0.1, 0.0, 0.1}) {
        session::TerrainScene scene = slope_with_wall(0.0);
        add_block(scene, {50.0, 0.0, -42.0});
        scene.scene.root().children().back()->set_parent_from_local(
            glm::rotate(glm::rotate(glm::translate(glm::dmat4(1.0), {50.0, 0.0, -42.0}), 0.3,
                                    glm::dvec3(0.0, 0.0, 1.0)),
                        lean, glm::dvec3(0.0, 1.0, 0.0)));
        const std::array ground{on_ground(-100.0, 7.0, -12.0), on_ground(150.0, -3.0, -62.0)};
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 on_wall(50.0, -5.0 + 0.05 * i, -34.0 + 0.08 * i);
            for (const auto& before : ground) {
                const glm::dvec3 eye = before.world + glm::dvec3(0.0, 0.0, 40.0);
                const auto picked = session::pick_place(scene, {eye, on_wall - eye});
                ASSERT_TRUE(picked && picked->object == "block") << i;
                for (const auto& other : ground) {
                    const bool is_before = &other == &before;
                    const auto there = session::hidden_by(scene, other, *picked, 2.0);
                    const auto back = session::hidden_by(scene, *picked, other, 2.0);
                    ASSERT_EQ(there.has_value(), !is_before) << i << ' ' << lean;
                    ASSERT_EQ(back.has_value(), !is_before) << i << ' ' << lean;
                }
            }
        }
    }
}

TEST(Measuring, ProfileIsSavedAndAViewshedNeedsAPlaceOnEarth) {
    const test::TemporaryFolder folder;
    const session::TerrainScene scene = slope_with_wall(0.0);
    Measuring measuring(scene);
    EXPECT_FALSE(measuring.save_profile(folder.path() / "none.csv"));
    EXPECT_FALSE(measuring.begin_viewshed(folder.path() / "none.tif"));
    ASSERT_TRUE(measuring.pick(on_ground(-100.0, 0.0, -12.0)));
    ASSERT_TRUE(measuring.pick(on_ground(100.0, 0.0, -52.0)));
    ASSERT_TRUE(measuring.save_profile(folder.path() / "profile.csv"));
    const std::string text = text_of(folder.path() / "profile.csv");
    EXPECT_THAT(text, testing::StartsWith("distance,height\n0.000,-12.000\n"));
    EXPECT_THAT(text, testing::EndsWith("\n200.000,-52.000\n"));
    const auto viewshed = measuring.begin_viewshed(folder.path() / "seen.tif");
    ASSERT_FALSE(viewshed);
    EXPECT_THAT(viewshed.error().message, HasSubstr("no place on Earth"));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "none.csv"));
}

// A ridge from north to south hides the east from a point in the west.
session::TerrainScene ridge_on_earth() {
    session::TerrainSource source;
    source.terrain.name = "ridge";
    source.terrain.heightfield = test::geographic_heightfield(
        test::made_heights(33, 33, [](int col, int) { return col == 16 ? 300.0 : 0.0; }), 46.0, 8.0,
        0.001);
    session::SceneOptions view;
    view.max_error = 0.0;
    return test::make_scene(std::move(source), {}, view).value();
}

TEST(Measuring, AViewshedColoursTheGroundUntilItIsSwitchedOff) {
    const test::TemporaryFolder folder;
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    session::TerrainScene scene = ridge_on_earth();
    Viewer viewer(scene, scene::orbit_path(scene.bounds, 10.0), {400, 300});
    const auto overlay = [&] { return node_of(scene).surface->overlay(); };
    const auto wait = [&](const auto& is_done) {
        for (int i = 0; i < 2000 && !is_done(); ++i) {
            viewer.advance(0.01);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    };
    const Image plain = scene::albedo_map(*node_of(scene).surface);
    const auto world = node_of(scene).surface->placement().world_from_sample({8.0, 16.0, 0.0});
    ASSERT_TRUE(viewer.measuring().pick(session::PickedPlace{world}));
    ASSERT_TRUE(viewer.begin_viewshed());
    wait([&] { return overlay() != nullptr; });
    ASSERT_NE(overlay(), nullptr);
    EXPECT_TRUE(viewer.shows_viewshed());
    EXPECT_THAT(viewer.take_output(), HasSubstr("saved reljef-viewshed-0001.tif"));
    EXPECT_EQ(viewer.measuring().points().size(), 1U) << "the ground is the same";
    const Image colored = scene::albedo_map(*node_of(scene).surface);
    const auto green = [](Rgba8 color) { return int{color.g} - int{color.b}; };
    EXPECT_GT(green(colored(4, 16)), green(plain(4, 16)) + 20) << "it sees the west";
    EXPECT_LT(green(colored(28, 16)), green(plain(28, 16)) - 5) << "the ridge hides the east";
    viewer.receive(KeyEvent{.key = Key::f2, .pressed = true});
    EXPECT_FALSE(viewer.shows_viewshed());
    wait([&] { return overlay() == nullptr; });
    EXPECT_EQ(scene::albedo_map(*node_of(scene).surface), plain);
    viewer.receive(KeyEvent{.key = Key::f2, .pressed = true});
    wait([&] { return overlay() != nullptr; });
    EXPECT_EQ(scene::albedo_map(*node_of(scene).surface), colored);
    std::filesystem::current_path(before);
}

scene::Camera view_from(double x) {
    return scene::camera_from_angles({x, 0.0, 50.0}, 90.0, -10.0);
}

PathDesk given_path() {
    return PathDesk(scene::CameraPath::create({{0.0, {1, 1, 1}, {2, 2, 2}}}).value());
}

TEST(PathDesk, FirstKeyReplacesTheGivenPathAndOthersFollow) {
    PathDesk desk = given_path();
    for (const double x : {10.0, 20.0, 30.0}) {
        ASSERT_TRUE(desk.append_key(view_from(x)));
    }
    ASSERT_EQ(desk.path().keys().size(), 3U);
    EXPECT_EQ(desk.path().at(0.0).eye.x, 10.0);
    EXPECT_EQ(desk.path().at(PathDesk::seconds_between_keys).eye.x, 20.0);
    ASSERT_TRUE(desk.remove_key_at(3.1));
    EXPECT_EQ(desk.path().keys()[1].eye.x, 30.0);
    ASSERT_TRUE(desk.remove_key_at(0.0));
    EXPECT_FALSE(desk.remove_key_at(0.0));
    EXPECT_EQ(desk.path().keys().size(), 1U);
}

TEST(PathDesk, RecordedFlightIsThePathAndIsReadAgain) {
    const test::TemporaryFolder folder;
    const session::TerrainScene scene = hill_scene();
    PathDesk desk = given_path();
    EXPECT_FALSE(desk.end_recording());
    desk.begin_recording();
    EXPECT_FALSE(desk.end_recording()) << "nothing was flown";
    EXPECT_EQ(desk.path().at(0.0).eye.x, 1.0) << "nothing is lost";
    desk.begin_recording();
    for (int i = 0; i <= 240; ++i) {
        desk.record(view_from(i), 1.0 / 60.0);
    }
    ASSERT_TRUE(desk.end_recording());
    EXPECT_NEAR(desk.path().duration(), 4.0, 1e-9);
    const auto files = desk.save(*node_of(scene).surface, folder.path() / "flight");
    ASSERT_TRUE(files);
    EXPECT_THAT(*files, testing::ElementsAre(folder.path() / "flight.toml"));
    const auto read = io::read_flight(files->front());
    ASSERT_TRUE(read);
    const auto& keys = std::get<std::vector<io::PathKey>>(read->keys);
    ASSERT_EQ(keys.size(), desk.path().keys().size());
    EXPECT_LT(glm::distance(keys.back().eye, desk.path().keys().back().eye), 1e-5);
}

VideoFile counting_video(int& frames, bool& is_finished) {
    return {[&frames](const Image&, int index) -> Result<void> {
                frames = index + 1;
                return {};
            },
            [&is_finished]() -> Result<void> {
                is_finished = true;
                return {};
            }};
}

TEST(PathVideo, HasAFrameEach25thOfASecond) {
    int frames = 0;
    bool is_finished = false;
    const auto open = [&](const std::filesystem::path&, glm::ivec2, double) {
        return Result<VideoFile>(counting_video(frames, is_finished));
    };
    const auto path =
        scene::CameraPath::create({{3.0, {0, 0, 9}, {1, 0, 9}}, {5.0, {9, 0, 9}, {10, 0, 9}}});
    auto video = PathVideo::begin(*path, "flight.mp4", {64, 48}, open);
    ASSERT_TRUE(video);
    EXPECT_EQ(video->frames(), 51);
    for (int i = 0; i < 51; ++i) {
        ASSERT_FALSE(video->is_complete());
        ASSERT_NEAR(video->time(), i / 25.0, 1e-12);
        ASSERT_TRUE(video->write(Image(64, 48)));
    }
    EXPECT_TRUE(video->is_complete());
    ASSERT_TRUE(video->finish());
    EXPECT_EQ(frames, 51);
    EXPECT_TRUE(is_finished);
}

TEST(PathVideo, HasTheLastViewThoughDurationsAreRounded) {
    const auto open = [](const std::filesystem::path&, glm::ivec2, double) {
        return Result<VideoFile>(VideoFile{});
    };
    const auto path = // 1.16 s, a little less in binary
        scene::CameraPath::create({{7.0, {0, 0, 9}, {1, 0, 9}}, {8.16, {9, 0, 9}, {10, 0, 9}}});
    EXPECT_EQ(PathVideo::begin(*path, "flight.mp4", {64, 48}, open)->frames(), 30);
}

TEST(PathVideo, OneKeyframeAndAFileThatCannotBeMadeAreErrors) {
    const auto open = [](const std::filesystem::path&, glm::ivec2, double) {
        return Result<VideoFile>(Error{"no ffmpeg"});
    };
    const auto one = scene::CameraPath::create({{3.0, {0, 0, 9}, {1, 0, 9}}});
    const auto still = PathVideo::begin(*one, "flight.mp4", {64, 48}, open);
    ASSERT_FALSE(still);
    EXPECT_THAT(still.error().message, HasSubstr("a path with one keyframe found"));
    const auto two =
        scene::CameraPath::create({{3.0, {0, 0, 9}, {1, 0, 9}}, {5.0, {9, 0, 9}, {10, 0, 9}}});
    EXPECT_EQ(PathVideo::begin(*two, "flight.mp4", {64, 48}, open).error().message, "no ffmpeg");
    const auto endless =
        scene::CameraPath::create({{0.0, {0, 0, 9}, {1, 0, 9}}, {1e9, {9, 0, 9}, {10, 0, 9}}});
    EXPECT_FALSE(PathVideo::begin(*endless, "flight.mp4", {64, 48}, open));
}

} // namespace
} // namespace reljef::app
