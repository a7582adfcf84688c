#include "engine/scene/motion/camera_gestures.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "engine/geo/georeference.h"
#include "engine/scene/motion/camera_transition.h"

namespace reljef::scene {
namespace {

constexpr glm::ivec2 size{800, 600};
constexpr double min_height = 2.0; // metres above the ground

double hill_at(double x, double y) {
    return 60.0 * std::sin(x / 400.0) * std::cos(y / 300.0);
}

GestureWorld plane() {
    GestureWorld world;
    world.size = size;
    world.min_distance = 4.0;
    return world;
}

GestureWorld hills() {
    GestureWorld world = plane();
    world.lifted = [](glm::dvec3 eye) {
        eye.z = std::max(eye.z, hill_at(eye.x, eye.y) + min_height);
        return eye;
    };
    return world;
}

const geo::LocalFrame& alps() {
    static const geo::LocalFrame frame({46.0, 8.0, 0.0});
    return frame;
}

double height_over_ellipsoid(glm::dvec3 world) {
    return alps().geodetic_from_local(world).height;
}

// WGS 84 around a place; the same world is a whole globe.
GestureWorld ellipsoid() {
    GestureWorld world = plane();
    world.radius = 6'371'000.0;
    world.up = [](glm::dvec3 at) {
        const auto place = alps().geodetic_from_local(at);
        return alps().local_direction(geo::normal_from_geodetic(place.latitude, place.longitude));
    };
    world.north = [](glm::dvec3 at) {
        const auto place = alps().geodetic_from_local(at);
        return alps().local_direction(geo::north_from_geodetic(place.latitude, place.longitude));
    };
    world.lifted = [up = world.up](glm::dvec3 eye) {
        return eye + std::max(0.0, min_height - height_over_ellipsoid(eye)) * up(eye);
    };
    return world;
}

struct Setting {
    const char* name;
    GestureWorld world;
    double scale;                                    // metres: of heights and distances
    double (*height)(glm::dvec3);                    // above the ground
    glm::dvec3 (*ground)(double east, double north); // a place of the ground, metres
};

glm::dvec3 on_ellipsoid(double east, double north) {
    const double degrees = 1.0 / 111'195.0;
    return alps().local_from_geodetic(
        {std::clamp(46.0 + north * degrees, -89.0, 89.0), 8.0 + east * degrees, 0.0});
}

std::vector<Setting> settings() {
    return {{"plane", plane(), 1000.0, [](glm::dvec3 p) { return p.z; },
             [](double x, double y) { return glm::dvec3(x, y, 0.0); }},
            {"hills", hills(), 200.0, [](glm::dvec3 p) { return p.z - hill_at(p.x, p.y); },
             [](double x, double y) { return glm::dvec3(x, y, hill_at(x, y)); }},
            {"ellipsoid", ellipsoid(), 10'000.0, height_over_ellipsoid, on_ellipsoid},
            {"globe", ellipsoid(), 3'000'000.0, height_over_ellipsoid, on_ellipsoid}};
}

struct ViewOfPoint {
    Camera camera;
    Grip grip; // where the camera shows the point
};

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double operator()(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    glm::dvec2 pixel() { return {(*this)(0.0, size.x), (*this)(0.0, size.y)}; }

    // A camera over the ground that shows a point of it.
    ViewOfPoint view(const Setting& setting) {
        for (;;) {
            const double scale = setting.scale;
            const glm::dvec3 below = setting.ground((*this)(-scale, scale), (*this)(-scale, scale));
            const glm::dvec3 up =
                setting.world.up ? setting.world.up(below) : glm::dvec3(0.0, 0.0, 1.0);
            const Camera camera =
                upright({}, below + (*this)(0.05, 1.0) * scale * up,
                        {(*this)(-180.0, 180.0), (*this)(-85.0, -10.0)}, setting.world);
            const glm::dvec3 point =
                setting.ground((*this)(-2.0, 2.0) * scale, (*this)(-2.0, 2.0) * scale);
            const Projected shown = project(camera, size, point);
            const glm::dvec3 up_there =
                setting.world.up ? setting.world.up(point) : glm::dvec3(0.0, 0.0, 1.0);
            const double sine = glm::dot(glm::normalize(camera.eye - point), up_there);
            const bool is_inside = shown.pixel.x > 0.0 && shown.pixel.y > 0.0 &&
                                   shown.pixel.x < size.x && shown.pixel.y < size.y;
            if (shown.depth > 0.0 && is_inside && sine > 0.05) {
                return {camera, {point, shown.pixel}};
            }
        }
    }

private:
    std::mt19937 engine_;
};

double pixels_between(const Camera& camera, const Grip& grip) {
    const Projected shown = project(camera, size, grip.point);
    return shown.depth > 0.0 ? glm::distance(shown.pixel, grip.pixel) : HUGE_VAL;
}

// Degrees that the horizon is tilted in the picture.
double roll_of(const Camera& camera, const GestureWorld& world) {
    const glm::dvec3 up = world.up ? world.up(camera.eye) : glm::dvec3(0.0, 0.0, 1.0);
    return glm::degrees(std::asin(glm::dot(view_axes(camera).right, up)));
}

bool is_above(const Setting& setting, const Camera& camera) {
    return !setting.world.lifted || setting.height(camera.eye) > 0.0;
}

// Whether the point is at its pixel. If it is nearer to straight down than the pixel to the middle
// of the picture, an upright camera may not show it there; then it is in sight.
bool is_kept(const Camera& camera, const Grip& grip, const GestureWorld& world) {
    const glm::dvec3 up = world.up ? world.up(camera.eye) : glm::dvec3(0.0, 0.0, 1.0);
    const glm::dvec3 way = glm::normalize(grip.point - camera.eye);
    const glm::dvec3 ray = glm::normalize(view_ray(camera, size, grip.pixel).direction);
    const double steep = std::acos(std::min(1.0, std::abs(glm::dot(way, up))));
    const double beside = std::acos(std::min(1.0, glm::dot(ray, view_axes(camera).forward)));
    const double margin = glm::radians(90.0 - max_pitch) + 1e-9;
    return pixels_between(camera, grip) < 1e-3 ||
           (steep < beside + margin && pixels_between(camera, grip) < size.x);
}

TEST(CameraGestures, PannedPointStaysUnderThePointer) {
    for (const Setting& setting : settings()) {
        Random random(1);
        double worst = 0.0;
        for (int i = 0; i < 500; ++i) {
            const ViewOfPoint view = random.view(setting);
            const glm::dvec2 to = view.grip.pixel + glm::dvec2(random(-60, 60), random(-20, 60));
            const Grip grip{view.grip.point, to};
            const Camera found = panned(view.camera, grip, setting.world);
            const bool is_unchanged = found == view.camera; // the ray misses the level surface
            ASSERT_TRUE(is_above(setting, found)) << setting.name;
            ASSERT_LT(std::abs(roll_of(found, setting.world)), 1e-6) << setting.name;
            worst = is_unchanged ? worst : std::max(worst, pixels_between(found, grip));
        }
        EXPECT_LT(worst, 1.0) << setting.name;
    }
}

TEST(CameraGestures, PanOverAPlaneKeepsHeightAndAngles) {
    Random random(2);
    for (int i = 0; i < 500; ++i) {
        const ViewOfPoint view = random.view(settings().front());
        const Grip grip{view.grip.point, view.grip.pixel + glm::dvec2(30.0, 40.0)};
        const Camera found = panned(view.camera, grip, plane());
        ASSERT_NEAR(found.eye.z, view.camera.eye.z, 1e-9);
        ASSERT_LT(glm::distance(view_axes(found).forward, view_axes(view.camera).forward), 1e-9);
        ASSERT_LT(pixels_between(found, grip), 1e-6);
    }
}

TEST(CameraGestures, PannedThereAndBackItIsTheSameView) {
    const Setting globe = settings().back();
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const ViewOfPoint view = random.view(globe);
        const Grip away{view.grip.point, view.grip.pixel + glm::dvec2(40.0, 30.0)};
        const Camera back = panned(panned(view.camera, away, globe.world), view.grip, globe.world);
        ASSERT_LT(pixels_between(back, view.grip), 1e-2);
    }
}

TEST(CameraGestures, ZoomedPointKeepsItsPixelAndItsDirection) {
    for (const Setting& setting : settings()) {
        Random random(4);
        for (int i = 0; i < 500; ++i) {
            const ViewOfPoint view = random.view(setting);
            const double factor = std::exp(random(-1.0, 0.7));
            const Camera found = zoomed(view.camera, view.grip, factor, setting.world);
            ASSERT_TRUE(is_above(setting, found)) << setting.name;
            ASSERT_TRUE(is_kept(found, view.grip, setting.world)) << setting.name << i;
            if (setting.height(found.eye) > 1.1 * min_height) { // not lifted
                const double ratio = glm::distance(found.eye, view.grip.point) /
                                     glm::distance(view.camera.eye, view.grip.point);
                ASSERT_NEAR(ratio, factor, 1e-9) << setting.name;
            }
        }
    }
}

TEST(CameraGestures, ZoomOverAPlaneKeepsTheAngles) {
    Random random(5);
    const ViewOfPoint view = random.view(settings().front());
    const Camera found = zoomed(view.camera, view.grip, 0.5, plane());
    EXPECT_LT(glm::distance(view_axes(found).forward, view_axes(view.camera).forward), 1e-9);
    EXPECT_NEAR(found.eye.z, 0.5 * view.camera.eye.z, 1e-9);
}

TEST(CameraGestures, ZoomStaysBetweenTheDistancesOfTheWorld) {
    GestureWorld world = plane();
    world.max_distance = 5000.0;
    Random random(6);
    const ViewOfPoint view = random.view(settings().front());
    const auto distance = [&](double factor) {
        return glm::distance(zoomed(view.camera, view.grip, factor, world).eye, view.grip.point);
    };
    EXPECT_NEAR(distance(1e-9), 4.0, 1e-6);
    EXPECT_NEAR(distance(1e9), 5000.0, 1e-6);
}

TEST(CameraGestures, OrbitedPointKeepsItsPixelAndDistance) {
    for (const Setting& setting : settings()) {
        Random random(7);
        for (int i = 0; i < 500; ++i) {
            const ViewOfPoint view = random.view(setting);
            const ViewAngles change{random(-60.0, 60.0), random(-15.0, 15.0)};
            const Camera found = orbited(view.camera, view.grip, change, setting.world);
            ASSERT_TRUE(is_above(setting, found)) << setting.name;
            ASSERT_TRUE(is_kept(found, view.grip, setting.world)) << setting.name << i;
            ASSERT_LT(std::abs(roll_of(found, setting.world)), 1e-6) << setting.name;
            if (setting.height(found.eye) > 1.1 * min_height) {
                const double before = glm::distance(view.camera.eye, view.grip.point);
                ASSERT_NEAR(glm::distance(found.eye, view.grip.point) / before, 1.0, 1e-6)
                    << setting.name;
            }
        }
    }
}

TEST(CameraGestures, OrbitTurnsTheHeading) {
    Random random(8);
    const ViewOfPoint view = random.view(settings().front());
    const Camera found = orbited(view.camera, view.grip, {30.0, -5.0}, plane());
    const ViewAngles before = angles_of(view.camera, plane());
    const ViewAngles after = angles_of(found, plane());
    EXPECT_NEAR(std::remainder(after.heading - before.heading - 30.0, 360.0), 0.0, 1e-9);
    EXPECT_NEAR(after.pitch, std::max(before.pitch - 5.0, -max_pitch), 1e-9);
}

TEST(CameraGestures, AimedShowsThePointAtThePixel) {
    const GestureWorld world = ellipsoid();
    Random random(9);
    for (int i = 0; i < 2000; ++i) {
        const ViewOfPoint view = random.view(settings()[2]);
        const Grip grip{view.grip.point, random.pixel()};
        const Camera found = aimed(view.camera, grip, world);
        ASSERT_EQ(found.eye, view.camera.eye);
        ASSERT_TRUE(is_kept(found, grip, world)) << i;
    }
}

TEST(CameraGestures, GesturesWithoutNumbersChangeNothing) {
    Random random(10);
    const ViewOfPoint view = random.view(settings().front());
    const Camera camera = view.camera;
    for (const double odd : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        const Grip grip{view.grip.point, {odd, 10.0}};
        const Grip nowhere{{odd, 0.0, 0.0}, {10.0, 10.0}};
        for (const Grip& wrong : {grip, nowhere}) {
            EXPECT_EQ(panned(camera, wrong, plane()), camera);
            EXPECT_EQ(zoomed(camera, wrong, 0.5, plane()), camera);
            EXPECT_EQ(orbited(camera, wrong, {1.0, 1.0}, plane()), camera);
            EXPECT_EQ(aimed(camera, wrong, plane()), camera);
        }
        EXPECT_EQ(turned(camera, {odd, 0.0}, plane()), camera);
        EXPECT_EQ(orbited(camera, view.grip, {0.0, odd}, plane()), camera);
    }
    for (const double factor : {std::nan(""), 0.0, -1.0}) {
        EXPECT_EQ(zoomed(camera, view.grip, factor, plane()), camera);
    }
    EXPECT_EQ(panned(camera, {{0.0, 0.0, 0.0}, {400.0, -1e6}}, plane()), camera) << "of the sky";
}

TEST(CameraTransition, BeginsAndEndsWithItsCamerasAndStaysAboveTheGround) {
    for (const Setting& setting : settings()) {
        Random random(11);
        for (int i = 0; i < 50; ++i) {
            const Camera from = random.view(setting).camera;
            const Camera to = random.view(setting).camera;
            const CameraTransition way(from, to, {.seconds = 2.0, .arc = 0.25});
            const Camera first = way.at(0.0, setting.world);
            ASSERT_LT(glm::distance(first.eye, from.eye), 1e-6 * setting.scale);
            ASSERT_LT(glm::distance(view_axes(first).forward, view_axes(from).forward), 1e-9);
            ASSERT_EQ(way.at(2.0, setting.world), to);
            for (int step = 0; step <= 40; ++step) {
                const Camera camera = way.at(0.05 * step, setting.world);
                ASSERT_GT(setting.height(camera.eye), 0.0) << setting.name;
                ASSERT_LT(std::abs(roll_of(camera, setting.world)), 1e-6);
            }
        }
    }
}

TEST(CameraTransition, TimeThatIsNoTimeIsTheEnd) {
    Random random(12);
    const Camera from = random.view(settings().front()).camera;
    const Camera to = random.view(settings().front()).camera;
    EXPECT_EQ(CameraTransition(from, to, {.seconds = 0.0}).at(0.0, plane()), to);
    EXPECT_EQ(CameraTransition(from, to, {.seconds = 1.0}).at(std::nan(""), plane()), to);
}

TEST(CameraTransition, CloserShowsThePointInTheMiddleFromAQuarterOfTheDistance) {
    for (const Setting& setting : settings()) {
        Random random(13);
        for (int i = 0; i < 100; ++i) {
            const ViewOfPoint view = random.view(setting);
            const Camera closer = closer_to(view.camera, view.grip.point, setting.world);
            ASSERT_LT(pixels_between(closer, {view.grip.point, 0.5 * glm::dvec2(size)}), 1e-3);
            ASSERT_LT(glm::distance(closer.eye, view.grip.point),
                      0.5 * glm::distance(view.camera.eye, view.grip.point) + 10.0);
        }
    }
}

} // namespace
} // namespace reljef::scene
