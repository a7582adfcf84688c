#include "engine/scene/graph/camera.h"

#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

bool is_finite(const glm::dmat4& matrix) {
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            if (!std::isfinite(matrix[i][j])) {
                return false;
            }
        }
    }
    return true;
}

void expect_right_frame(const ViewAxes& axes) {
    ASSERT_NEAR(glm::length(axes.right), 1.0, 1e-12);
    ASSERT_NEAR(glm::length(axes.up), 1.0, 1e-12);
    ASSERT_NEAR(glm::length(axes.forward), 1.0, 1e-12);
    ASSERT_LE(glm::distance(glm::cross(axes.right, axes.up), -axes.forward), 1e-12);
}

class Chance {
public:
    explicit Chance(unsigned seed) : random_(seed) {}
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    glm::dvec3 point(double reach) {
        return {between(-reach, reach), between(-reach, reach), between(-reach, reach)};
    }
    Camera camera(ProjectionKind kind) {
        Camera camera;
        camera.projection = kind;
        camera.eye = point(1000.0);
        camera.target = camera.eye + point(10.0);
        camera.up = between(0.0, 1.0) < 0.5 ? glm::dvec3(0.0, 0.0, 1.0) : point(1.0);
        camera.vertical_fov = between(1.0, 150.0);
        camera.view_height = between(0.1, 1000.0);
        camera.near = between(0.01, 1.0);
        return camera;
    }
    glm::ivec2 size() {
        return {static_cast<int>(between(1.0, 2000.0)), static_cast<int>(between(1.0, 2000.0))};
    }

private:
    std::mt19937 random_;
};

TEST(Camera, TheFrameIsOrthonormalAndRightHandedWhereverItLooks) {
    Chance chance(1);
    for (int i = 0; i < 10000; ++i) {
        expect_right_frame(view_axes(chance.camera(ProjectionKind::perspective)));
        if (HasFatalFailure()) {
            return;
        }
    }
}

TEST(Camera, LooksAlongTheAxesAsTheSceneFrameSays) {
    Camera camera;
    camera.eye = {0.0, 0.0, 0.0};
    camera.target = {0.0, 5.0, 0.0}; // north
    EXPECT_EQ(view_axes(camera).right, glm::dvec3(1.0, 0.0, 0.0));
    EXPECT_EQ(view_axes(camera).up, glm::dvec3(0.0, 0.0, 1.0));
    const Projected east = project(camera, {200, 100}, {1.0, 10.0, 0.0});
    EXPECT_GT(east.pixel.x, 100.0);
    const Projected above = project(camera, {200, 100}, {0.0, 10.0, 1.0});
    EXPECT_LT(above.pixel.y, 50.0) << "row 0 is the top";
    EXPECT_DOUBLE_EQ(above.depth, 10.0);
}

TEST(Camera, APartOfAPictureHasItsRays) {
    Chance chance(8);
    for (int i = 0; i < 10000; ++i) {
        const auto kind = i % 2 == 0 ? ProjectionKind::perspective : ProjectionKind::orthographic;
        const Camera camera = chance.camera(kind);
        const glm::ivec2 size = chance.size();
        const PicturePart part{{static_cast<int>(chance.between(0.0, size.x)),
                                static_cast<int>(chance.between(0.0, size.y))},
                               chance.size()};
        const glm::dvec2 pixel(chance.between(0.0, part.size.x), chance.between(0.0, part.size.y));
        const Camera of_part = part_camera(camera, size, part);
        const Ray ray = view_ray(of_part, part.size, pixel);
        const Ray other = view_ray(camera, size, pixel + glm::dvec2(part.first));
        // Doubles of rays up to a few thousand long, or of an eye at 1000 and 1000 wide.
        ASSERT_LE(glm::distance(ray.origin, other.origin), 1e-9);
        ASSERT_LE(glm::distance(ray.direction, other.direction),
                  1e-12 * glm::length(other.direction));
        EXPECT_EQ(whole_picture(of_part, part.size), size);
    }
}

TEST(Camera, AShiftedPictureShowsWhatLiesBesideInTheOther) {
    Chance chance(7);
    for (int i = 0; i < 10000; ++i) {
        const auto kind = i % 2 == 0 ? ProjectionKind::perspective : ProjectionKind::orthographic;
        const Camera plain = chance.camera(kind);
        const glm::ivec2 size = chance.size();
        Camera shifted = plain;
        shifted.shift = {chance.between(-0.5, 0.5), chance.between(-0.5, 0.5)};
        const glm::dvec2 pixel(chance.between(0.0, size.x), chance.between(0.0, size.y));
        const Ray ray = view_ray(shifted, size, pixel);
        const Ray other = view_ray(plain, size, pixel + shifted.shift);
        ASSERT_EQ(ray.origin, other.origin);
        ASSERT_EQ(ray.direction, other.direction);
        const glm::dvec3 point = ray.origin + chance.between(1.0, 1000.0) * ray.direction;
        ASSERT_LE(glm::distance(project(shifted, size, point).pixel, pixel), 1e-6);
        const glm::dvec4 clip = clip_from_world(shifted, size) * glm::dvec4(point, 1.0);
        const glm::dvec2 place = glm::dvec2(clip) / clip.w;
        ASSERT_NEAR(0.5 * (place.x + 1.0) * size.x, pixel.x, 1e-6);
        ASSERT_NEAR(0.5 * (1.0 - place.y) * size.y, pixel.y, 1e-6);
    }
}

TEST(Camera, StraightDownAndUpHaveNorthAtTheTop) {
    Camera camera;
    for (const double z : {-1.0, 1.0}) {
        camera.eye = {3.0, 4.0, 5.0};
        camera.target = camera.eye + glm::dvec3(0.0, 0.0, z);
        const ViewAxes axes = view_axes(camera);
        expect_right_frame(axes);
        EXPECT_EQ(axes.up, glm::dvec3(0.0, 1.0, 0.0));
        EXPECT_EQ(axes.right.x, -z) << "east is right looking down, left looking up";
    }
}

TEST(Camera, AnyDegenerateViewStillHasARightFrame) {
    Camera camera;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const glm::dvec3 look : {glm::dvec3(0.0), glm::dvec3(nan), glm::dvec3(infinity, 0.0, 0.0),
                                  glm::dvec3(1e-300), glm::dvec3(1e300), glm::dvec3(0.0, 1.0, 0.0),
                                  glm::dvec3(0.0, -1.0, 0.0), glm::dvec3(1e-12, 0.0, -1.0)}) {
        for (const glm::dvec3 up :
             {glm::dvec3(0.0), glm::dvec3(nan), glm::dvec3(0.0, 0.0, 1.0),
              glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, 1e-9, -1.0)}) {
            camera.eye = glm::dvec3(0.0);
            camera.target = look;
            camera.up = up;
            expect_right_frame(view_axes(camera));
        }
    }
    camera.eye = camera.target = {1e7, -2e7, 3e7};
    expect_right_frame(view_axes(camera));
}

// Looking almost straight down, the picture turns with the small tilt that is left, without a flip
// into the fallback.
TEST(Camera, KeepsItsHeadingAlmostStraightDown) {
    Camera camera;
    camera.eye = glm::dvec3(0.0);
    camera.target = {1e-6, 0.0, -1.0};
    EXPECT_NEAR(view_axes(camera).up.x, 1.0, 1e-9) << "east is ahead, so east is up";
}

void expect_project_is_clip_from_world(const Camera& camera, glm::ivec2 size, glm::dvec3 point) {
    const Projected projected = project(camera, size, point);
    const glm::dvec4 clip = clip_from_world(camera, size) * glm::dvec4(point, 1.0);
    const glm::dvec2 ndc = glm::dvec2(clip) / clip.w;
    const double tolerance = 1e-7 * (1.0 + glm::length(projected.pixel));
    ASSERT_NEAR(projected.pixel.x, 0.5 * (ndc.x + 1.0) * size.x, tolerance);
    ASSERT_NEAR(projected.pixel.y, 0.5 * (1.0 - ndc.y) * size.y, tolerance);
}

TEST(Camera, ProjectIsClipFromWorld) {
    Chance chance(2);
    for (const auto kind : {ProjectionKind::perspective, ProjectionKind::orthographic}) {
        for (int i = 0; i < 10000; ++i) {
            const Camera camera = chance.camera(kind);
            const glm::dvec3 point = camera.eye + chance.point(100.0);
            if (project(camera, {10, 10}, point).depth > 0.1) {
                expect_project_is_clip_from_world(camera, chance.size(), point);
            }
            if (HasFatalFailure()) {
                return;
            }
        }
    }
}

TEST(Camera, ViewRayIsTheInverseOfProject) {
    Chance chance(3);
    for (const auto kind : {ProjectionKind::perspective, ProjectionKind::orthographic}) {
        for (int i = 0; i < 10000; ++i) {
            const Camera camera = chance.camera(kind);
            const glm::ivec2 size = chance.size();
            const glm::dvec2 pixel{chance.between(0.0, size.x), chance.between(0.0, size.y)};
            const double depth = chance.between(0.1, 1e4);
            const Ray ray = view_ray(camera, size, pixel);
            ASSERT_NEAR(glm::dot(ray.direction, view_axes(camera).forward), 1.0, 1e-12);
            const Projected back = project(camera, size, ray.at(depth));
            ASSERT_NEAR(back.pixel.x, pixel.x, 1e-6);
            ASSERT_NEAR(back.pixel.y, pixel.y, 1e-6);
            ASSERT_NEAR(back.depth, depth, 1e-8 * (1.0 + depth));
        }
    }
}

TEST(Camera, DepthFallsFromOneAtTheNearPlaneToZeroAtInfinity) {
    Camera camera;
    camera.eye = glm::dvec3(0.0);
    camera.target = {0.0, 1.0, 0.0};
    camera.near = 0.25;
    const auto depth_at = [&](double y) {
        const glm::dvec4 clip = clip_from_world(camera, {4, 3}) * glm::dvec4(0.0, y, 0.0, 1.0);
        return clip.z / clip.w;
    };
    EXPECT_DOUBLE_EQ(depth_at(0.25), 1.0);
    EXPECT_DOUBLE_EQ(depth_at(0.5), 0.5);
    double before = 1.0;
    for (double y = 0.5; y < 1e30; y *= 10.0) {
        EXPECT_GT(depth_at(y), 0.0);
        EXPECT_LT(depth_at(y), before);
        before = depth_at(y);
    }
    EXPECT_LT(before, 1e-29);
}

TEST(Camera, OrthographicDepthFallsFromOneToZeroEvenly) {
    Camera camera;
    camera.projection = ProjectionKind::orthographic;
    camera.eye = glm::dvec3(0.0);
    camera.target = {0.0, 1.0, 0.0};
    camera.orthographic_near = -10.0;
    camera.orthographic_far = 30.0;
    const auto depth_at = [&](double y) {
        return (clip_from_world(camera, {4, 3}) * glm::dvec4(0.0, y, 0.0, 1.0)).z;
    };
    EXPECT_DOUBLE_EQ(depth_at(-10.0), 1.0);
    EXPECT_DOUBLE_EQ(depth_at(10.0), 0.5);
    EXPECT_DOUBLE_EQ(depth_at(30.0), 0.0);
}

TEST(Camera, TheVerticalFieldOfViewIsFromBottomToTop) {
    Camera camera;
    camera.eye = glm::dvec3(0.0);
    camera.target = {0.0, 1.0, 0.0};
    for (const double fov : {1e-3, 1.0, 57.3, 90.0, 179.0}) {
        camera.vertical_fov = fov;
        const double edge = std::tan(0.5 * glm::radians(fov));
        EXPECT_NEAR(project(camera, {640, 480}, {0.0, 1.0, edge}).pixel.y, 0.0, 1e-7);
        EXPECT_NEAR(project(camera, {640, 480}, {0.0, 1.0, -edge}).pixel.y, 480.0, 1e-7);
        EXPECT_NEAR(project(camera, {640, 480}, {edge * 4.0 / 3.0, 1.0, 0.0}).pixel.x, 640.0, 1e-7);
        EXPECT_TRUE(is_finite(clip_from_world(camera, {640, 480})));
    }
}

TEST(Camera, IsFiniteAtTheEndsOfTheFieldOfViewAndFarAway) {
    Chance chance(4);
    for (const double fov : {1e-3, 179.0}) {
        for (int i = 0; i < 1000; ++i) {
            Camera camera = chance.camera(ProjectionKind::perspective);
            camera.vertical_fov = fov;
            camera.eye *= 1e4;
            camera.target = camera.eye + chance.point(1.0);
            ASSERT_TRUE(is_finite(clip_from_world(camera, {1024, 768})));
            const Ray ray = view_ray(camera, {1024, 768}, {0.5, 767.5});
            const Projected back = project(camera, {1024, 768}, ray.at(100.0));
            // A pixel of 1e-3° is 2e-6 m wide at 100 m, and positions at 1e7 m are 2e-9 m apart.
            ASSERT_NEAR(back.pixel.x, 0.5, 1e-2);
            ASSERT_NEAR(back.pixel.y, 767.5, 1e-2);
        }
    }
}

TEST(CameraFromAngles, HeadingIsClockwiseFromNorthAndPitchAboveTheHorizon) {
    const auto forward = [](double heading, double pitch) {
        return view_axes(camera_from_angles({1.0, 2.0, 3.0}, heading, pitch)).forward;
    };
    EXPECT_LE(glm::distance(forward(0.0, 0.0), {0.0, 1.0, 0.0}), 1e-12);
    EXPECT_LE(glm::distance(forward(90.0, 0.0), {1.0, 0.0, 0.0}), 1e-12);
    EXPECT_LE(glm::distance(forward(180.0, 30.0), {0.0, -std::sqrt(0.75), 0.5}), 1e-12);
    EXPECT_LE(glm::distance(forward(270.0, -90.0), {0.0, 0.0, -1.0}), 1e-12);
}

TEST(CameraFromAngles, HasNoRollAndKeepsItsHeadingStraightUpAndDown) {
    for (double heading = 0.0; heading < 360.0; heading += 7.5) {
        const double h = glm::radians(heading);
        const glm::dvec3 right(std::cos(h), -std::sin(h), 0.0);
        for (const double pitch : {-90.0, -89.999, -45.0, 0.0, 45.0, 89.999, 90.0}) {
            const ViewAxes axes = view_axes(camera_from_angles(glm::dvec3(0.0), heading, pitch));
            EXPECT_LE(glm::distance(axes.right, right), 1e-9) << heading << ' ' << pitch;
        }
    }
}

TEST(CameraFromAngles, StandsOnTheGroundThatIsGiven) {
    const glm::dvec3 up = glm::normalize(glm::dvec3(0.3, -0.2, 1.0));
    const Camera level = camera_from_angles(glm::dvec3(0.0), 123.0, 0.0, {.up = up});
    EXPECT_NEAR(glm::dot(view_axes(level).forward, up), 0.0, 1e-12);
    EXPECT_NEAR(glm::dot(view_axes(level).right, up), 0.0, 1e-12);
    expect_right_frame(
        view_axes(camera_from_angles(glm::dvec3(0.0), 5.0, 6.0, {.up = {0.0, 1.0, 0.0}})));
}

} // namespace
} // namespace reljef::scene
