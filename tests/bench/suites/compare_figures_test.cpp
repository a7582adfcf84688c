#include "bench/suites/compare_figures.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/report/report_json.h"
#include "tests/bench/bench_program.h"
#include "tests/bench/report/made_figures.h"
#include "tests/bench/report/made_results.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::size_t ms_column = 2;
constexpr std::size_t noise_column = 3;
constexpr std::size_t error_column = 4;
constexpr std::size_t rate_column = 5;
constexpr std::size_t value_column = 6;

FigureTable with(std::size_t column, const FigureJson& value) {
    FigureTable table = test::made_figures();
    table.rows[0][column] = value;
    return table;
}

// The verdict of the first row; the reverse comparison has the opposite one.
Verdict verdict_of_first(const FigureTable& a, const FigureTable& b, const std::string& figure) {
    for (const Change& change : compare(a, b).changes) {
        if (change.row == "natural, ours" && change.figure == figure) {
            return change.verdict;
        }
    }
    ADD_FAILURE() << figure << " is not compared";
    return Verdict::same;
}

void expect_worse(std::size_t column, const FigureJson& value, const std::string& figure) {
    const FigureTable before = test::made_figures();
    const FigureTable after = with(column, value);
    EXPECT_EQ(verdict_of_first(before, after, figure), Verdict::worse) << figure << value;
    EXPECT_EQ(verdict_of_first(after, before, figure), Verdict::better) << figure << value;
    EXPECT_EQ(compare(before, after).regressions(), 1U) << figure << value;
    EXPECT_EQ(compare(after, before).regressions(), 0U) << figure << value;
}

TEST(CompareFigures, ATimeWithoutANoiseFloorGetsNoVerdict) {
    FigureTable before = test::made_figures();
    before.columns[ms_column].noise.clear();
    FigureTable after = before;
    after.rows[0][ms_column] = 1e6;
    const Comparison comparison = compare(before, after);
    EXPECT_EQ(comparison.regressions(), 0U);
    EXPECT_THAT(comparison.untimed, testing::Contains("natural, ours").Times(1));
    for (const Change& change : comparison.changes) {
        EXPECT_NE(change.figure, heading_text(before.columns[ms_column]));
    }
}

TEST(CompareFigures, ARunWithItselfIsTheSame) {
    const Comparison comparison = compare(test::made_figures(), test::made_figures());
    EXPECT_EQ(comparison.changes.size(), 11U); // four figures, and one error is missing
    EXPECT_EQ(comparison.regressions(), 0U);
    EXPECT_THAT(comparison.only_a, IsEmpty());
    EXPECT_THAT(comparison.untimed, IsEmpty());
    for (const Change& change : comparison.changes) {
        EXPECT_EQ(change.verdict, Verdict::same) << change.row;
    }
}

TEST(CompareFigures, LessAndMoreAreBetterAsTheColumnSays) {
    expect_worse(ms_column, 15.0, "median ms");
    expect_worse(error_column, 0.7, "error px");
    expect_worse(rate_column, 50, "rate");
    expect_worse(rate_column, nullptr, "rate");
}

TEST(CompareFigures, AMissingOrInfiniteFigureIsWorseThanAny) {
    expect_worse(error_column, nullptr, "error px");
    expect_worse(error_column, std::numeric_limits<double>::infinity(), "error px");
    const FigureTable none = with(error_column, nullptr);
    EXPECT_EQ(compare(none, none).changes.size(), 10U) << "neither has an error";
}

TEST(CompareFigures, ChangesWithinThresholdOrNoiseAreNone) {
    const auto verdict = [](const FigureTable& after, double threshold) {
        return compare(test::made_figures(), after, threshold).changes.front().verdict;
    };
    EXPECT_EQ(verdict(with(ms_column, 10.9), 0.10), Verdict::same);
    EXPECT_EQ(verdict(with(ms_column, 11.5), 0.10), Verdict::worse);
    EXPECT_EQ(verdict(with(ms_column, 11.5), 0.20), Verdict::same);
    FigureTable noisy = with(ms_column, 11.5);
    noisy.rows[0][noise_column] = 0.3;
    EXPECT_EQ(verdict(noisy, 0.10), Verdict::same);
    noisy.rows[0][noise_column] = nullptr; // too few frames
    EXPECT_THAT(compare(test::made_figures(), noisy).untimed, ElementsAre("natural, ours"));
}

TEST(CompareFigures, FiguresWithinTheirLimitAreTheSame) {
    EXPECT_EQ(compare(test::made_figures(), with(value_column, 2.9)).regressions(), 0U);
    expect_worse(value_column, 3.5, "value");
    expect_worse(value_column, nullptr, "value"); // no number
}

TEST(CompareFigures, RowsInOnlyOneRunAreNamed) {
    FigureTable fewer = test::made_figures();
    fewer.rows.erase(fewer.rows.begin() + 1);
    const Comparison comparison = compare(test::made_figures(), fewer);
    EXPECT_THAT(comparison.only_a, ElementsAre("natural, theirs, too"));
    EXPECT_EQ(comparison.regressions(), 1U);
    EXPECT_THAT(compare(fewer, test::made_figures()).only_b, ElementsAre("natural, theirs, too"));
}

TEST(CompareFigures, EqualNamesMatchInTheirOrder) {
    FigureTable before = test::made_figures();
    before.rows.push_back(before.rows[0]);
    before.rows.back()[ms_column] = 99.0;
    FigureTable after = before;
    after.rows.back()[ms_column] = 199.0;
    const Comparison comparison = compare(before, after);
    EXPECT_EQ(comparison.regressions(), 1U);
    EXPECT_THAT(comparison_report(comparison),
                HasSubstr("natural, ours (2): median ms 99 -> 199 (+101.0 %)"));
}

TEST(CompareFigures, TimesOfOtherMachinesAreNotCompared) {
    FigureTable other = with(ms_column, 99.0);
    other.environment.cpu = "another processor";
    const Comparison comparison = compare(test::made_figures(), other);
    EXPECT_EQ(comparison.regressions(), 0U);
    EXPECT_THAT(comparison.notes, ElementsAre(HasSubstr("environments differ")));
    other.rows[0][error_column] = 9.0;
    EXPECT_EQ(compare(test::made_figures(), other).regressions(), 1U);
}

TEST(CompareFigures, EachSettingThatDiffersIsTold) {
    FigureTable before = test::made_figures();
    before.settings = {{"max_error", 1.0}, {"size", "64x48"}};
    FigureTable after = before;
    EXPECT_THAT(compare(before, after).notes, IsEmpty());
    after.settings = {{"max_error", 2.0}, {"size", "64x48"}, {"memory_mb", 512}};
    EXPECT_THAT(compare(before, after).notes,
                ElementsAre(HasSubstr("max_error 1.0 in the first run, 2.0 in the second"),
                            HasSubstr("memory_mb none in the first run, 512 in the second")));
}

TEST(CompareFigures, ARunThatEndedEarlyIsTold) {
    FigureTable stopped = test::made_figures();
    stopped.end.stopped = Error{"interrupted"};
    EXPECT_THAT(compare(test::made_figures(), stopped).notes,
                ElementsAre("The second run ended early: interrupted."));
}

class CompareDocuments : public testing::Test {
protected:
    std::string file(const std::string& name, const FigureTable& table) {
        return folder_.write(name, figure_json(table)).string();
    }

    test::TemporaryFolder folder_;
};

TEST_F(CompareDocuments, WorseIsStatus1AndWritten) {
    const auto a = file("a.json", test::made_figures());
    const auto b = file("b.json", with(ms_column, 15.0));
    const std::string json = (folder_.path() / "c.json").string();
    const std::string page = (folder_.path() / "page").string();
    const auto worse = test::reljef_bench({"compare", a, b, "--json", json, "--html", page});
    EXPECT_EQ(worse.exit_code, 1);
    EXPECT_EQ(worse.err, "reljef-bench: " + b + ": 1 figure worse or gone, against " + a + "\n");
    EXPECT_THAT(worse.out, HasSubstr("worse:\n  natural, ours: median ms 10 -> 15 (+50.0 %)\n"));
    const auto report = nlohmann::json::parse(test::read_bytes(json));
    EXPECT_EQ(report.at("schema"), "reljef-bench/1");
    EXPECT_EQ(report.at("suite"), "compare");
    EXPECT_EQ(report.at("settings").at("suite"), "peers");
    EXPECT_EQ(report.at("summary").at("worse"), 1);
    const auto& row = report.at("rows").at(0);
    EXPECT_EQ(row.at("verdict"), "worse");
    EXPECT_EQ(row.at("row"), "natural, ours");
    EXPECT_EQ(row.at("figure"), "median ms");
    EXPECT_EQ(row.at("before"), 10.0);
    EXPECT_EQ(row.at("after"), 15.0);
    EXPECT_EQ(row.at("change_percent"), 50.0);
    EXPECT_THAT(test::read_bytes(folder_.path() / "page" / "index.html"), HasSubstr("<html"));
    EXPECT_EQ(test::reljef_bench({"compare", b, a}).exit_code, 0);
    EXPECT_EQ(test::reljef_bench({"compare", a, b, "--json", a}).exit_code, 2);
}

TEST_F(CompareDocuments, OfTechniquesAreWrittenToo) {
    const auto a = folder_.write("a.json", json_report(test::made_results())).string();
    const std::string json = (folder_.path() / "c.json").string();
    EXPECT_EQ(test::reljef_bench({"compare", a, a, "--json", json}).exit_code, 0);
    const auto report = nlohmann::json::parse(test::read_bytes(json));
    EXPECT_EQ(report.at("settings").at("suite"), "tables");
    EXPECT_EQ(report.at("summary").at("same"), report.at("rows").size());
}

TEST_F(CompareDocuments, OfOtherSuitesCannotBeCompared) {
    FigureTable flight = test::made_figures();
    flight.suite = "flight";
    const auto peers = file("a.json", test::made_figures());
    const auto tables = folder_.write("t.json", json_report(test::made_results())).string();
    for (const auto& [other, suite] :
         {std::pair(file("b.json", flight), "flight"), {tables, "tables"}}) {
        const auto result = test::reljef_bench({"compare", peers, other});
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(result.err, "reljef-bench: " + peers + " has results of peers, and " + other +
                                  " of " + suite + "; two of one suite were expected\n");
    }
}

// All errors in pixels would halve with the size.
TEST_F(CompareDocuments, OfOtherSizesCannotBeCompared) {
    FigureTable table = test::made_figures();
    table.settings = {{"size", "1024x768"}};
    const std::string before = file("a.json", table);
    table.settings = {{"size", "512x384"}};
    const std::string after = file("b.json", table);
    const auto run = test::reljef_bench({"compare", before, after});
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, HasSubstr("b.json: pictures of 512x384 found, 1024x768 as in"));
}

TEST_F(CompareDocuments, OfPartsAreReadAsOneRun) {
    FigureTable part = test::made_figures();
    part.shard = {0, 1};
    file("part-0.json", part);
    const auto a = file("a.json", test::made_figures());
    const auto result =
        test::reljef_bench({"compare", a, (folder_.path() / "part-%d.json").string()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("0 worse, 0 better, 11 the same"));
}

} // namespace
} // namespace reljef::bench
