#include "engine/terrain/mesh/upper_bound.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/terrain/chance.h"

namespace reljef::terrain {
namespace {

TEST(UpperBound, IsNeverBelowAndAtMostOnePartIn256Above) {
    test::Chance chance(1);
    for (int i = 0; i < 100'000; ++i) {
        const double value = std::exp2(chance.between(-126.0, 127.0));
        const double bound = UpperBound(value).value();
        ASSERT_GE(bound, value);
        ASSERT_LE(bound, value * (1.0 + 0x1p-8) * (1.0 + 0x1p-23)) << value;
    }
}

TEST(UpperBound, OfWhatItHoldsIsItself) {
    for (unsigned bits = 0; bits <= 0xff00; ++bits) {
        const auto bound = UpperBound::from_bits(static_cast<std::uint16_t>(bits));
        ASSERT_EQ(UpperBound(bound.value()), bound) << bits;
    }
}

TEST(UpperBound, KeepsOrder) {
    test::Chance chance(2);
    for (int i = 0; i < 100'000; ++i) {
        const double smaller = std::exp2(chance.between(-160.0, 160.0));
        const double larger = smaller * (1.0 + chance.between(0.0, 0.01));
        ASSERT_LE(UpperBound(smaller), UpperBound(larger)) << smaller;
    }
}

TEST(UpperBound, HoldsTheEndsOfItsRange) {
    EXPECT_EQ(UpperBound(0.0).value(), 0.0F);
    EXPECT_GT(UpperBound(1e-300).value(), 0.0F);
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(UpperBound(1e39).value(), infinity);
    EXPECT_EQ(UpperBound(infinity).value(), infinity);
    EXPECT_DEATH(UpperBound(-1.0), "not negative");
    EXPECT_DEATH(UpperBound(std::nan("")), "not negative");
}

} // namespace
} // namespace reljef::terrain
