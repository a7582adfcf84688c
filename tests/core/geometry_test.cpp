#include "engine/core/geometry.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace reljef {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

class Random {
public:
    double number(double low, double high) {
        return std::uniform_real_distribution(low, high)(engine_);
    }
    glm::dvec3 point(double reach) {
        return {number(-reach, reach), number(-reach, reach), number(-reach, reach)};
    }
    glm::dvec3 point_in(const Box& box) {
        return {number(box.low.x, box.high.x), number(box.low.y, box.high.y),
                number(box.low.z, box.high.z)};
    }
    Box box(double reach, double largest) {
        const glm::dvec3 low = point(reach);
        return {low, low + glm::abs(point(largest))};
    }

private:
    std::mt19937 engine_{20240229};
};

std::array<glm::dvec3, 8> corners(const Box& box) {
    std::array<glm::dvec3, 8> result;
    for (std::size_t i = 0; i < 8; ++i) {
        result[i] = {(i & 1U) != 0 ? box.high.x : box.low.x, (i & 2U) != 0 ? box.high.y : box.low.y,
                     (i & 4U) != 0 ? box.high.z : box.low.z};
    }
    return result;
}

bool holds(const Box& box, glm::dvec3 point, double slack) {
    return glm::all(glm::greaterThanEqual(point, box.low - slack)) &&
           glm::all(glm::lessThanEqual(point, box.high + slack));
}

// Reversed depth, infinite far plane; x and y as glm::perspective's.
glm::dmat4 infinite_perspective(double fov, double aspect, double near) {
    glm::dmat4 clip_from_view(0.0);
    clip_from_view[1][1] = 1.0 / std::tan(0.5 * fov);
    clip_from_view[0][0] = clip_from_view[1][1] / aspect;
    clip_from_view[2][3] = -1.0;
    clip_from_view[3][2] = near;
    return clip_from_view;
}

glm::dmat4 random_camera(Random& random, int kind) {
    const glm::dmat4 view_from_world =
        glm::lookAt(random.point(100.0), random.point(100.0), glm::dvec3(0.0, 0.0, 1.0));
    if (kind == 0) {
        return infinite_perspective(random.number(0.1, 2.5), random.number(0.3, 3.0), 0.1) *
               view_from_world;
    }
    if (kind == 1) {
        return glm::perspective(random.number(0.1, 2.5), 1.3, 1.0, 150.0) * view_from_world;
    }
    const double half = random.number(1.0, 80.0);
    return glm::ortho(-half, half, -half, half, 1.0, 150.0) * view_from_world;
}

// How far a clip-space point lies inside each of the six sides of the view volume.
std::array<double, 6> margins(glm::dvec4 clip) {
    return {clip.w + clip.x, clip.w - clip.x, clip.w + clip.y,
            clip.w - clip.y, clip.z,          clip.w - clip.z};
}

// The largest margin of a box's corners, at the side where that is smallest.
double margin_by_corners(const glm::dmat4& clip_from_world, const Box& box) {
    std::array<double, 6> best{};
    best.fill(-endless);
    for (const glm::dvec3& corner : corners(box)) {
        const auto of_corner = margins(clip_from_world * glm::dvec4(corner, 1.0));
        for (std::size_t side = 0; side < 6; ++side) {
            best[side] = std::max(best[side], of_corner[side]);
        }
    }
    return *std::min_element(best.begin(), best.end());
}

TEST(SplitPoint, KeepsTwiceTheDigitsOfAFloatInEachCoordinate) {
    Random random;
    for (int i = 0; i < 10000; ++i) {
        const double reach = std::pow(10.0, random.number(-3.0, 9.0));
        const glm::dvec3 point = random.point(reach);
        const SplitPoint split = split_into_floats(point);
        for (int axis = 0; axis < 3; ++axis) {
            const double sum =
                static_cast<double>(split.rounded[axis]) + static_cast<double>(split.rest[axis]);
            // Half a step of the rest, which is at most half a step of the float: 2^-24 each.
            ASSERT_LE(std::abs(sum - point[axis]), std::ldexp(std::abs(point[axis]), -48));
        }
    }
}

TEST(Box, IsEmptyUntilSomethingIsAdded) {
    Box box;
    EXPECT_TRUE(box.empty());
    box.add(Box{});
    EXPECT_TRUE(box.empty());
    box.add(glm::dvec3(1.0, 2.0, 3.0));
    EXPECT_FALSE(box.empty());
    EXPECT_EQ(box.size(), glm::dvec3(0.0));
    EXPECT_EQ(box.center(), glm::dvec3(1.0, 2.0, 3.0));
}

TEST(Box, HoldsAllThatWasAddedAndNoMore) {
    Random random;
    Box box;
    Box of_boxes;
    glm::dvec3 low(endless);
    glm::dvec3 high(-endless);
    for (int i = 0; i < 1000; ++i) {
        const Box added = random.box(10.0, 3.0);
        box.add(added.low);
        box.add(added.high);
        of_boxes.add(added);
        low = glm::min(low, added.low);
        high = glm::max(high, added.high);
    }
    EXPECT_EQ(box.low, low);
    EXPECT_EQ(box.high, high);
    EXPECT_EQ(of_boxes.low, low);
    EXPECT_EQ(of_boxes.high, high);
}

TEST(Box, TransformedHoldsEveryMovedPointAndTouchesTheOutermost) {
    Random random;
    for (int i = 0; i < 2000; ++i) {
        glm::dmat4 moved(1.0);
        moved = glm::rotate(moved, random.number(-3.0, 3.0), random.point(1.0) + 2.0);
        moved = glm::scale(moved, random.point(3.0));
        moved[3] = glm::dvec4(random.point(50.0), 1.0);
        const Box box = random.box(10.0, 5.0);
        const Box around = transformed(moved, box);
        Box exact;
        for (const glm::dvec3& corner : corners(box)) {
            exact.add(glm::dvec3(moved * glm::dvec4(corner, 1.0)));
        }
        EXPECT_EQ(around.low, exact.low);
        EXPECT_EQ(around.high, exact.high);
        const glm::dvec4 inside(random.point_in(box), 1.0);
        EXPECT_TRUE(holds(around, glm::dvec3(moved * inside), 1e-9));
    }
}

TEST(Box, TransformedEmptyStaysEmpty) {
    EXPECT_TRUE(transformed(glm::dmat4(2.0), Box{}).empty());
}

TEST(MaxStretch, NoVectorIsStretchedMore) {
    Random random;
    for (int i = 0; i < 2000; ++i) {
        const glm::dmat3 map(random.point(1.0), random.point(10.0), random.point(0.1));
        const double most = max_stretch(map);
        for (int j = 0; j < 20; ++j) {
            const glm::dvec3 v = random.point(1.0);
            ASSERT_LE(glm::length(map * v), (1.0 + 1e-12) * most * glm::length(v));
        }
    }
}

TEST(MaxStretch, IsTheLargestScaleBeforeOrAfterATurn) {
    Random random;
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 scale = random.point(3.0);
        const double largest = std::max({std::abs(scale.x), std::abs(scale.y), std::abs(scale.z)});
        const glm::dmat3 turn(
            glm::rotate(glm::dmat4(1.0), random.number(-3.0, 3.0), random.point(1.0) + 2.0));
        const glm::dmat3 scaled(glm::scale(glm::dmat4(1.0), scale));
        ASSERT_NEAR(max_stretch(turn * scaled), largest, 1e-9 * largest);
        ASSERT_NEAR(max_stretch(scaled * turn), largest, 1e-9 * largest);
    }
}

TEST(RayBox, HitsWhatItIsAimedAtAndIsInsideJustThere) {
    Random random;
    for (int i = 0; i < 20000; ++i) {
        const Box box = random.box(10.0, 5.0);
        const glm::dvec3 target = random.point_in(box);
        const glm::dvec3 origin = random.point(30.0);
        const Ray ray{origin, (target - origin) * random.number(0.01, 10.0)};
        const auto range = intersect(ray, box);
        ASSERT_TRUE(range.has_value());
        EXPECT_GE(range->begin, 0.0);
        EXPECT_TRUE(holds(box, ray.at(range->begin), 1e-9));
        EXPECT_TRUE(holds(box, ray.at(range->end), 1e-9));
        const double length = range->end - range->begin;
        EXPECT_FALSE(holds(box, ray.at(range->end + 0.01 * length + 1e-6), 0.0));
        if (range->begin > 0.0) {
            EXPECT_FALSE(holds(box, ray.at(range->begin - 0.01 * length - 1e-6), 0.0));
        }
    }
}

TEST(RayBox, NoPointOfAMissingRayIsInside) {
    Random random;
    int missed = 0;
    for (int i = 0; i < 5000; ++i) {
        const Box box = random.box(10.0, 5.0);
        const Ray ray{random.point(20.0), glm::normalize(random.point(1.0))};
        if (intersect(ray, box)) {
            continue;
        }
        ++missed;
        for (int step = 0; step < 500; ++step) {
            ASSERT_FALSE(holds(box, ray.at(0.1 * step), -1e-9));
        }
    }
    EXPECT_GT(missed, 1000);
}

TEST(RayBox, DirectionsAlongAnAxisAreExact) {
    const Box box{glm::dvec3(-1.0), glm::dvec3(1.0)};
    const auto down = intersect({{0.5, 0.5, 3.0}, {0.0, 0.0, -1.0}}, box);
    ASSERT_TRUE(down.has_value());
    EXPECT_EQ(down->begin, 2.0);
    EXPECT_EQ(down->end, 4.0);
    EXPECT_TRUE(intersect({{1.0, 1.0, 3.0}, {0.0, 0.0, -1.0}}, box)) << "along an edge";
    EXPECT_FALSE(intersect({{1.1, 0.0, 3.0}, {0.0, 0.0, -1.0}}, box));
    EXPECT_FALSE(intersect({{0.0, 0.0, 3.0}, {0.0, 0.0, 1.0}}, box)) << "behind";
}

TEST(RayBox, FromInsideBeginsAtZero) {
    const Box box{glm::dvec3(-1.0), glm::dvec3(1.0)};
    const auto range = intersect({glm::dvec3(0.0), {2.0, 0.0, 0.0}}, box);
    ASSERT_TRUE(range.has_value());
    EXPECT_EQ(range->begin, 0.0);
    EXPECT_EQ(range->end, 0.5);
}

TEST(RayBox, EmptyBoxIsNeverHit) {
    EXPECT_FALSE(intersect({glm::dvec3(0.0), {1.0, 2.0, 3.0}}, Box{}));
    EXPECT_FALSE(intersect({glm::dvec3(0.0), {0.0, 0.0, 1.0}}, Box{}));
}

TEST(Frustum, DropsJustTheBoxesWhoseCornersAreAllBeyondOneSide) {
    Random random;
    int seen = 0;
    int dropped = 0;
    for (int i = 0; i < 60000; ++i) {
        const glm::dmat4 clip_from_world = random_camera(random, i % 3);
        const Box box = random.box(150.0, 60.0);
        const double margin = margin_by_corners(clip_from_world, box);
        if (std::abs(margin) < 1e-9) {
            continue; // on the side itself, where rounding decides
        }
        EXPECT_EQ(Frustum(clip_from_world).may_see(box), margin > 0.0);
        ++(margin > 0.0 ? seen : dropped);
    }
    EXPECT_GT(seen, 5000);
    EXPECT_GT(dropped, 5000);
}

TEST(Frustum, NeverDropsABoxWithAVisiblePoint) {
    Random random;
    int visible = 0;
    for (int i = 0; i < 60000; ++i) {
        const glm::dmat4 clip_from_world = random_camera(random, i % 3);
        const Box box = random.box(150.0, 60.0);
        const auto inside = margins(clip_from_world * glm::dvec4(random.point_in(box), 1.0));
        if (*std::min_element(inside.begin(), inside.end()) > 0.0) {
            ++visible;
            EXPECT_TRUE(Frustum(clip_from_world).may_see(box));
        }
    }
    EXPECT_GT(visible, 1000);
}

TEST(Frustum, InfiniteFarPlaneSeesAMillionKilometres) {
    const Frustum frustum(infinite_perspective(1.0, 1.0, 0.1));
    EXPECT_TRUE(frustum.may_see({{-1.0, -1.0, -1e9 - 1.0}, {1.0, 1.0, -1e9}}));
    EXPECT_FALSE(frustum.may_see({{-1.0, -1.0, -0.05}, {1.0, 1.0, -0.01}})) << "before near";
    EXPECT_FALSE(frustum.may_see({{-1.0, -1.0, 1.0}, {1.0, 1.0, 2.0}})) << "behind";
}

TEST(Frustum, EmptyBoxIsNotSeen) {
    EXPECT_FALSE(Frustum(infinite_perspective(1.0, 1.0, 0.1)).may_see(Box{}));
}

} // namespace
} // namespace reljef
