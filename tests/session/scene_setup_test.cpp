// Cameras and paths in geographic coordinates, where the terrain's own axes lean away from north
// and up.
#include "engine/session/scene_setup.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "engine/geo/place.h"
#include "engine/session/flight_keys.h"
#include "engine/session/frame_maker.h"
#include "engine/session/scene_daylight.h"
#include "tests/session/made_session.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

const std::string wgs84_prj =
    R"(GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],)"
    R"(PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]])";

const std::string utm_32_prj =
    R"(PROJCS["UTM_32N",)" + wgs84_prj +
    R"(,PROJECTION["Transverse_Mercator"],PARAMETER["False_Easting",500000.0],)"
    R"(PARAMETER["False_Northing",0.0],PARAMETER["Central_Meridian",9.0],)"
    R"(PARAMETER["Scale_Factor",0.9996],PARAMETER["Latitude_Of_Origin",0.0],UNIT["Meter",1.0]])";

class GeodeticCamera : public testing::Test {
protected:
    /// Ground 20° around (50, 10), level but for a peak in the middle.
    [[nodiscard]] session::TerrainScene scene_of(const session::SceneOptions& view,
                                                 terrain::PlacementKind placement, int ground = 100,
                                                 int peak = 100) const {
        std::string text = "ncols 41\nnrows 41\nxllcenter -10\nyllcenter 30\ncellsize 1\n";
        for (int i = 0; i < 41 * 41; ++i) {
            text += fmt::format("{} ", i == 20 * 41 + 20 ? peak : ground);
        }
        folder_.write("ground.prj", wgs84_prj);
        session::SourceOptions choice;
        choice.terrain = folder_.write("ground.asc", text).string();
        choice.placement = placement;
        auto source = test::open_terrain(choice);
        EXPECT_TRUE(source) << (source ? "" : source.error().message);
        return std::move(*test::make_scene(std::move(*source), choice, view));
    }
    /// 3x3 samples around a place, on a plane.
    [[nodiscard]] session::SourceOptions level_ground_in_utm(glm::dvec2 middle,
                                                             double spacing) const {
        const glm::dvec2 first = middle - spacing;
        folder_.write("utm.prj", utm_32_prj);
        session::SourceOptions choice;
        choice.terrain = folder_
                             .write("utm.asc", fmt::format("ncols 3\nnrows 3\nxllcenter {}\n"
                                                           "yllcenter {}\ncellsize {}\n"
                                                           "5 5 5 5 5 5 5 5 5 ",
                                                           first.x, first.y, spacing))
                             .string();
        choice.placement = terrain::PlacementKind::plane;
        return choice;
    }
    static session::SceneOptions view_of(const session::GeodeticView& geodetic) {
        session::SceneOptions view;
        view.geodetic = geodetic;
        return view;
    }
    /// What is so far ahead at a place, by the local frame at that very place.
    static geo::Geodetic ahead_of(const session::GeodeticView& view, double metres) {
        const double heading = glm::radians(view.heading);
        const double pitch = glm::radians(view.pitch);
        const geo::LocalFrame there({view.latitude, view.longitude, view.height});
        return there.geodetic_from_local(metres * glm::dvec3(std::sin(heading) * std::cos(pitch),
                                                             std::cos(heading) * std::cos(pitch),
                                                             std::sin(pitch)));
    }
    static const terrain::Placement& placement_of(const session::TerrainScene& scene) {
        return scene.terrain->get<scene::TerrainNode>()->surface->placement();
    }

    test::TemporaryFolder folder_;
};

constexpr double right_angle = 1e-9; // radians

TEST_F(GeodeticCamera, LooksAlongTheHeadingAndThePitchOfItsOwnPlace) {
    for (const double latitude : {32.0, 50.0, 69.0}) {
        for (const double longitude : {-9.0, 10.0, 29.0}) {
            for (const double heading : {0.0, 90.0, 217.0}) {
                for (const double pitch : {-60.0, 0.0, 20.0}) {
                    const session::GeodeticView view{latitude, longitude, 5000.0, heading, pitch};
                    const auto scene = scene_of(view_of(view), terrain::PlacementKind::ellipsoid);
                    const auto& camera = *scene.camera->get<scene::Camera>();
                    const glm::dvec3 target =
                        *placement_of(scene).world_from_geodetic(ahead_of(view, 10000.0));
                    const glm::dvec3 requested = glm::normalize(target - camera.eye);
                    const scene::ViewAxes axes = scene::view_axes(camera);
                    EXPECT_LT(glm::distance(axes.forward, requested), right_angle)
                        << latitude << "," << longitude << " " << heading << " " << pitch;
                    EXPECT_LT(std::abs(glm::dot(axes.right, placement_of(scene).up(camera.eye))),
                              right_angle);
                }
            }
        }
    }
}

TEST_F(GeodeticCamera, OnAPlaneLooksAlongTheMapsNorth) {
    const session::GeodeticView view{60.0, 25.0, 5000.0, 0.0, 0.0};
    const auto scene = scene_of(view_of(view), terrain::PlacementKind::plane);
    const auto& camera = *scene.camera->get<scene::Camera>();
    EXPECT_LT(glm::distance(scene::view_axes(camera).forward, {0.0, 1.0, 0.0}), 1e-6);
}

// Of UTM zone 32 away from its middle meridian; degrees by PROJ's proj_factors.
TEST_F(GeodeticCamera, OnAPlaneTrueNorthIsTheMeridianConvergenceOffTheGrids) {
    struct Place {
        double longitude, easting, northing, convergence;
    };
    for (const Place& at : {Place{11.9, 661720.751, 6654956.720, 2.512012476527},
                            Place{6.2, 343853.566, 6654716.392, -2.425356101970}}) {
        const auto choice = level_ground_in_utm({at.easting, at.northing}, 1000.0);
        auto source = test::open_terrain(choice);
        ASSERT_TRUE(source) << source.error().message;
        const auto scene = test::make_scene(std::move(*source), choice,
                                            view_of({60.0, at.longitude, 500.0, 0.0, 0.0}));
        ASSERT_TRUE(scene) << scene.error().message;
        const glm::dvec3 forward = scene::view_axes(*scene->camera->get<scene::Camera>()).forward;
        // East of the middle meridian the grid's north is east of the true one.
        EXPECT_NEAR(glm::degrees(std::atan2(-forward.x, forward.y)), at.convergence, 1e-4);
    }
}

// "is not georeferenced" was said of the terrain.
TEST_F(GeodeticCamera, TooFarFromAPlaneIsSaidSo) {
    const auto choice = level_ground_in_utm({661720.751, 6654956.720}, 0.2);
    auto source = test::open_terrain(choice);
    ASSERT_TRUE(source) << source.error().message;
    const auto scene =
        test::make_scene(std::move(*source), choice, view_of({-60.0, -170.0, 500.0, 0.0, 0.0}));
    ASSERT_FALSE(scene);
    EXPECT_NE(scene.error().message.find("too far away for utm.asc on a plane"), std::string::npos)
        << scene.error().message;
}

TEST_F(GeodeticCamera, TheSunOfATimeStandsOffTrueNorth) {
    auto choice = level_ground_in_utm({661720.751, 6654956.720}, 1000.0);
    const geo::UniversalTime time{2026, 6, 21, 9.0};
    const auto sun = geo::sun_position(time, 60.0, 11.9);
    for (const auto& [placement, convergence] :
         {std::pair(terrain::PlacementKind::plane, 2.512012476527),
          std::pair(terrain::PlacementKind::ellipsoid, 0.0)}) {
        choice.placement = placement;
        session::SceneOptions view;
        view.sun = time;
        auto source = test::open_terrain(choice);
        ASSERT_TRUE(source) << source.error().message;
        const auto scene = test::make_scene(std::move(*source), choice, view);
        ASSERT_TRUE(scene) << scene.error().message;
        const auto& light = *scene->light->get<scene::Light>();
        EXPECT_NEAR(light.azimuth, sun->azimuth - convergence, 1e-3);
        EXPECT_NEAR(light.altitude, sun->altitude, 1e-3);
        ASSERT_TRUE(scene->surroundings.sun_time);
        EXPECT_EQ(scene->surroundings.sun_time->hours, time.hours);
    }
    session::SceneOptions night;
    night.sun = geo::UniversalTime{2026, 12, 21, 23.0};
    const auto refused = test::make_scene(*test::open_terrain(choice), choice, night);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("below the horizon"), std::string::npos)
        << refused.error().message;
    EXPECT_EQ(refused.error().message.rfind("--sun: ", 0), 0U) << refused.error().message;
}

// Maps have the sun and the colours of maps, unless the user or the scene file names others.
TEST_F(GeodeticCamera, MapsHaveASunAndColorsOfTheirOwn) {
    const auto choice = level_ground_in_utm({661720.751, 6654956.720}, 1000.0);
    const auto look_of = [&](const session::SceneOptions& view, const std::string& keys = "") {
        session::SourceOptions terrain = choice;
        terrain.terrain =
            folder_.write("scene.toml", "[terrain]\nheights = \"utm.asc\"\n" + keys).string();
        auto source = test::open_terrain(terrain);
        const auto scene = test::make_scene(std::move(*source), terrain, view).value();
        const auto& sun = *scene.light->get<scene::Light>();
        const auto& surface = *scene.terrain->get<scene::TerrainNode>()->surface;
        return fmt::format("{} {} {}", sun.azimuth, sun.altitude, surface.ramp().name);
    };
    session::SceneOptions view;
    EXPECT_EQ(look_of(view), "300 40 relief");
    view.projection = scene::ProjectionKind::orthographic;
    EXPECT_EQ(look_of(view), "315 35 atlas");
    EXPECT_EQ(look_of(view, "ramp = \"swiss\"\n[sun]\naltitude = 20\n"), "315 20 swiss");
    view.pose = scene::Pose::oblique;
    EXPECT_EQ(look_of(view), "300 40 relief");
    view.pose.reset();
    view.eye = glm::dvec3(5.0, 9.0, 4000.0);
    view.target = glm::dvec3(5.0, 9.0, 0.0);
    view.sun = glm::dvec2(10.0, 50.0);
    EXPECT_EQ(look_of(view), "10 50 atlas");
    view.target = glm::dvec3(5.0, 99.0, 0.0);
    EXPECT_EQ(look_of(view), "10 50 relief");
    view = {};
    view.pose = scene::Pose::map;
    EXPECT_EQ(look_of(view), "315 35 atlas");
}

// It names angles, but no target: a view straight down shows as much of the ground as one in
// perspective does.
TEST_F(GeodeticCamera, InParallelIsAsHighAsInPerspectiveAtTheGround) {
    session::SceneOptions view = view_of({47.0, 11.0, 5100.0, 0.0, -90.0}); // over 100 m
    view.projection = scene::ProjectionKind::orthographic;
    view.vertical_fov = 60.0;
    for (const auto kind : {terrain::PlacementKind::plane, terrain::PlacementKind::ellipsoid}) {
        const auto scene = scene_of(view, kind);
        const auto& camera = *scene.camera->get<scene::Camera>();
        EXPECT_EQ(camera.projection, scene::ProjectionKind::orthographic);
        EXPECT_NEAR(camera.view_height, 2.0 * 5000.0 * std::tan(glm::radians(30.0)), 1.0);
    }
}

// Else an island is small amid its sea.
TEST_F(GeodeticCamera, SeesAnIslandWithoutAllOfItsSea) {
    const auto distance = [&](int ground) {
        const auto scene = scene_of({}, terrain::PlacementKind::plane, ground, 1000);
        const auto& camera = *scene.camera->get<scene::Camera>();
        return glm::distance(camera.eye, scene.bounds.center());
    };
    EXPECT_LT(distance(0), 0.2 * distance(100));
}

TEST_F(GeodeticCamera, GrainFollowsTheRampUnlessNamed) {
    session::SourceOptions choice = level_ground_in_utm({661720.751, 6654956.720}, 1000.0);
    const auto grain_of = [&](const char* ramp, std::optional<double> named) {
        choice.ramp = ramp;
        session::SceneOptions view;
        view.default_grain = 1.0;
        view.grain = named;
        const auto scene = test::make_scene(*test::open_terrain(choice), choice, view).value();
        return scene.terrain->get<scene::TerrainNode>()->grain;
    };
    EXPECT_EQ(grain_of("relief", {}), 1.0F);
    EXPECT_EQ(grain_of("clay", {}), 0.0F);
    EXPECT_EQ(grain_of("clay", 1.5), 1.5F);
    EXPECT_EQ(grain_of("relief", 0.0), 0.0F);
}

// 9x9 samples in the sea, 10 km apart; `shore` is in the middle of the southern border.
session::TerrainScene island(const test::TemporaryFolder& folder, terrain::PlacementKind placement,
                             int shore, const session::SceneOptions& view) {
    std::string text = "ncols 9\nnrows 9\nxllcenter 460000\nyllcenter 6600000\ncellsize 10000\n";
    for (int i = 0; i < 81; ++i) {
        text += i == 76 ? fmt::format("{} ", shore) : i == 40 ? "500 " : i == 22 ? "-20 " : "0 ";
    }
    folder.write("island.prj", utm_32_prj);
    session::SourceOptions choice;
    choice.terrain = folder.write("island.asc", text).string();
    choice.placement = placement;
    return test::make_scene(*test::open_terrain(choice), choice, view).value();
}

// Else one sees the sea through the land.
TEST_F(GeodeticCamera, AnIslandThatItsBorderCutsEndsInAWallOnTheSea) {
    for (const auto kind : {terrain::PlacementKind::plane, terrain::PlacementKind::ellipsoid}) {
        const auto base_of = [&](int shore, session::BaseKind base) {
            session::SceneOptions view;
            view.base = base;
            return island(folder_, kind, shore, view).terrain->get<scene::TerrainNode>()->base;
        };
        EXPECT_EQ(base_of(0, session::BaseKind::plane), nullptr);
        EXPECT_EQ(base_of(300, session::BaseKind::none), nullptr);
        const auto wall = base_of(300, session::BaseKind::plane);
        ASSERT_NE(wall, nullptr);
        EXPECT_EQ(wall->mesh->indices.size(), 12U) << "beside the highest sample";
        EXPECT_GT(base_of(300, session::BaseKind::solid)->mesh->indices.size(), 12U);
    }
}

TEST_F(GeodeticCamera, TheSeaAroundAnIslandFadesWithinAHundredKilometres) {
    for (const auto kind : {terrain::PlacementKind::plane, terrain::PlacementKind::ellipsoid}) {
        const auto sky_of = [&](std::optional<double> visibility, session::BaseKind base) {
            session::SceneOptions view;
            view.visibility = visibility;
            view.base = base;
            return *island(folder_, kind, 0, view).scene.sky();
        };
        const scene::Sky sky = sky_of({}, session::BaseKind::plane);
        const bool is_curved = kind == terrain::PlacementKind::ellipsoid;
        EXPECT_EQ(sky.radius, is_curved ? geo::mean_radius_of_earth : 0.0);
        EXPECT_NEAR(sky.base, 0.0, 1e-6) << "the sea, not the lowest land";
        EXPECT_GE(sky.visibility, 20e3);
        EXPECT_LE(sky.visibility, 100e3);
        EXPECT_LE(sky.air_height, 500.0);
        EXPECT_EQ(sky_of(9e5, session::BaseKind::plane).visibility, 9e5);
        const scene::Sky of_block = sky_of({}, session::BaseKind::solid);
        EXPECT_GT(of_block.visibility, 500e3);
        EXPECT_EQ(of_block.radius, 0.0);
    }
}

TEST_F(GeodeticCamera, AlongAPathHasTheHeadingsOfItsKeysAndStandsUpright) {
    const std::string file =
        folder_
            .write("path.toml", "[[key]]\ntime = 0\nlatitude = 65\nlongitude = 28\n"
                                "height = 5000\nheading = 40\npitch = -10\n"
                                "[[key]]\ntime = 1\nlatitude = 65.01\nlongitude = 28\n"
                                "height = 5000\nheading = 40\npitch = -10\n")
            .string();
    auto scene = scene_of({}, terrain::PlacementKind::ellipsoid);
    const auto path = test::open_path(scene, file);
    ASSERT_TRUE(path) << path.error().message;
    session::fly_to(scene, *path, 0, 2);
    const auto& camera = *scene.camera->get<scene::Camera>();
    const session::GeodeticView first{65.0, 28.0, 5000.0, 40.0, -10.0};
    const glm::dvec3 target = *placement_of(scene).world_from_geodetic(ahead_of(first, 1000.0));
    const scene::ViewAxes axes = scene::view_axes(camera);
    EXPECT_LT(glm::distance(axes.forward, glm::normalize(target - camera.eye)), right_angle);
    EXPECT_LT(std::abs(glm::dot(axes.right, placement_of(scene).up(camera.eye))), right_angle);
}

// Spikes, and exaggeration, of a million: a view of all of it shows a line.
TEST(SpireCamera, IsNearTheGroundAndANoteSaysWhy) {
    const test::TemporaryFolder folder;
    std::string rows;
    for (int i = 0; i < 40 * 40; ++i) {
        rows += i % 97 == 5 ? "1000000 " : std::to_string(i % 40) + " ";
    }
    const std::string head = "ncols 40\nnrows 40\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
    std::string hill;
    for (int i = 0; i < 40 * 40; ++i) {
        hill += std::to_string(i % 40) + " ";
    }
    for (const auto& [text, exaggeration] : {std::pair(rows, 1.0), {hill, 1e6}}) {
        session::SourceOptions choice;
        choice.terrain = folder.write("spire.asc", head + text + "\n").string();
        choice.exaggeration = exaggeration;
        auto source = test::open_terrain(choice);
        ASSERT_TRUE(source) << source.error().message;
        const auto notes = session::shape_notes(source->terrain, exaggeration);
        ASSERT_EQ(notes.size(), 1U);
        EXPECT_NE(notes[0].find("m found on 566 m of ground"), std::string::npos) << notes[0];
        EXPECT_TRUE(session::shape_notes(source->terrain, 1e-6).empty());
        const auto scene = test::make_scene(std::move(*source), choice, session::SceneOptions());
        ASSERT_TRUE(scene) << scene.error().message;
        const auto& camera = *scene->camera->get<scene::Camera>();
        EXPECT_LT(glm::distance(camera.eye, camera.target), 5'000.0);
        EXPECT_LT(glm::distance(camera.target, glm::dvec3(0.0, 0.0, scene->ground(1.0, 1.0))),
                  exaggeration * 2.0 + 1'000.0);
    }
}

TEST(SpireCamera, FewSamplesAreNoted) {
    const test::TemporaryFolder folder;
    session::SourceOptions choice;
    choice.terrain = folder
                         .write("one.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\n"
                                           "cellsize 10\nNODATA_value -9\n"
                                           "-9 -9 -9\n-9 7 -9\n-9 -9 -9\n")
                         .string();
    const auto source = test::open_terrain(choice);
    ASSERT_TRUE(source) << source.error().message;
    const auto notes = session::shape_notes(source->terrain, 1.0);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes[0].find("1 valid sample found"), std::string::npos) << notes[0];
}

class Flight : public GeodeticCamera {
protected:
    /// Where the frames of a path file see from.
    std::vector<geo::Geodetic> eyes_of(const std::string& name, const std::string& text, int frames,
                                       int ground, int peak) {
        const std::string file = folder_.write(name, text).string();
        auto scene = scene_of({}, terrain::PlacementKind::ellipsoid, ground, peak);
        const auto path = test::open_path(scene, file);
        EXPECT_TRUE(path) << (path ? "" : path.error().message);
        session::Log silent;
        session::TruthFrames maker({1, 1}, 1, silent);
        std::vector<geo::Geodetic> eyes;
        for (int i = 0; i < frames; ++i) {
            raised_.push_back(session::fly_above_ground(scene, *path, i, frames, maker, {}).metres);
            const glm::dvec3 eye = scene.camera->get<scene::Camera>()->eye;
            eyes.push_back(*placement_of(scene).geodetic_from_world(eye));
        }
        return eyes;
    }
    std::vector<double> raised_;
};

// A chord of 1,400 km is 39 km lower than its arc.
TEST_F(Flight, GoesAlongTheGeodesicBetweenKeysAtTheirHeights) {
    const geo::Geodetic west{48.0, 0.0, 1500.0};
    const geo::Geodetic east{52.0, 20.0, 1500.0};
    const geo::Geodesic whole = geo::geodesic_between(west, east);
    for (const geo::Geodetic& eye : eyes_of(
             "line.geojson", R"({"type":"LineString","coordinates":[[0,48,1500],[20,52,1500]]})",
             98, 100, 100)) {
        EXPECT_NEAR(eye.height, 1500.0, 1.0) << eye.longitude;
        const geo::Geodesic done = geo::geodesic_between(west, eye);
        const geo::Geodetic requested = geo::geodesic_end(west, whole.azimuth_start, done.distance);
        EXPECT_LT(geo::geodesic_between(requested, eye).distance, 1.0) << eye.longitude;
    }
    EXPECT_EQ(std::count(raised_.begin(), raised_.end(), 0.0), 98);
}

TEST_F(Flight, LooksAlongItsWayAllTheTime) {
    const std::string file =
        folder_
            .write("line.geojson",
                   R"({"type":"LineString","coordinates":[[0,48,1500],[20,52,1500]]})")
            .string();
    auto scene = scene_of({}, terrain::PlacementKind::ellipsoid);
    const auto path = test::open_path(scene, file);
    ASSERT_TRUE(path) << path.error().message;
    for (int i = 0; i < 30; ++i) {
        session::fly_to(scene, *path, i, 30);
        const auto& camera = *scene.camera->get<scene::Camera>();
        const glm::dvec3 forward = scene::view_axes(camera).forward;
        EXPECT_NEAR(glm::dot(forward, placement_of(scene).up(camera.eye)), 0.0, 1e-3) << i;
        if (i < 29) {
            const scene::Keyframe next = path->at((i + 1) / 29.0 * path->duration());
            EXPECT_GT(glm::dot(forward, glm::normalize(next.eye - camera.eye)), 0.999) << i;
        }
    }
}

// The line leads through the mountain between its two keys.
TEST_F(Flight, IsRaisedOverTheGroundWhereItWouldGoThroughIt) {
    const auto eyes =
        eyes_of("line.geojson", R"({"type":"LineString","coordinates":[[5,50,1500],[15,50,1500]]})",
                51, 100, 8000);
    int raised = 0;
    for (std::size_t i = 0; i < eyes.size(); ++i) {
        EXPECT_GT(eyes[i].height, 1499.0);
        raised += raised_[i] > 0.0 ? 1 : 0;
        EXPECT_NEAR(eyes[i].height - raised_[i], 1500.0, 1.0) << i;
    }
    EXPECT_GT(raised, 4);
    EXPECT_LT(raised, 30) << "what was above the ground stays";
}

TEST_F(Flight, MayGoAMetreAboveTheGround) {
    const auto path_at = [](double height) {
        return fmt::format("[[key]]\ntime = 0\nlatitude = 55\nlongitude = 12\nheight = {}\n",
                           height);
    };
    EXPECT_NEAR(eyes_of("a.toml", path_at(514.0), 1, 512, 512)[0].height, 514.0, 1e-6);
    EXPECT_NEAR(eyes_of("b.toml", path_at(513.0), 1, 512, 512)[0].height, 513.0, 1e-6);
    EXPECT_NEAR(eyes_of("c.toml", path_at(400.0), 1, 512, 512)[0].height, 512.5, 1e-6);
    EXPECT_EQ(raised_[0], 0.0);
    EXPECT_EQ(raised_[1], 0.0);
    EXPECT_NEAR(raised_[2], 112.5, 1e-6);
}

std::vector<scene::Camera> cameras_of(building::CityForm form, double exaggeration) {
    session::SourceOptions choice;
    choice.terrain = "urban";
    choice.buildings = form;
    choice.exaggeration = exaggeration;
    std::vector<scene::Camera> cameras;
    session::Log silent;
    for (const std::optional<scene::Pose> pose :
         {std::optional(scene::Pose::overview), std::optional(scene::Pose::oblique),
          std::optional(scene::Pose::low), std::optional(scene::Pose::grazing),
          std::optional(scene::Pose::valley), std::optional(scene::Pose::map),
          std::optional<scene::Pose>()}) {
        session::SceneOptions view;
        view.pose = pose;
        auto description = session::describe(choice.terrain);
        EXPECT_TRUE(description);
        description->size = 128;
        auto source = session::open_terrain(*description, choice, silent, {});
        EXPECT_TRUE(source) << (source ? "" : source.error().message);
        const auto scene = test::make_scene(std::move(*source), choice, view);
        EXPECT_TRUE(scene);
        cameras.push_back(*scene->camera->get<scene::Camera>());
    }
    return cameras;
}

TEST(PosesOfACity, AreTheSameCamerasInEveryForm) {
    for (const double exaggeration : {1.0, 1.7}) {
        const auto heights = cameras_of(building::CityForm::heights, exaggeration);
        EXPECT_EQ(heights, cameras_of(building::CityForm::meshes, exaggeration));
        EXPECT_EQ(heights, cameras_of(building::CityForm::meshes_only, exaggeration));
    }
}

} // namespace
} // namespace reljef::app
