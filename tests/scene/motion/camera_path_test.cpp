#include "engine/scene/motion/camera_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

using testing::HasSubstr;

CameraPath path_of(std::vector<Keyframe> keys) {
    auto path = CameraPath::create(std::move(keys));
    EXPECT_TRUE(path);
    return std::move(path).value();
}

bool is_finite(const Keyframe& key) {
    return std::isfinite(glm::dot(key.eye, key.eye)) &&
           std::isfinite(glm::dot(key.target, key.target));
}

std::vector<Keyframe> random_keys(std::mt19937& random, int count) {
    std::uniform_real_distribution<double> place(-100.0, 100.0);
    std::uniform_real_distribution<double> wait(0.0, 3.0);
    std::vector<Keyframe> keys;
    double time = place(random);
    for (int i = 0; i < count; ++i) {
        keys.push_back({time,
                        {place(random), place(random), place(random)},
                        {place(random), place(random), place(random)}});
        time += wait(random);
    }
    return keys;
}

TEST(CameraPath, PassesThroughItsKeys) {
    std::mt19937 random(1);
    for (int round = 0; round < 200; ++round) {
        const auto keys = random_keys(random, 1 + round % 9);
        const CameraPath path = path_of(keys);
        for (const Keyframe& key : keys) {
            ASSERT_LE(glm::distance(path.at(key.time).eye, key.eye), 1e-9);
            ASSERT_LE(glm::distance(path.at(key.time).target, key.target), 1e-9);
        }
        EXPECT_EQ(path.begin(), keys.front().time);
        EXPECT_EQ(path.duration(), keys.back().time - keys.front().time);
    }
}

void expect_between(glm::dvec3 place, glm::dvec3 a, glm::dvec3 b) {
    for (int axis = 0; axis < 3; ++axis) {
        ASSERT_GE(place[axis], std::min(a[axis], b[axis]));
        ASSERT_LE(place[axis], std::max(a[axis], b[axis]));
    }
}

TEST(CameraPath, NeverLeavesTheRangeOfTheTwoKeysAround) {
    std::mt19937 random(2);
    for (int round = 0; round < 100; ++round) {
        const auto keys = random_keys(random, 6);
        const CameraPath path = path_of(keys);
        for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
            for (int step = 0; step <= 50; ++step) {
                const double time = std::lerp(keys[i].time, keys[i + 1].time, step / 50.0);
                const Keyframe at = path.at(time);
                expect_between(at.eye, keys[i].eye, keys[i + 1].eye);
                expect_between(at.target, keys[i].target, keys[i + 1].target);
                if (HasFatalFailure()) {
                    return;
                }
            }
        }
    }
}

TEST(CameraPath, EveryPieceIsMonotone) {
    const CameraPath path = path_of({{0.0, {0.0, 0.0, 0.0}, {}},
                                     {1.0, {1.0, 0.0, 0.0}, {}},
                                     {1.1, {100.0, 0.0, 0.0}, {}},
                                     {5.0, {101.0, 0.0, 0.0}, {}}});
    double before = -1.0;
    for (double time = 0.0; time <= 5.0; time += 1e-3) {
        const double x = path.at(time).eye.x;
        ASSERT_GE(x, before) << time;
        before = x;
    }
}

TEST(CameraPath, IsSmoothAtItsKeys) {
    std::mt19937 random(3);
    for (int round = 0; round < 50; ++round) {
        auto keys = random_keys(random, 5);
        for (std::size_t i = 0; i < keys.size(); ++i) {
            keys[i].time = static_cast<double>(i);
        }
        const CameraPath path = path_of(keys);
        constexpr double h = 1e-5;
        for (const double time : {1.0, 2.0, 3.0}) {
            const glm::dvec3 before = (path.at(time).eye - path.at(time - h).eye) / h;
            const glm::dvec3 after = (path.at(time + h).eye - path.at(time).eye) / h;
            ASSERT_LE(glm::distance(before, after), 0.1);
        }
    }
}

TEST(CameraPath, GoesStraightAtAnEvenSpeedAlongALine) {
    std::vector<Keyframe> keys;
    for (int i = 0; i < 6; ++i) {
        keys.push_back({2.0 * i, {3.0 * i, -i, 7.0}, {}});
    }
    const CameraPath path = path_of(keys);
    for (double time = 2.0; time <= 8.0; time += 0.1) {
        EXPECT_LE(glm::distance(path.at(time).eye, {1.5 * time, -0.5 * time, 7.0}), 1e-12);
    }
}

TEST(CameraPath, TakesKeysInAnyOrder) {
    std::mt19937 random(4);
    auto keys = random_keys(random, 8);
    const CameraPath sorted = path_of(keys);
    std::shuffle(keys.begin(), keys.end(), random);
    const CameraPath shuffled = path_of(keys);
    for (double time = sorted.begin(); time < sorted.end(); time += 0.1) {
        ASSERT_EQ(sorted.at(time).eye, shuffled.at(time).eye);
    }
}

TEST(CameraPath, OfKeysAtOneTimeTheLastCounts) {
    const CameraPath path = path_of({{1.0, {1.0, 0.0, 0.0}, {}},
                                     {2.0, {2.0, 0.0, 0.0}, {}},
                                     {1.0, {5.0, 0.0, 0.0}, {}},
                                     {2.0, {7.0, 0.0, 0.0}, {}}});
    EXPECT_EQ(path.at(1.0).eye.x, 5.0);
    EXPECT_EQ(path.at(2.0).eye.x, 7.0);
    EXPECT_EQ(path_of({{1.0, {1.0, 0.0, 0.0}, {}}, {1.0, {2.0, 0.0, 0.0}, {}}}).duration(), 0.0);
}

// Slopes between keys that nearly coincide overflow where they are not handled.
TEST(CameraPath, IsFiniteWithKeysAHairsBreadthApart) {
    const double least = std::numeric_limits<double>::denorm_min();
    for (const double gap : {least, 1e-300, 1e-160, 1e-30}) {
        const CameraPath path = path_of({{0.0, {0.0, 0.0, 0.0}, {}},
                                         {gap, {1e6, -1e-300, 1e-200}, {}},
                                         {2.0 * gap, {2e6, -1.0, 1e200}, {}},
                                         {1.0, {3e6, -2.0, 1e200}, {}},
                                         {1.0 + 1e-15, {4e6, -3.0, 0.0}, {}}});
        for (const double time :
             {0.0, 0.5 * gap, gap, 1.5 * gap, 2.0 * gap, 1e-20, 0.5, 1.0, 2.0}) {
            const Keyframe at = path.at(time);
            ASSERT_TRUE(std::isfinite(at.eye.x) && std::isfinite(at.eye.y) &&
                        std::isfinite(at.eye.z))
                << gap << ' ' << time;
        }
    }
}

TEST(CameraPath, StandsStillBeforeAndAfterAndAtTimesThatAreNone) {
    const CameraPath path =
        path_of({{1.0, {1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}}, {2.0, {7.0, 8.0, 9.0}, {0.0, 0.0, 0.0}}});
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double time : {-infinity, -1e308, 0.0, 1.0, std::nan("")}) {
        EXPECT_EQ(path.at(time).eye, glm::dvec3(1.0, 2.0, 3.0)) << time;
        EXPECT_EQ(path.at(time).target, glm::dvec3(4.0, 5.0, 6.0)) << time;
    }
    for (const double time : {2.0, 1e6, 1e308, infinity}) {
        EXPECT_EQ(path.at(time).eye, glm::dvec3(7.0, 8.0, 9.0)) << time;
    }
}

TEST(CameraPath, TimeMayGoBackwards) {
    std::mt19937 random(5);
    const CameraPath path = path_of(random_keys(random, 7));
    const Keyframe early = path.at(path.begin() + 1.0);
    (void)path.at(path.end());
    EXPECT_EQ(path.at(path.begin() + 1.0).eye, early.eye);
}

TEST(CameraPath, NoKeyIsAnErrorThatSaysSo) {
    const auto path = CameraPath::create({});
    ASSERT_FALSE(path);
    EXPECT_THAT(path.error().message, HasSubstr("no key"));
}

TEST(CameraPath, AKeyThatIsNotFiniteIsAnErrorThatNamesIt) {
    const double nan = std::nan("");
    const double infinity = std::numeric_limits<double>::infinity();
    for (const Keyframe& bad : {Keyframe{nan, {}, {}}, Keyframe{1.0, {0.0, infinity, 0.0}, {}},
                                Keyframe{1.0, {}, {0.0, 0.0, nan}}}) {
        const auto path = CameraPath::create({{0.0, {}, {}}, bad});
        ASSERT_FALSE(path);
        EXPECT_THAT(path.error().message, HasSubstr("key 2"));
    }
}

TEST(OrbitPath, GoesOnceAroundAndKeepsItsDistance) {
    const Box bounds{{-10.0, -5.0, 1.0}, {30.0, 15.0, 4.0}};
    const CameraPath path = orbit_path(bounds, 12.0);
    EXPECT_EQ(path.duration(), 12.0);
    EXPECT_LE(glm::distance(path.at(0.0).eye, path.at(12.0).eye), 1e-9);
    const glm::dvec3 middle = bounds.center();
    const double radius = glm::distance(glm::dvec2(path.at(0.0).eye), glm::dvec2(middle));
    EXPECT_GT(radius, 20.0) << "outside the bounds";
    glm::dvec2 sum(0.0);
    for (int i = 0; i < 100; ++i) {
        const Keyframe at = path.at(0.12 * i);
        EXPECT_NEAR(glm::distance(glm::dvec2(at.eye), glm::dvec2(middle)), radius, 0.01 * radius);
        EXPECT_GT(at.eye.z, bounds.high.z);
        EXPECT_EQ(glm::dvec2(at.target), glm::dvec2(middle));
        sum += glm::dvec2(at.eye) - glm::dvec2(middle);
    }
    EXPECT_LE(glm::length(sum) / 100.0, 0.05 * radius);
}

// And looks at it, to the last frame.
TEST(FlyoverPath, StaysAboveTheGround) {
    const Box bounds{{-500.0, -500.0, 0.0}, {500.0, 500.0, 120.0}};
    const auto is_over = [&](glm::dvec3 place) {
        return std::abs(place.x) < 500.0 && std::abs(place.y) < 500.0;
    };
    const auto ground = [](double x, double y) {
        return 60.0 + 60.0 * std::sin(0.02 * x) * std::cos(0.017 * y);
    };
    const CameraPath path = flyover_path(bounds, ground, 30.0);
    for (double time = 0.0; time <= 30.0; time += 0.02) {
        const Keyframe at = path.at(time);
        ASSERT_TRUE(is_finite(at));
        ASSERT_GT(at.eye.z, ground(at.eye.x, at.eye.y)) << time;
        ASSERT_TRUE(is_over(at.eye)) << time;
        ASSERT_TRUE(is_over(at.target)) << time;
        const glm::dvec3 way = at.target - at.eye;
        ASSERT_LT(way.z, -0.2 * glm::length(glm::dvec2(way))) << "nearly level, at " << time;
    }
}

// A tower lifts the eye over it, but in no step.
TEST(FlyoverPath, RisesGentlyOverATower) {
    const Box bounds{{-500.0, -500.0, 0.0}, {500.0, 500.0, 200.0}};
    const auto ground = [](double /*x*/, double y) { return std::abs(y) < 30.0 ? 200.0 : 0.0; };
    const CameraPath path = flyover_path(bounds, ground, 30.0);
    for (double time = 0.1; time <= 30.0; time += 0.1) {
        const glm::dvec3 before = path.at(time - 0.1).eye;
        const glm::dvec3 after = path.at(time).eye;
        ASSERT_GT(after.z, ground(after.x, after.y) + 40.0) << time;
        ASSERT_LT(std::abs(after.z - before.z), 3.0 * std::abs(after.y - before.y)) << time;
    }
}

TEST(BuiltInPaths, AreFiniteOverAPointlikeTerrain) {
    const Box point{{3.0, 3.0, 3.0}, {3.0, 3.0, 3.0}};
    EXPECT_TRUE(is_finite(orbit_path(point).at(7.0)));
    EXPECT_TRUE(is_finite(flyover_path(point, [](double, double) { return 3.0; }).at(7.0)));
}

} // namespace
} // namespace reljef::scene
