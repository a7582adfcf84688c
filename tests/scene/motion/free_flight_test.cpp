#include "engine/scene/motion/free_flight.h"

#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

constexpr double clearance = 2.0;

// Rugged and without an end; what is drawn is up to a metre higher.
double hill_height(glm::dvec3 at) {
    return 80.0 * std::sin(at.x / 90.0) * std::cos(at.y / 70.0) + 9.0 * std::sin(at.x / 7.0);
}
std::optional<GroundBelow> hills(glm::dvec3 eye) {
    return GroundBelow{eye.z - hill_height(eye), 0.5 + 0.5 * std::sin(eye.x + eye.y)};
}

std::optional<GroundBelow> plain(glm::dvec3 eye) {
    return GroundBelow{eye.z, 0.0};
}

// Only west of x = 100.
std::optional<GroundBelow> half_plain(glm::dvec3 eye) {
    return eye.x < 100.0 ? std::optional(GroundBelow{eye.z - 50.0, 0.0}) : std::nullopt;
}

FreeFlightOptions over(std::optional<GroundBelow> (*ground)(glm::dvec3)) {
    FreeFlightOptions options;
    options.speed = 40.0;
    options.clearance = clearance;
    options.ground = ground;
    return options;
}

Camera level_camera(glm::dvec3 eye, double heading = 0.0, double pitch = 0.0) {
    return camera_from_angles(eye, heading, pitch);
}

KeyEvent press(Key key, Modifiers modifiers = {}) {
    return {.key = key, .pressed = true, .repeat = false, .modifiers = modifiers};
}
KeyEvent release(Key key) {
    return {.key = key, .pressed = false};
}

double pitch_of(const Camera& camera) {
    return glm::degrees(std::asin(glm::normalize(camera.target - camera.eye).z));
}

bool is_finite(glm::dvec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double above_ground(const Camera& camera) {
    return camera.eye.z - hill_height(camera.eye);
}

Event random_event(std::mt19937& random) {
    constexpr std::array keys{Key::w,  Key::a,    Key::s,         Key::d,     Key::q, Key::e,
                              Key::up, Key::left, Key::page_down, Key::shift, Key::x};
    const auto number = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    switch (std::uniform_int_distribution<int>(0, 9)(random)) {
    case 0:
        return MouseMoveEvent{{number(-4000.0, 4000.0), number(-4000.0, 4000.0)}};
    case 1:
        return MouseButtonEvent{.button = MouseButton::left, .pressed = number(0.0, 1.0) < 0.7};
    case 2:
        return ScrollEvent{{0.0, number(-3.0, 3.0)}};
    case 3:
        return FocusEvent{number(0.0, 1.0) < 0.8};
    default:
        return KeyEvent{
            .key = keys[std::uniform_int_distribution<std::size_t>(0, keys.size() - 1)(random)],
            .pressed = number(0.0, 1.0) < 0.6};
    }
}

TEST(FreeFlight, RandomWalksStayAboveWhatIsDrawn) {
    std::mt19937 random(1);
    for (int walk = 0; walk < 2000; ++walk) {
        FreeFlight flight(level_camera({walk * 3.0, walk * 7.0, -500.0 + walk}), over(hills));
        flight.set_follow_ground(walk % 2 == 0);
        for (int step = 0; step < 40; ++step) {
            flight.receive(random_event(random));
            flight.advance(std::uniform_real_distribution<double>(-0.1, 0.5)(random));
            const Camera camera = flight.camera();
            const double floor = hill_height(camera.eye) + hills(camera.eye)->highest + clearance;
            ASSERT_GE(camera.eye.z, floor - 1e-9) << "walk " << walk << ", step " << step;
            ASSERT_LE(std::abs(pitch_of(camera)), 89.9 + 1e-6);
            ASSERT_TRUE(is_finite(camera.eye) && is_finite(camera.target) && is_finite(camera.up));
        }
    }
}

TEST(FreeFlight, HeightAboveTheGroundIsKept) {
    FreeFlight flight(level_camera({0.0, 0.0, 300.0}, 33.0, -40.0), over(hills));
    const double height = above_ground(flight.camera());
    for (const Key key : {Key::w, Key::d, Key::down, Key::left}) {
        flight.receive(press(key));
        for (int step = 0; step < 200; ++step) {
            flight.advance(0.016);
            ASSERT_NEAR(above_ground(flight.camera()), height, 1e-9);
        }
        flight.receive(release(key));
    }
}

TEST(FreeFlight, HeightIsKeptAgainAfterThePlaceWhereItWasTooLow) {
    FreeFlight flight(level_camera({0.0, 0.0, hill_height(glm::dvec3(0.0)) + 2.2}, 90.0),
                      over(hills));
    flight.receive(press(Key::w));
    double lowest = std::numeric_limits<double>::max();
    for (int step = 0; step < 2000; ++step) {
        flight.advance(0.016);
        lowest = step < 1000 ? lowest : std::min(lowest, above_ground(flight.camera()));
    }
    EXPECT_LT(lowest, 3.0);
}

TEST(FreeFlight, WithoutFollowingItFliesWhereItLooks) {
    FreeFlight flight(level_camera({0.0, 0.0, 300.0}, 90.0, -30.0), over(plain));
    flight.set_follow_ground(false);
    flight.receive(press(Key::w));
    flight.advance(0.25);
    const glm::dvec3 way = flight.camera().eye - glm::dvec3(0.0, 0.0, 300.0);
    EXPECT_NEAR(glm::length(way), 10.0, 1e-9);
    EXPECT_NEAR(way.x, 10.0 * std::cos(glm::radians(30.0)), 1e-9);
    EXPECT_NEAR(way.z, -5.0, 1e-9);
}

TEST(FreeFlight, KeysSteerRelativeToTheHeading) {
    struct Case {
        Key key;
        glm::dvec3 way;
    };
    for (const Case& c :
         {Case{Key::w, {1, 0, 0}}, Case{Key::up, {1, 0, 0}}, Case{Key::s, {-1, 0, 0}},
          Case{Key::d, {0, -1, 0}}, Case{Key::a, {0, 1, 0}}, Case{Key::e, {0, 0, 1}},
          Case{Key::page_down, {0, 0, -1}}}) {
        FreeFlight flight(level_camera({0.0, 0.0, 100.0}, 90.0), over(plain));
        flight.receive(press(c.key));
        EXPECT_TRUE(flight.advance(0.1));
        const glm::dvec3 way = flight.camera().eye - glm::dvec3(0.0, 0.0, 100.0);
        EXPECT_LT(glm::distance(way, 4.0 * c.way), 1e-9) << static_cast<int>(c.key);
    }
}

TEST(FreeFlight, ShiftIsFourTimesAsFast) {
    FreeFlight flight(level_camera({0.0, 0.0, 100.0}), over(plain));
    flight.receive(press(Key::shift));
    EXPECT_FALSE(flight.is_steered());
    flight.receive(press(Key::w, {.shift = true}));
    flight.advance(0.1);
    EXPECT_NEAR(flight.camera().eye.y, 16.0, 1e-9);
}

TEST(FreeFlight, TapBetweenTwoFramesIsNotLost) {
    FreeFlight flight(level_camera({0.0, 0.0, 100.0}), over(plain));
    flight.receive(press(Key::w));
    flight.receive(release(Key::w));
    EXPECT_TRUE(flight.advance(0.1));
    EXPECT_FALSE(flight.advance(0.1));
}

TEST(FreeFlight, KeyWithControlAltOrSuperIsNoSteering) {
    FreeFlight flight(level_camera({0.0, 0.0, 100.0}), over(plain));
    for (const Modifiers& with :
         {Modifiers{.control = true}, Modifiers{.alt = true}, Modifiers{.super = true}}) {
        EXPECT_FALSE(flight.receive(press(Key::s, with)));
    }
    EXPECT_FALSE(flight.advance(0.1));
}

TEST(FreeFlight, StepThatIsNoTimeMovesNothingAndAStallIsNoLeap) {
    FreeFlight flight(level_camera({0.0, 0.0, 100.0}), over(plain));
    flight.receive(press(Key::w));
    for (const double seconds : {0.0, -1.0, -1e6, std::nan(""), -HUGE_VAL}) {
        EXPECT_FALSE(flight.advance(seconds));
        EXPECT_EQ(flight.camera().eye, glm::dvec3(0.0, 0.0, 100.0));
    }
    for (const double seconds : {1e6, HUGE_VAL}) {
        const double before = flight.camera().eye.y;
        EXPECT_TRUE(flight.advance(seconds));
        EXPECT_NEAR(flight.camera().eye.y - before, 10.0, 1e-9);
    }
}

TEST(FreeFlight, MouseTurnsOnlyWithMouseLook) {
    FreeFlight flight(level_camera({0.0, 0.0, 100.0}), over(plain));
    const auto move = [&](glm::dvec2 to) {
        flight.receive(MouseMoveEvent{{100.0, 100.0}});
        flight.receive(MouseMoveEvent{to});
        return flight.advance(0.0);
    };
    EXPECT_FALSE(move({200.0, 100.0}));
    flight.set_mouse_look(true);
    EXPECT_TRUE(move({300.0, 100.0}));
    flight.set_mouse_look(false);
    EXPECT_FALSE(move({200.0, 100.0}));
}

TEST(FreeFlight, MouseLookTurnsRightAndUp) {
    FreeFlight flight(level_camera({0.0, 0.0, 100.0}), over(plain));
    flight.set_mouse_look(true);
    flight.receive(MouseMoveEvent{{0.0, 0.0}});
    flight.receive(MouseMoveEvent{{40.0, -20.0}});
    const Camera camera = flight.camera();
    EXPECT_GT(camera.target.x, camera.eye.x);
    EXPECT_NEAR(pitch_of(camera), 3.0, 1e-9);
}

TEST(FreeFlight, MousePlaceThatIsNoNumberTurnsNothing) {
    FreeFlight flight(level_camera({0.0, 0.0, 100.0}, 10.0, 5.0), over(plain));
    flight.set_mouse_look(true);
    for (const double x : {1.0, std::nan(""), 2.0, HUGE_VAL, 3.0}) {
        flight.receive(MouseMoveEvent{{x, x}});
    }
    flight.change_speed(std::nan(""));
    EXPECT_NEAR(pitch_of(flight.camera()), 5.0, 1e-9);
    EXPECT_EQ(flight.speed(), 40.0);
}

TEST(FreeFlight, LosingTheKeyboardReleasesAll) {
    FreeFlight flight(level_camera({0.0, 0.0, 100.0}), over(plain));
    flight.receive(press(Key::w));
    flight.receive(press(Key::shift));
    flight.receive(FocusEvent{false});
    flight.receive(MouseMoveEvent{{50.0, 50.0}});
    EXPECT_FALSE(flight.is_steered());
    EXPECT_FALSE(flight.advance(0.1));
}

TEST(FreeFlight, SpeedStaysWithinItsBounds) {
    FreeFlight flight(level_camera({0.0, 0.0, 100.0}), over(plain));
    flight.change_speed(1.0);
    EXPECT_NEAR(flight.speed(), 50.0, 1e-9);
    for (const double steps : {1e3, 1e300, HUGE_VAL}) {
        flight.change_speed(steps);
        EXPECT_EQ(flight.speed(), 1e7);
        flight.change_speed(-steps);
        EXPECT_EQ(flight.speed(), 1e-2);
    }
    flight.set_speed(33.0);
    EXPECT_EQ(flight.speed(), 33.0);
    flight.set_speed(std::nan(""));
    EXPECT_EQ(flight.speed(), 33.0);
    flight.set_speed(-1.0);
    EXPECT_EQ(flight.speed(), 1e-2);
}

TEST(FreeFlight, HeldAgainstTheGroundNothingChanges) {
    FreeFlight flight(level_camera({0.0, 0.0, clearance}), over(plain));
    flight.receive(press(Key::q));
    EXPECT_FALSE(flight.advance(0.1));
    flight.receive(release(Key::q));
    flight.receive(press(Key::e));
    EXPECT_TRUE(flight.advance(0.1)) << "rising begins at once";
}

TEST(FreeFlight, BesideTheGroundItStaysLevelAndComesBackAboveIt) {
    FreeFlight flight(level_camera({99.0, 0.0, 60.0}, 90.0), over(half_plain));
    flight.receive(press(Key::w));
    flight.advance(0.25);
    EXPECT_GT(flight.camera().eye.x, 100.0);
    EXPECT_NEAR(flight.camera().eye.z, 60.0, 1e-9);
    flight.receive(release(Key::w));
    flight.receive(press(Key::q));
    for (int step = 0; step < 10; ++step) {
        flight.advance(0.25);
    }
    EXPECT_LT(flight.camera().eye.z, 0.0);
    flight.receive(release(Key::q));
    flight.receive(press(Key::s));
    flight.advance(0.25);
    flight.advance(0.25);
    EXPECT_NEAR(flight.camera().eye.z, 50.0 + clearance, 1e-9);
}

TEST(FreeFlight, CameraItIsGivenIsTheOneItShows) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> angle(-180.0, 180.0);
    for (int i = 0; i < 2000; ++i) {
        FreeFlightOptions options = over(plain);
        const glm::dvec3 up =
            glm::normalize(glm::dvec3(angle(random) / 900.0, angle(random) / 900.0, 1.0));
        options.up = [up](glm::dvec3) { return up; };
        const Camera given =
            camera_from_angles({1.0, 2.0, 300.0}, angle(random), 0.49 * angle(random), {.up = up});
        const Camera shown = FreeFlight(given, options).camera();
        ASSERT_LT(glm::distance(shown.target - shown.eye, given.target - given.eye), 1e-6);
        ASSERT_LT(glm::distance(view_axes(shown).up, view_axes(given).up), 1e-6);
    }
}

TEST(FreeFlight, StraightDownTheTopOfThePictureIsTheHeading) {
    Camera map;
    map.eye = {0.0, 0.0, 500.0};
    map.target = {0.0, 0.0, 0.0};
    map.up = {1.0, 0.0, 0.0};
    FreeFlight flight(map, over(plain));
    flight.receive(press(Key::w));
    flight.advance(0.1);
    EXPECT_NEAR(flight.camera().eye.x, 4.0, 1e-9);
    EXPECT_NEAR(flight.camera().eye.z, 500.0, 1e-9);
    EXPECT_NEAR(pitch_of(flight.camera()), -89.9, 1e-6);
}

// A sphere around the middle, whose poles are on z.
constexpr double radius = 1000.0;
glm::dvec3 north_of_sphere(glm::dvec3 world) {
    const glm::dvec3 up = glm::normalize(world);
    const glm::dvec3 axis(0.0, 0.0, 1.0);
    return glm::normalize(axis - up * glm::dot(axis, up));
}
FreeFlightOptions over_sphere() {
    FreeFlightOptions options;
    options.speed = 100.0;
    options.up = [](glm::dvec3 world) { return glm::normalize(world); };
    options.north = north_of_sphere;
    return options;
}

TEST(FreeFlight, GoesStraightOnOverAPole) {
    const glm::dvec3 up = glm::normalize(glm::dvec3(0.1, 0.0003, 1.0));
    FreeFlight flight(
        camera_from_angles(radius * up, 0.0, 0.0, {.up = up, .north = north_of_sphere(up)}),
        over_sphere());
    const glm::dvec3 ahead = view_axes(flight.camera()).forward;
    const glm::dvec3 across = glm::normalize(glm::cross(up, ahead));
    flight.receive(press(Key::w));
    for (int i = 0; i < 20; ++i) { // 0.025 each: 0.1 to the pole and on
        flight.advance(0.25);
        const Camera camera = flight.camera();
        ASSERT_LT(std::abs(glm::dot(camera.eye, across)), 1e-6) << i;
        ASSERT_LT(std::abs(glm::dot(view_axes(camera).forward, across)), 1e-9) << i;
        ASSERT_GT(glm::dot(view_axes(camera).forward, ahead), 0.8) << i;
    }
    EXPECT_LT(flight.camera().eye.x, -0.3 * radius);
}

} // namespace
} // namespace reljef::scene
