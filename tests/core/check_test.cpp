#include "engine/core/check.h"

#include <climits>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

namespace reljef {
namespace {

TEST(Check, LetsWhatHoldsPass) {
    check(true, "never printed");
}

TEST(CheckDeathTest, AbortsInEveryBuildTypeAndSaysWhat) {
    EXPECT_EXIT(check(false, "the sky fell"), testing::KilledBySignal(SIGABRT),
                "reljef: broken precondition: the sky fell");
}

TEST(CheckedPointer, IsWhatThePointerPointsTo) {
    int number = 3;
    EXPECT_EQ(&checked_pointer(&number, "never printed"), &number);
}

TEST(CheckedPointerDeathTest, AbortsWhereThereIsNothing) {
    const int* const nothing = nullptr;
    EXPECT_EXIT(checked_pointer(nothing, "the sky fell"), testing::KilledBySignal(SIGABRT),
                "reljef: broken precondition: the sky fell");
}

TEST(CheckedInt, IsAbsentBeyondIntAndForNaN) {
    EXPECT_EQ(checked_int(2147483647.9), INT_MAX);
    EXPECT_EQ(checked_int(-2147483648.9), INT_MIN);
    EXPECT_EQ(checked_int(-0.9), 0);
    for (const double beyond :
         {2147483648.0, -2147483649.0, 1e300, -1e300, HUGE_VAL, -HUGE_VAL, std::nan("")}) {
        EXPECT_EQ(checked_int(beyond), std::nullopt) << beyond;
    }
}

TEST(ClampedInt, StaysWithinItsLimits) {
    EXPECT_EQ(clamped_int(6.9, 0, 7), 6);
    EXPECT_EQ(clamped_int(7.9, 0, 7), 7);
    EXPECT_EQ(clamped_int(1e300, INT_MIN, INT_MAX), INT_MAX);
    EXPECT_EQ(clamped_int(-HUGE_VAL, INT_MIN, INT_MAX), INT_MIN);
    EXPECT_EQ(clamped_int(std::nan(""), 3, 7), 3);
}

TEST(CheckedProduct, IsAbsentWhereItOverflows) {
    EXPECT_EQ(checked_product(SIZE_MAX / 3, 3), SIZE_MAX / 3 * 3);
    EXPECT_EQ(checked_product(SIZE_MAX / 3 + 1, 3), std::nullopt);
    EXPECT_EQ(checked_product(SIZE_MAX, 0), 0U);
}

} // namespace
} // namespace reljef
