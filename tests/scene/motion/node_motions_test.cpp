#include "engine/scene/motion/node_motions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool is_near(glm::dvec3 a, glm::dvec3 b) {
    return glm::distance(a, b) <= 1e-9;
}

TEST(FlyCircle, GoesOnceAroundFromTheEast) {
    const FlyCircle circle{.center = {10.0, 20.0, 30.0}, .radius = 5.0, .seconds = 8.0};
    EXPECT_TRUE(is_near(circle.at(0.0), {15.0, 20.0, 30.0}));
    EXPECT_TRUE(is_near(circle.at(2.0), {10.0, 25.0, 30.0}));
    EXPECT_TRUE(is_near(circle.at(4.0), {5.0, 20.0, 30.0}));
    EXPECT_TRUE(is_near(circle.at(8.0), circle.at(0.0)));
    EXPECT_TRUE(is_near(circle.at(-2.0), circle.at(6.0)));
    EXPECT_TRUE(is_near(circle.at(8e9 + 1.0), circle.at(1.0)));
    FlyCircle other = circle;
    other.turn = 90.0;
    EXPECT_TRUE(is_near(other.at(0.0), circle.at(2.0)));
    other = circle;
    other.seconds = -8.0;
    EXPECT_TRUE(is_near(other.at(2.0), circle.at(6.0))) << "clockwise";
    other.seconds = 0.0;
    EXPECT_TRUE(is_near(other.at(3.0), circle.at(0.0))) << "stands still";
}

TEST(FlyCircle, StaysAcrossItsAxis) {
    for (const glm::dvec3 axis : {glm::dvec3(1.0, 0.0, 0.0), {0.0, -2.0, 0.0}, {1.0, 2.0, 3.0}}) {
        const FlyCircle circle{.center = {1.0, 2.0, 3.0}, .radius = 7.0, .axis = axis};
        for (double time = 0.0; time < 20.0; time += 0.7) {
            const glm::dvec3 arm = circle.at(time) - circle.center;
            const glm::dvec3 ahead = circle.at(time + 0.01) - circle.at(time);
            EXPECT_NEAR(glm::length(arm), 7.0, 1e-9);
            EXPECT_NEAR(glm::dot(arm, axis), 0.0, 1e-9);
            EXPECT_GT(glm::dot(glm::cross(arm, ahead), axis), 0.0) << "counter-clockwise";
        }
    }
}

TEST(FlyStraight, StaysReturnsOrRepeats) {
    FlyStraight way{.from = {0.0, 0.0, 1.0}, .to = {10.0, 0.0, 1.0}, .seconds = 5.0};
    const auto x_at = [&](AfterEnd after, double time) {
        way.after = after;
        EXPECT_EQ(way.at(time).z, 1.0);
        return way.at(time).x;
    };
    for (const AfterEnd after : {AfterEnd::stay, AfterEnd::repeat, AfterEnd::turn_back}) {
        EXPECT_DOUBLE_EQ(x_at(after, 0.0), 0.0);
        EXPECT_DOUBLE_EQ(x_at(after, 2.0), 4.0);
    }
    EXPECT_DOUBLE_EQ(x_at(AfterEnd::stay, -1.0), 0.0);
    EXPECT_DOUBLE_EQ(x_at(AfterEnd::stay, 7.0), 10.0);
    EXPECT_DOUBLE_EQ(x_at(AfterEnd::repeat, 7.0), 4.0);
    EXPECT_DOUBLE_EQ(x_at(AfterEnd::repeat, -1.0), 8.0);
    EXPECT_DOUBLE_EQ(x_at(AfterEnd::turn_back, 5.0), 10.0);
    EXPECT_DOUBLE_EQ(x_at(AfterEnd::turn_back, 7.0), 6.0);
    EXPECT_DOUBLE_EQ(x_at(AfterEnd::turn_back, 12.0), 4.0);
    EXPECT_DOUBLE_EQ(x_at(AfterEnd::turn_back, -1.0), 2.0);
}

const std::vector<glm::dvec3> some_points{
    {0.0, 0.0, 0.0}, {10.0, 5.0, 1.0}, {20.0, -5.0, 3.0}, {15.0, -20.0, 2.0}};

TEST(FollowSpline, MeetsItsPointsInTime) {
    for (const AfterEnd after : {AfterEnd::stay, AfterEnd::repeat, AfterEnd::turn_back}) {
        const FollowSpline spline{.points = some_points, .seconds = 2.0, .after = after};
        for (std::size_t i = 0; i < some_points.size(); ++i) {
            EXPECT_TRUE(is_near(spline.at(2.0 * static_cast<double>(i)), some_points[i])) << i;
        }
    }
    FollowSpline spline{.points = some_points, .seconds = 2.0, .after = AfterEnd::stay};
    EXPECT_TRUE(is_near(spline.at(100.0), some_points[3]));
    spline.after = AfterEnd::turn_back;
    EXPECT_TRUE(is_near(spline.at(7.5), spline.at(4.5)));
    spline.after = AfterEnd::repeat;
    EXPECT_TRUE(is_near(spline.at(8.0), some_points[0]));
    EXPECT_TRUE(is_near(spline.at(11.0), spline.at(3.0)));
}

// Velocities from both sides of each point, also where a closed spline returns to its first.
TEST(FollowSpline, HasNoKinks) {
    const FollowSpline spline{.points = some_points};
    for (int i = 0; i < 9; ++i) {
        const glm::dvec3 before = (spline.at(i) - spline.at(i - 1e-6)) / 1e-6;
        const glm::dvec3 after = (spline.at(i + 1e-6) - spline.at(i)) / 1e-6;
        EXPECT_LE(glm::distance(before, after), 1e-3) << i;
    }
}

// Catmull-Rom splines keep what is linear.
TEST(FollowSpline, IsStraightThroughPointsOnALine) {
    FollowSpline spline{
        .points = {{0.0, 0.0, 0.0}, {1.0, 2.0, 0.0}, {2.0, 4.0, 0.0}, {3.0, 6.0, 0.0}},
        .after = AfterEnd::stay};
    EXPECT_TRUE(is_near(spline.at(1.3), {1.3, 2.6, 0.0}));
    spline.points = some_points;
    spline.tightness = 0.0;
    const glm::dvec3 along = glm::normalize(some_points[2] - some_points[1]);
    const glm::dvec3 off = spline.at(1.4) - some_points[1];
    EXPECT_TRUE(is_near(off, glm::dot(off, along) * along));
}

TEST(FollowSpline, OfOneOrTwoPoints) {
    for (const AfterEnd after : {AfterEnd::stay, AfterEnd::repeat, AfterEnd::turn_back}) {
        const FollowSpline one{.points = {{1.0, 2.0, 3.0}}, .after = after};
        EXPECT_TRUE(is_near(one.at(0.3), {1.0, 2.0, 3.0}));
        const FollowSpline two{.points = {{0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}}, .after = after};
        EXPECT_TRUE(is_near(two.at(0.5), {1.0, 0.0, 0.0}));
    }
}

TEST(FollowSplineDeathTest, NeedsPoints) {
    EXPECT_DEATH((void)FollowSpline{}.at(0.0), "at least one point");
}

TEST(Rotation, TurnsWhatItBeganWith) {
    Rotation rotation{.degrees_per_second = 30.0};
    EXPECT_TRUE(is_near(rotation.at(3.0) * glm::dvec3(1.0, 0.0, 0.0), {0.0, 1.0, 0.0}));
    EXPECT_TRUE(is_near(rotation.at(-3.0) * glm::dvec3(1.0, 0.0, 0.0), {0.0, -1.0, 0.0}));
    EXPECT_TRUE(is_near(rotation.at(12e9 + 3.0) * glm::dvec3(1.0, 0.0, 0.0), {0.0, 1.0, 0.0}));
    rotation.begin = glm::dmat3(2.0);
    EXPECT_TRUE(is_near(rotation.at(3.0) * glm::dvec3(1.0, 0.0, 0.0), {0.0, 2.0, 0.0}));
    EXPECT_NEAR(glm::determinant(rotation.at(1.7)), 8.0, 1e-9);
}

std::vector<std::shared_ptr<const material::ReliefMaterial>> three_sets() {
    return {std::make_shared<const material::ReliefMaterial>(),
            std::make_shared<const material::ReliefMaterial>(),
            std::make_shared<const material::ReliefMaterial>()};
}

TEST(TextureCycle, ShowsEachForItsTime) {
    TextureCycle cycle{.sets = three_sets(), .seconds = 0.5};
    const auto index_at = [&](AfterEnd after, double time) {
        cycle.after = after;
        const auto found = std::find(cycle.sets.begin(), cycle.sets.end(), cycle.at(time));
        return found - cycle.sets.begin();
    };
    for (const AfterEnd after : {AfterEnd::stay, AfterEnd::repeat, AfterEnd::turn_back}) {
        EXPECT_EQ(index_at(after, 0.0), 0);
        EXPECT_EQ(index_at(after, 0.49), 0);
        EXPECT_EQ(index_at(after, 0.5), 1);
        EXPECT_EQ(index_at(after, 1.49), 2);
    }
    EXPECT_EQ(index_at(AfterEnd::stay, 1.6), 2);
    EXPECT_EQ(index_at(AfterEnd::repeat, 1.6), 0);
    EXPECT_EQ(index_at(AfterEnd::repeat, -0.1), 2);
    EXPECT_EQ(index_at(AfterEnd::turn_back, 1.6), 1);
    EXPECT_EQ(index_at(AfterEnd::turn_back, 2.1), 0);
    cycle.sets.resize(1);
    EXPECT_EQ(index_at(AfterEnd::turn_back, 9.0), 0);
}

TEST(NodeMotions, AreFiniteAtAnyTime) {
    const FlyCircle circle;
    const FollowSpline spline{.points = some_points};
    const Rotation rotation;
    const TextureCycle cycle{.sets = three_sets()};
    for (const double time : {infinity, -infinity, std::nan(""), 1e308, -1e308, 1e-320}) {
        for (const AfterEnd after : {AfterEnd::stay, AfterEnd::repeat, AfterEnd::turn_back}) {
            for (const double seconds : {1.0, 0.0, -1.0, 1e-320, infinity, std::nan("")}) {
                const FlyStraight way{{}, {1.0, 2.0, 3.0}, seconds, after};
                const FollowSpline other{some_points, seconds, 0.5, after};
                EXPECT_TRUE(std::isfinite(way.at(time).x)) << time << ' ' << seconds;
                EXPECT_TRUE(std::isfinite(other.at(time).x)) << time << ' ' << seconds;
                EXPECT_NE((TextureCycle{three_sets(), seconds, after}.at(time)), nullptr);
            }
        }
        EXPECT_TRUE(std::isfinite(circle.at(time).x)) << time;
        EXPECT_TRUE(std::isfinite(rotation.at(time)[0][0])) << time;
    }
    EXPECT_EQ(circle.at(std::nan("")), circle.at(0.0));
    EXPECT_EQ(spline.at(std::nan("")), spline.at(0.0));
    EXPECT_EQ(cycle.at(std::nan("")), cycle.at(0.0));
}

TEST(NodeMotions, AnimateANodeWithoutDisturbingEachOther) {
    Scene scene;
    Node& node = scene.add_mesh(box_mesh({1.0F, 1.0F, 1.0F}));
    const FlyCircle circle;
    const Rotation rotation{.begin = glm::dmat3(2.0)};
    const TextureCycle cycle{.sets = three_sets()};
    node.add_animator(animator(circle));
    node.add_animator(animator(rotation));
    node.add_animator(animator(cycle));
    for (const double time : {5.0, 0.3, 17.0}) {
        scene.root().animate(time);
        EXPECT_EQ(glm::dvec3(node.parent_from_local()[3]), circle.at(time));
        EXPECT_EQ(glm::dmat3(node.parent_from_local()), rotation.at(time));
        EXPECT_EQ(node.get<MeshNode>()->material.detail.set, cycle.at(time));
    }
    Node& group = scene.root().add("group");
    group.add_animator(animator(cycle));
    group.add_animator(animator(FlyStraight{.to = {1.0, 0.0, 0.0}}));
    group.add_animator(animator(FollowSpline{.points = some_points}));
    scene.root().animate(2.0);
    EXPECT_EQ(glm::dvec3(group.parent_from_local()[3]), some_points[2]);
}

TEST(NodeMotions, MoveACamera) {
    Scene scene;
    Node& node = scene.add_camera({});
    const glm::dvec3 eye = scene.camera().eye;
    node.add_animator(animator(FlyStraight{{}, {0.0, 0.0, 10.0}, 10.0}));
    scene.root().animate(4.0);
    EXPECT_EQ(scene.camera().eye, eye + glm::dvec3(0.0, 0.0, 4.0));
}

TEST(Node, IsRemovedAtItsEnd) {
    Scene scene;
    Node& group = scene.root().add("group");
    Node& brief = group.add("brief");
    brief.set_end(3.0);
    int calls = 0;
    brief.add_animator([&](Node&, double) { ++calls; });
    scene.root().animate(2.9);
    EXPECT_EQ(group.children().size(), 1U);
    scene.root().animate(std::nan(""));
    EXPECT_EQ(group.children().size(), 1U);
    scene.root().animate(3.0);
    EXPECT_TRUE(group.children().empty());
    EXPECT_EQ(calls, 2);
    scene.root().set_end(0.0);
    scene.root().animate(infinity);
    EXPECT_EQ(scene.root().children().size(), 1U) << "the group has no end";
}

} // namespace
} // namespace reljef::scene
