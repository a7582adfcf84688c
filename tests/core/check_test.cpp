#include "engine/core/check.h"

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

} // namespace
} // namespace reljef
