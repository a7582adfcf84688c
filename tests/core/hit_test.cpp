#include "engine/core/hit.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace reljef {
namespace {

// Optimized code of g++ 12 lost the remainders once.
TEST(HitAt, KeepsPlacesInTwoFloats) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> anywhere(0.0, 60000.0);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec2 place(anywhere(random), anywhere(random));
        const Hit hit = hit_at(place, 7.5, 100.25);
        // Each float has 24 bits.
        ASSERT_LE(std::abs(hit.place().x - place.x), std::ldexp(place.x, -47));
        ASSERT_LE(std::abs(hit.place().y - place.y), std::ldexp(place.y, -47));
        ASSERT_EQ(hit.height, 7.5F);
        ASSERT_EQ(hit.depth, 100.25F);
    }
}

} // namespace
} // namespace reljef
