// Cameras that stand below the ground.
#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/session/frame_maker.h"
#include "engine/session/ground.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::session {
namespace {

using terrain::PlacementKind;

struct Made {
    std::string name;
    terrain::Heightfield heightfield;
};

terrain::Heightfield placed(Grid<float> heights) {
    return test::geographic_heightfield(std::move(heights), 46.0, 7.0, 1e-3);
}

/// Smooth, rough, and steps as walls are.
std::vector<Made> made_terrains() {
    std::vector<Made> made;
    made.push_back({"hills", placed(test::made_heights(65, 49, [](int col, int row) {
                        return 800.0 + 500.0 * std::sin(0.2 * col) * std::cos(0.3 * row);
                    }))});
    made.push_back({"chance", placed(test::random_heights(33, 41, -300.0F, 900.0F, 7))});
    made.push_back({"walls", placed(test::made_heights(41, 41, [](int col, int row) {
                        return (col / 3 + row / 4) % 2 == 0 ? 0.0 : 120.0;
                    }))});
    return made;
}

TerrainScene scene_of(const terrain::Heightfield& heightfield, PlacementKind kind,
                      double exaggeration = 1.0) {
    terrain::Terrain terrain;
    terrain.heightfield = heightfield;
    TerrainScene scene;
    scene.terrain = *scene.scene.add_terrain(std::move(terrain),
                                             {.placement = kind, .exaggeration = exaggeration});
    scene.camera = &scene.scene.add_camera({});
    scene.bounds = scene.terrain->get<scene::TerrainNode>()->surface->bounds();
    return scene;
}

const scene::TerrainNode& terrain_of(const TerrainScene& scene) {
    return *scene.terrain->get<scene::TerrainNode>();
}

const terrain::Placement& placement_of(const TerrainScene& scene) {
    return terrain_of(scene).surface->placement();
}

scene::Camera& camera_of(TerrainScene& scene) {
    return *scene.camera->get<scene::Camera>();
}

/// An eye so many true metres over a place, in samples, looking north-east and down.
void stand(TerrainScene& scene, glm::dvec2 sample, double above) {
    const terrain::Heightfield& heightfield = terrain_of(scene).surface->heightfield();
    const double ground = terrain::bilinear_height(heightfield.heights.view(), sample);
    scene::Camera& camera = camera_of(scene);
    camera.eye = placement_of(scene).world_from_sample({sample, ground + above});
    camera.target = camera.eye + glm::dvec3(3.0, 4.0, -2.0);
}

constexpr double rounding = 1e-6; // metres, of places on the Earth

/// One camera above or below the ground.
void expect_right(TerrainScene& scene, double above, glm::dvec2 sample) {
    const scene::Camera before = camera_of(scene);
    const Lift lift = lift_camera(scene);
    const scene::Camera& after = camera_of(scene);
    ASSERT_EQ(after.eye, before.eye + lift.way);
    ASSERT_LT(glm::distance(after.target - after.eye, before.target - before.eye), 1e-8)
        << "it looks where it did";
    if (above >= 0.0) {
        ASSERT_FALSE(lift);
        ASSERT_EQ(after, before);
        return;
    }
    const double exaggeration = placement_of(scene).exaggeration();
    ASSERT_TRUE(lift);
    ASSERT_NEAR(lift.depth, -above * exaggeration, 1e-3);
    ASSERT_GE(*height_above_ground(terrain_of(scene), after.eye) * exaggeration,
              min_clearance(scene) - rounding);
    const auto now = placement_of(scene).sample_from_world(after.eye);
    ASSERT_LT(glm::distance(glm::dvec2(*now), sample), 1e-6) << "at the same place";
    ASSERT_EQ(keep_above_ground(scene) > rounding, false) << "above all triangulations, too";
}

TEST(Lift, NeverMovesACameraAboveTheGroundAndLiftsAllBelow) {
    std::mt19937 random(11);
    for (const Made& made : made_terrains()) {
        const glm::dvec2 last(made.heightfield.heights.cols() - 1,
                              made.heightfield.heights.rows() - 1);
        for (const PlacementKind kind : {PlacementKind::plane, PlacementKind::ellipsoid}) {
            for (const double exaggeration : {1.0, 3.5, 0.2}) {
                TerrainScene scene = scene_of(made.heightfield, kind, exaggeration);
                std::uniform_real_distribution<double> part(1e-3, 1.0 - 1e-3);
                std::uniform_real_distribution<double> exponent(-1.5, 3.0);
                for (int i = 0; i < 1000; ++i) {
                    const glm::dvec2 sample = last * glm::dvec2(part(random), part(random));
                    const double size = std::pow(10.0, exponent(random));
                    const double above = i % 2 == 0 ? size : -size;
                    stand(scene, sample, above);
                    expect_right(scene, above, sample);
                    ASSERT_FALSE(testing::Test::HasFatalFailure())
                        << made.name << " " << static_cast<int>(kind) << " " << exaggeration << " "
                        << i << " " << above;
                }
            }
        }
    }
}

TEST(Lift, AnEyeOnTheGroundStays) {
    for (const Made& made : made_terrains()) {
        for (const PlacementKind kind : {PlacementKind::plane, PlacementKind::ellipsoid}) {
            TerrainScene scene = scene_of(made.heightfield, kind);
            for (const glm::dvec2 sample : {glm::dvec2(3.0, 5.0), {7.5, 8.25}, {20.1, 30.0}}) {
                stand(scene, sample, 0.0);
                EXPECT_FALSE(lift_camera(scene)) << made.name;
            }
        }
    }
}

TEST(Lift, BesideTheTerrainAndOnTheOthersSideOfTheEarthNothingIsLifted) {
    for (const PlacementKind kind : {PlacementKind::plane, PlacementKind::ellipsoid}) {
        TerrainScene scene = scene_of(made_terrains()[0].heightfield, kind);
        const glm::dvec3 size = scene.bounds.size();
        for (const glm::dvec3 eye : {scene.bounds.low - glm::dvec3(1.0, 0.0, 5000.0),
                                     glm::dvec3(scene.bounds.high.x + 0.1 * size.x, 0.0, -9000.0),
                                     glm::dvec3(0.0, scene.bounds.high.y + 10.0 * size.y, -100.0),
                                     glm::dvec3(-1e9, 1e9, 0.0)}) {
            camera_of(scene).eye = eye;
            EXPECT_FALSE(lift_camera(scene));
            EXPECT_EQ(camera_of(scene).eye, eye);
        }
    }
}

TEST(Lift, NoNumberIsNotLifted) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinite = std::numeric_limits<double>::infinity();
    for (const PlacementKind kind : {PlacementKind::plane, PlacementKind::ellipsoid}) {
        const TerrainScene scene = scene_of(made_terrains()[0].heightfield, kind);
        for (const glm::dvec3 eye : {glm::dvec3(nan),
                                     {0.0, 0.0, nan},
                                     {0.0, nan, -50.0},
                                     {infinite, 0.0, -50.0},
                                     {0.0, 0.0, -infinite}}) {
            const Lift lift = lift_of(terrain_of(scene), eye, 0.5);
            EXPECT_TRUE(std::isfinite(lift.metres) && std::isfinite(lift.depth));
            EXPECT_TRUE(std::isfinite(glm::length(lift.way)));
        }
    }
}

TEST(Lift, AMapStays) {
    TerrainScene scene = scene_of(made_terrains()[0].heightfield, PlacementKind::plane);
    stand(scene, {20.0, 20.0}, -100.0);
    camera_of(scene).projection = scene::ProjectionKind::orthographic;
    const scene::Camera before = camera_of(scene);
    EXPECT_FALSE(lift_camera(scene));
    EXPECT_EQ(camera_of(scene), before);
}

TEST(Lift, UnderAVoidThereIsNoGround) {
    terrain::Heightfield heightfield = made_terrains()[0].heightfield;
    heightfield.void_mask = Grid<std::uint8_t>(65, 49);
    heightfield.void_mask(20, 20) = 1;
    heightfield.void_count = 1;
    TerrainScene scene = scene_of(heightfield, PlacementKind::plane);
    for (const glm::dvec2 sample : {glm::dvec2(20.0, 20.0), {19.5, 20.5}}) {
        stand(scene, sample, -100.0);
        EXPECT_FALSE(lift_camera(scene));
    }
    stand(scene, {22.0, 20.0}, -100.0);
    EXPECT_TRUE(lift_camera(scene));
}

// A millimetre was taken for rounding: on ground whose samples are a millimetre apart, pictures
// from below it were far off.
TEST(Lift, AnEyeHalfASampleUnderGroundOfMillimetresIsLifted) {
    const auto heights = test::random_heights(1500, 1500, 0.0F, 0.02F, 11);
    TerrainScene scene =
        scene_of(test::plane_heightfield(heights, glm::dvec2(1e-3)), PlacementKind::plane);
    stand(scene, {700.3, 500.6}, -0.5e-3);
    const Lift lift = lift_camera(scene);
    EXPECT_NEAR(lift.depth, 0.5e-3, 1e-6);
    EXPECT_FALSE(lift_camera(scene)) << "it stands above the ground";
}

TEST(Lift, IsToldWithTheOptionItsDepthAndWhatKeepsIt) {
    Lift lift;
    lift.depth = 12.34;
    lift.metres = 12.84;
    EXPECT_EQ(lift_note(lift, "--eye"), "--eye: 12.3 m below the ground: lifted to 0.5 m above it; "
                                        "--allow-underground keeps it");
    lift.depth = 1234.56;
    lift.metres = 1234.5612;
    EXPECT_EQ(lift_note(lift, "fly.toml, key 3").substr(0, 66),
              "fly.toml, key 3: 1234.6 m below the ground: lifted to 0.0012 m abo");
}

} // namespace
} // namespace reljef::session
