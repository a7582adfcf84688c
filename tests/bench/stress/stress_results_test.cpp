#include "bench/stress/stress_results.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/stress/stress_run.h"
#include "tests/support/temporary_folder.h"

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
    EXPECT_THAT(stress_text(results), HasSubstr("; not fixed yet"));
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
    EXPECT_EQ(json.at("suite"), "stress");
    EXPECT_EQ(json.at("summary").at("over"), 1);
    ASSERT_EQ(json.at("rows").size(), 3U);
    EXPECT_EQ(json["rows"][0]["value"], 2.5);
    EXPECT_EQ(json["rows"][0]["limit"], 3.0);
    EXPECT_EQ(json["rows"][0]["verdict"], "ok");
    EXPECT_TRUE(json["rows"][1]["value"].is_null());
    EXPECT_EQ(json["rows"][1]["verdict"], "OVER");
    EXPECT_TRUE(json["rows"][2]["limit"].is_null());
    EXPECT_EQ(json["rows"][2]["verdict"], "reported");
}

StressResults part_of(Shard shard, std::vector<StressRow> rows) {
    StressResults results;
    results.environment.cpu = "a processor";
    results.options.shard = shard;
    results.options.poses = 7;
    results.options.terrains = {"natural"};
    results.options.techniques = {scene::make_technique(scene::TechniqueId::exact)};
    results.rows = std::move(rows);
    return results;
}

StressRow row_by(const std::string& only, double value) {
    StressRow row = row_of(value, 3.0);
    row.only = only;
    return row;
}

TEST(StressReports, AreReadAsTheyWereWritten) {
    const test::TemporaryFolder folder;
    StressResults results = part_of({1, 2}, {row_by("scale", 2.5)});
    results.rows.push_back({.stress = "repeat",
                            .terrain = "natural",
                            .technique = "exact",
                            .figure = "holes",
                            .value = std::nan(""),
                            .at = "the pole",
                            .known = "a later version"});
    const std::string json = figure_json(figure_table(results));
    const auto read = read_stress_report(folder.write("s.json", json));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->options.shard, (Shard{1, 2}));
    EXPECT_EQ(figure_json(figure_table(*read)), json);
    EXPECT_EQ(stress_text(*read), stress_text(results));
}

TEST(StressReports, OfARunThatEndedEarlySaySo) {
    const test::TemporaryFolder folder;
    StressResults results = part_of({}, {row_by("scale", 1.0)});
    results.end.stopped = Error{"interrupted"};
    const auto file = folder.write("s.json", figure_json(figure_table(results)));
    const auto read = read_stress_report(file);
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_TRUE(read->end.stopped);
    EXPECT_EQ(read->end.stopped->message, "interrupted");
}

TEST(StressReports, DamageIsNamedWithItsPlace) {
    const test::TemporaryFolder folder;
    const std::string json = figure_json(figure_table(part_of({}, {row_by("scale", 1.0)})));
    for (const auto& [from, to, place] :
         {std::tuple("reljef-bench/1", "reljef-bench-stress/1", "schema"),
          {"\"suite\": \"stress\"", "\"suite\": \"peers\"", "suite"},
          {"\"value\": 1.0", "\"value\": \"1\"", "rows[0].value"},
          {"\"exact\"", "\"exactly\"", "settings.techniques"},
          {"1024x768", "1024", "settings.size"}}) {
        std::string damaged = json;
        ASSERT_NE(damaged.find(from), std::string::npos) << from;
        damaged.replace(damaged.find(from), std::string_view(from).size(), to);
        const auto read = read_stress_report(folder.write("s.json", damaged));
        ASSERT_FALSE(read) << place;
        EXPECT_THAT(read.error().message, HasSubstr(std::string("s.json: ") + place));
    }
}

TEST(StressParts, AreOneRunInTheOrderOfTheStresses) {
    const std::vector<std::string> order{"threads", "geodesy", "scale"};
    StressResults late = part_of({1, 2}, {row_by("geodesy", 2.0), row_by("geodesy", 1.0)});
    late.end.stopped = Error{"interrupted"};
    const auto all =
        merged({late, part_of({0, 2}, {row_by("threads", 5.0), row_by("scale", 3.0)})}, order);
    ASSERT_TRUE(all) << all.error().message;
    std::vector<double> values;
    for (const StressRow& row : all->rows) {
        values.push_back(row.value);
    }
    EXPECT_THAT(values, testing::ElementsAre(5.0, 2.0, 1.0, 3.0));
    EXPECT_TRUE(all->options.shard.is_whole());
    EXPECT_TRUE(all->end.stopped);
}

TEST(StressParts, OfOtherRunsAreRefused) {
    const std::vector<std::string> order{"scale"};
    const auto refusal = [&](StressResults second) {
        const auto all = merged({part_of({0, 2}, {}), std::move(second)}, order);
        return all ? "" : all.error().message;
    };
    EXPECT_EQ(refusal(part_of({1, 2}, {})), "");
    EXPECT_THAT(refusal(part_of({0, 2}, {})), HasSubstr("1/2 was expected"));
    StressResults other = part_of({1, 2}, {});
    other.options.seed = 9;
    EXPECT_THAT(refusal(other), HasSubstr("part 1/2 was measured with other options"));
    other = part_of({1, 2}, {});
    other.environment.cpu = "another one";
    EXPECT_THAT(refusal(other), HasSubstr("another environment"));
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
