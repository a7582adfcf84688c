#include "engine/scene/motion/poses.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
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

TEST(Poses, TheValleyIsTheLowestGroundOfTheMiddle) {
    const auto pit_and_peak = [](double x, double y) {
        const double pit = std::hypot(x - 0.125 * w, y + 0.0625 * w) < 1.0 ? -10.0 : 0.0;
        const double peak = std::hypot(x + 0.25 * w, y - 0.25 * w) < 1.0 ? 50.0 : 0.0;
        const double outside = std::abs(x) > 0.26 * w ? -40.0 : 0.0;
        return 20.0 + pit + peak + outside;
    };
    const Camera valley = pose_camera(Pose::valley, bounds, pit_and_peak);
    EXPECT_EQ(valley.eye, glm::dvec3(0.125 * w, -0.0625 * w, 10.0 + 0.01 * (h1 - h0)));
    EXPECT_EQ(valley.target, glm::dvec3(-0.25 * w, 0.25 * w, 70.0));
    const Camera flat = pose_camera(Pose::valley, bounds, [](double, double) { return 20.0; });
    EXPECT_EQ(flat.target.z, flat.eye.z);
    EXPECT_GT(glm::distance(flat.target, flat.eye), 1.0);
}

TEST(Poses, SeeLevelGroundFromAboveIt) {
    const Box level{{-0.5 * w, -150.0, 20.0}, {0.5 * w, 150.0, 20.0}};
    for (const Pose pose :
         {Pose::overview, Pose::oblique, Pose::low, Pose::grazing, Pose::valley}) {
        const Camera camera = pose_camera(pose, level, [](double, double) { return 20.0; });
        EXPECT_GT(camera.eye.z, 20.0) << to_string(pose);
        EXPECT_GT(glm::distance(camera.target, camera.eye), 1.0) << to_string(pose);
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

// Tall, flat, long, wide, tiny and huge boxes anywhere, in pictures of any shape.
TEST(WholeCamera, CropsNoCornerOfAnyBoxAndFillsThePicture) {
    std::mt19937 random(7);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto size = [&] { return std::pow(10.0, between(-5.0, 7.0)); };
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 half = 0.5 * glm::dvec3(size(), size(), i % 5 == 0 ? 0.0 : size());
        const glm::dvec3 center =
            glm::dvec3(between(-1.0, 1.0), between(-1.0, 1.0), between(-1.0, 1.0)) *
            (i % 3 == 0 ? 0.0 : 1e3);
        const double aspect = std::pow(10.0, between(-1.0, 1.0));
        const Camera camera =
            whole_camera({center - half, center + half}, between(1.0, 170.0), aspect);
        const ViewAxes axes = view_axes(camera);
        EXPECT_NEAR(axes.right.x, 1.0, 1e-9) << "looks north";
        const double half_height = std::tan(0.5 * glm::radians(camera.vertical_fov));
        Box shown; // 1: the border of the picture
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 side((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                                  (corner & 4) != 0 ? 1.0 : -1.0);
            const glm::dvec3 way = center + side * half - camera.eye;
            const double depth = glm::dot(way, axes.forward);
            ASSERT_GT(depth, 0.0);
            const double scale = 1.0 / (depth * half_height);
            shown.add(
                {scale * glm::dot(way, axes.right) / aspect, scale * glm::dot(way, axes.up), 0.0});
        }
        EXPECT_NEAR(std::max(shown.high.x, shown.high.y), 0.9, 1e-3) << i;
        EXPECT_NEAR(shown.low.x, -shown.high.x, 1e-3) << i;
        EXPECT_NEAR(shown.low.y, -shown.high.y, 1e-3) << i;
    }
}

TEST(Poses, HaveNames) {
    for (const Pose pose :
         {Pose::overview, Pose::oblique, Pose::low, Pose::grazing, Pose::valley, Pose::map}) {
        EXPECT_EQ(pose_from_string(to_string(pose)), pose);
    }
    EXPECT_FALSE(pose_from_string("Overview"));
    EXPECT_FALSE(pose_from_string(""));
}

} // namespace
} // namespace reljef::scene
