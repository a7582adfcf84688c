#include "bench/stress/stress_results.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/stress/stress_run.h"

namespace reljef::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

StressRow row_of(double value, std::optional<double> limit) {
    return {.stress = "scale", .figure = "pixels not finite", .value = value, .limit = limit};
}

TEST(StressResults, AFigureOverItsLimitFails) {
    StressResults results;
    results.add(row_of(0.0, 0.0));
    results.add(row_of(5.0, std::nullopt));
    EXPECT_EQ(results.failures(), 0U);
    results.add(row_of(1.0, 0.0));
    EXPECT_EQ(results.failures(), 1U);
    EXPECT_THAT(stress_text(results),
                HasSubstr("over their limits:\n  scale: 1 pixels not finite"));
}

TEST(StressResults, AFigureThatIsNoNumberIsOverAnyLimit) {
    EXPECT_EQ(verdict_of(row_of(std::nan(""), 1e9)), StressVerdict::over);
}

TEST(StressResults, AKnownFailureNamesTheWorkAndFailsNothing) {
    StressResults results;
    results.add({.stress = "standard pose",
                 .technique = "cone:relaxed=1",
                 .figure = "pixels of sky over ground",
                 .value = 9.0,
                 .limit = 0.0});
    EXPECT_EQ(results.failures(), 0U);
    EXPECT_EQ(verdict_of(results.rows[0]), StressVerdict::known);
    EXPECT_THAT(stress_text(results), HasSubstr("to be fixed by: one terrain"));
}

TEST(StressResults, TheSameHoleInAnotherTechniqueIsNotKnown) {
    StressResults results;
    results.add({.stress = "standard pose",
                 .technique = "exact",
                 .figure = "pixels of sky over ground",
                 .value = 9.0,
                 .limit = 0.0});
    EXPECT_EQ(results.failures(), 1U);
    EXPECT_THAT(stress_text(results), Not(HasSubstr("known:")));
}

TEST(StressResults, ReportsEveryRowWithLimitAndVerdict) {
    StressResults results;
    results.add(row_of(2.5, 3.0));
    results.add(row_of(std::nan(""), 0.0));
    results.add(row_of(7.0, std::nullopt));
    const auto json = nlohmann::json::parse(figure_json(figure_table(results)));
    EXPECT_EQ(json.at("schema"), "reljef-bench-stress/1");
    EXPECT_EQ(json.at("over"), 1);
    ASSERT_EQ(json.at("rows").size(), 3U);
    EXPECT_EQ(json["rows"][0]["value"], 2.5);
    EXPECT_EQ(json["rows"][0]["limit"], 3.0);
    EXPECT_EQ(json["rows"][0]["verdict"], "ok");
    EXPECT_TRUE(json["rows"][1]["value"].is_null());
    EXPECT_EQ(json["rows"][1]["verdict"], "OVER");
    EXPECT_TRUE(json["rows"][2]["limit"].is_null());
    EXPECT_EQ(json["rows"][2]["verdict"], "reported");
}

TEST(Worst, KeepsTheLargestValueAndANumberThatIsNone) {
    Worst worst;
    worst.add(1.0, "first");
    worst.add(3.0, "second");
    worst.add(2.0, "third");
    EXPECT_EQ(worst.value(), 3.0);
    EXPECT_EQ(worst.at(), "second");
    worst.add(std::nan(""), "fourth");
    worst.add(9.0, "fifth");
    EXPECT_TRUE(std::isnan(worst.value()));
    EXPECT_EQ(worst.at(), "fourth");
}

} // namespace
} // namespace reljef::bench
