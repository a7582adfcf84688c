#include "engine/scene/motion/poses.h"

#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

constexpr double w = 400.0;
constexpr double h0 = -7.0;
constexpr double h1 = 93.0;
const Box bounds{{-0.5 * w, -150.0, h0}, {0.5 * w, 150.0, h1}};

double ground(double x, double y) {
    return 0.01 * x + 0.1 * y + 20.0;
}

TEST(Poses, AreTheFormulasOfTheBenchmarks) {
    const Camera overview = pose_camera(Pose::overview, bounds, ground);
    EXPECT_EQ(overview.eye, glm::dvec3(0.0, -0.65 * w, h1 + 0.35 * w));
    EXPECT_EQ(overview.target, glm::dvec3(0.0, -0.05 * w, h0));
    const Camera oblique = pose_camera(Pose::oblique, bounds, ground);
    EXPECT_EQ(oblique.eye, overview.eye);
    EXPECT_EQ(oblique.target, glm::dvec3(0.0, -0.05 * w, h1));
    const Camera low = pose_camera(Pose::low, bounds, ground);
    EXPECT_EQ(low.eye, glm::dvec3(0.0, -0.3 * w, ground(0.0, -0.3 * w) + 0.15 * (h1 - h0)));
    EXPECT_EQ(low.target, glm::dvec3(0.05 * w, 0.4 * w, h0));
    const Camera grazing = pose_camera(Pose::grazing, bounds, ground);
    EXPECT_EQ(grazing.eye, glm::dvec3(0.0, -0.6 * w, h1 + 0.03 * w));
    EXPECT_EQ(grazing.target, glm::dvec3(0.0, 0.0, h1));
    for (const Pose pose : {Pose::overview, Pose::oblique, Pose::low, Pose::grazing}) {
        const Camera camera = pose_camera(pose, bounds, ground);
        EXPECT_EQ(camera.vertical_fov, 57.3);
        EXPECT_EQ(camera.projection, ProjectionKind::perspective);
        EXPECT_EQ(camera.up, glm::dvec3(0.0, 0.0, 1.0));
    }
}

TEST(Poses, TheMapHoldsAllOfItNorthUp) {
    const glm::ivec2 size{1024, 768};
    for (const Box& box : {bounds, Box{{-10.0, -500.0, 0.0}, {10.0, 500.0, 5.0}},
                           Box{{-500.0, -10.0, 0.0}, {500.0, 10.0, 5.0}}}) {
        const Camera map = pose_camera(Pose::map, box, ground);
        EXPECT_EQ(map.projection, ProjectionKind::orthographic);
        for (const double z : {box.low.z, box.high.z}) {
            const auto north_east = project(map, size, {box.high.x, box.high.y, z});
            const auto south_west = project(map, size, {box.low.x, box.low.y, z});
            EXPECT_LT(north_east.pixel.x, 1024.0);
            EXPECT_GT(north_east.pixel.y, 0.0);
            EXPECT_GT(south_west.pixel.x, 0.0);
            EXPECT_LT(south_west.pixel.y, 768.0);
            EXPECT_GT(north_east.pixel.x, south_west.pixel.x);
            EXPECT_LT(north_east.pixel.y, south_west.pixel.y);
            EXPECT_GT(north_east.depth, 0.0);
        }
    }
}

TEST(Poses, FollowBoundsThatAreNotCentred) {
    const Box moved{bounds.low + glm::dvec3(1000.0, 2000.0, 0.0),
                    bounds.high + glm::dvec3(1000.0, 2000.0, 0.0)};
    for (const Pose pose : {Pose::overview, Pose::oblique, Pose::grazing, Pose::map}) {
        EXPECT_EQ(pose_camera(pose, moved, ground).eye,
                  pose_camera(pose, bounds, ground).eye + glm::dvec3(1000.0, 2000.0, 0.0));
    }
}

TEST(Poses, HaveNames) {
    for (const Pose pose : {Pose::overview, Pose::oblique, Pose::low, Pose::grazing, Pose::map}) {
        EXPECT_EQ(pose_from_string(to_string(pose)), pose);
    }
    EXPECT_FALSE(pose_from_string("Overview"));
    EXPECT_FALSE(pose_from_string(""));
}

} // namespace
} // namespace reljef::scene
