#include "engine/cast/height_bounds.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/terrain/chance.h"

namespace reljef::cast {
namespace {

Box random_box(test::Chance& chance, double beyond, double widest) {
    Box box;
    box.low = {chance.between(-beyond, 100.0 + beyond), chance.between(-beyond, 50.0 + beyond),
               chance.between(-500.0, 500.0)};
    box.high = box.low + glm::dvec3(chance.between(0.0, widest), chance.between(0.0, widest),
                                    chance.between(0.0, 300.0));
    return box;
}

bool meet(const Box& a, const Box& b, double by) {
    return a.low.x + by <= b.high.x && b.low.x <= a.high.x + by && a.low.y <= b.high.y &&
           b.low.y <= a.high.y;
}

// Those of all ground that a box meets are within.
void expect_all_within(double around, unsigned seed) {
    test::Chance chance(seed);
    Box samples;
    samples.add(glm::dvec3(0.0, 0.0, -1e3));
    samples.add(glm::dvec3(100.0, 50.0, 1e3));
    for (int round = 0; round < 300; ++round) {
        std::vector<Box> ground;
        for (int i = chance.whole(0, 20); i > 0; --i) {
            ground.push_back(random_box(chance, around > 0.0 ? 3.0 * around : 0.0, 20.0));
        }
        const HeightBounds bounds(samples, ground, around);
        for (int i = 0; i < 20; ++i) {
            Box box = random_box(chance, 0.0, 60.0);
            box.high = glm::min(box.high, samples.high);
            const Interval found = bounds.within(box);
            for (const Box& part : ground) {
                const double last = around > 0.0 ? 8.0 : 0.0;
                for (double turn = -last; turn <= last; ++turn) {
                    Box moved = part;
                    moved.low.x += turn * around;
                    moved.high.x += turn * around;
                    if (meet(moved, box, 0.0)) {
                        EXPECT_LE(found.begin, part.low.z);
                        EXPECT_GE(found.end, part.high.z);
                    }
                }
            }
        }
    }
}

TEST(HeightBounds, AreThoseOfAllGroundInABox) {
    expect_all_within(0.0, 61);
}

TEST(HeightBounds, OfAGlobeAreThoseOfEachTurn) {
    expect_all_within(80.0, 62);
}

TEST(HeightBounds, AreNoneWhereNoGroundIs) {
    Box samples;
    samples.add(glm::dvec3(0.0));
    samples.add(glm::dvec3(64.0, 64.0, 10.0));
    Box ground;
    ground.add(glm::dvec3(10.0, 10.0, 2.0));
    ground.add(glm::dvec3(12.0, 12.0, 3.0));
    const HeightBounds bounds(samples, std::vector{ground}, 0.0);
    Box box;
    box.add(glm::dvec3(40.0, 40.0, 0.0));
    const Interval nothing = bounds.within(box);
    EXPECT_GT(nothing.begin, nothing.end);
    EXPECT_TRUE(std::isinf(HeightBounds().within(box).end));
}

} // namespace
} // namespace reljef::cast
