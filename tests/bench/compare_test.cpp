#include "bench/compare.h"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/report_json.h"
#include "tests/bench/bench_program.h"
#include "tests/bench/made_results.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A run whose polygons take `times` as long; the intervals are 10 % to either side.
Results slower(double times) {
    Results results = test::made_results();
    results.rows[1].timing = test::made_timing(8.0 * times, 4.0 * times);
    return results;
}

Verdict verdict_of_polygons(const Comparison& comparison, const std::string& figure) {
    for (const Change& change : comparison.changes) {
        if (change.figure == figure && change.row.find("polygons") != std::string::npos) {
            return change.verdict;
        }
    }
    ADD_FAILURE() << figure << " is not compared";
    return Verdict::same;
}

TEST(Compare, run_with_itself_is_the_same) {
    const Comparison comparison = compare(test::made_source_results(), test::made_source_results());
    EXPECT_EQ(comparison.regressions(), 0U);
    EXPECT_EQ(comparison.changes.size(), 6U); // time, error and wrong of two rows
    for (const Change& change : comparison.changes) {
        EXPECT_EQ(change.verdict, Verdict::same) << change.row;
    }
    EXPECT_THAT(comparison.only_a, IsEmpty());
    EXPECT_THAT(comparison.only_b, IsEmpty());
}

TEST(Compare, slower_is_worse_and_faster_is_better) {
    EXPECT_EQ(verdict_of_polygons(compare(slower(1.0), slower(1.5)), "median ms"), Verdict::worse);
    EXPECT_EQ(verdict_of_polygons(compare(slower(1.5), slower(1.0)), "median ms"), Verdict::better);
    EXPECT_EQ(compare(slower(1.0), slower(1.5)).regressions(), 1U);
    EXPECT_EQ(compare(slower(1.5), slower(1.0)).regressions(), 0U);
}

TEST(Compare, change_within_any_of_threshold_floors_and_intervals_is_none) {
    const auto verdict = [](const Results& b, double threshold) {
        return verdict_of_polygons(compare(slower(1.0), b, {threshold}), "median ms");
    };
    EXPECT_EQ(verdict(slower(1.3), 0.2), Verdict::worse);
    EXPECT_EQ(verdict(slower(1.3), 0.4), Verdict::same);  // the threshold
    EXPECT_EQ(verdict(slower(1.15), 0.1), Verdict::same); // the intervals overlap
    Results noisy = slower(1.3);
    noisy.rows[1].timing->noise_floor = 0.5;
    EXPECT_EQ(verdict(noisy, 0.1), Verdict::same); // the floor of one run
    EXPECT_EQ(verdict_of_polygons(compare(noisy, slower(1.0)), "median ms"), Verdict::same);
    Results sharp = slower(1.15);
    sharp.rows[1].timing->interval = {9.1, 9.3};
    EXPECT_EQ(verdict(sharp, 0.1), Verdict::worse);
}

TEST(Compare, errors_have_no_noise_but_rounding) {
    Results better = test::made_results();
    better.rows[1].error = test::made_error(0.20);
    EXPECT_EQ(verdict_of_polygons(compare(test::made_results(), better), "error px"),
              Verdict::better);
    EXPECT_EQ(verdict_of_polygons(compare(better, test::made_results()), "error px"),
              Verdict::worse);
    Results a = test::made_results();
    Results b = test::made_results();
    a.rows[1].error = test::made_error(0.0001);
    b.rows[1].error = test::made_error(0.0005);
    EXPECT_EQ(verdict_of_polygons(compare(a, b), "error px"), Verdict::same);
    b.rows[1].error->wrong_percent = 2.5;
    EXPECT_EQ(verdict_of_polygons(compare(a, b), "wrong %"), Verdict::worse);
}

TEST(Compare, error_that_lost_its_bound_is_worse) {
    Results unbounded = test::made_results();
    unbounded.rows[1].error->reprojection_px->unbounded = 1;
    Results absent = test::made_results();
    absent.rows[1].error->reprojection_px.reset();
    for (const Results& lost : {unbounded, absent}) {
        EXPECT_EQ(verdict_of_polygons(compare(test::made_results(), lost), "error px"),
                  Verdict::worse);
        EXPECT_EQ(verdict_of_polygons(compare(lost, test::made_results()), "error px"),
                  Verdict::better);
        EXPECT_EQ(verdict_of_polygons(compare(lost, lost), "error px"), Verdict::same);
    }
}

TEST(Compare, other_machines_are_compared_by_ratios_alone) {
    Results other = test::made_results();
    other.environment.cpu = "another processor";
    for (Row& row : other.rows) { // everything takes three times as long
        row.timing = test::made_timing(3.0 * row.timing->ms.median, row.timing->ratio_to_texture);
    }
    const Comparison comparison = compare(test::made_results(), other);
    EXPECT_FALSE(comparison.same_environment);
    EXPECT_EQ(comparison.regressions(), 0U);
    EXPECT_EQ(verdict_of_polygons(comparison, "ratio to texture"), Verdict::same);
    EXPECT_THAT(comparison_report(comparison), HasSubstr("environments differ"));
    other.rows[1].timing->ratio_to_texture = 6.0;
    EXPECT_EQ(verdict_of_polygons(compare(test::made_results(), other), "ratio to texture"),
              Verdict::worse);
}

TEST(Compare, another_commit_is_the_same_machine) {
    Results other = test::made_results();
    other.environment.commit = "fedcba987654";
    EXPECT_TRUE(compare(test::made_results(), other).same_environment);
}

TEST(Compare, rows_in_only_one_run_are_named) {
    Results fewer = test::made_results();
    fewer.rows.erase(fewer.rows.begin() + 1);
    const Comparison comparison = compare(test::made_results(), fewer);
    EXPECT_THAT(comparison.only_a, ElementsAre(HasSubstr("polygons:lods=1")));
    EXPECT_THAT(comparison.only_b, IsEmpty());
    EXPECT_THAT(comparison_report(comparison), HasSubstr("only in the first:\n  tables, natural"));
    EXPECT_THAT(compare(fewer, test::made_results()).only_b,
                ElementsAre(HasSubstr("polygons:lods=1")));
}

TEST(Compare, row_of_another_scene_pose_test_or_size_is_another) {
    const auto is_another = [](auto change) {
        Results other = test::made_results();
        change(other.rows[1]);
        return compare(test::made_results(), other).only_a.size() == 1;
    };
    EXPECT_TRUE(is_another([](Row& row) { row.suite = "pareto"; }));
    EXPECT_TRUE(is_another([](Row& row) { row.test = "relief-4"; }));
    EXPECT_TRUE(is_another([](Row& row) { row.scene = "urban"; }));
    EXPECT_TRUE(is_another([](Row& row) { row.pose = scene::Pose::low; }));
    EXPECT_TRUE(is_another([](Row& row) { row.setting.label = "polygons:lods=3"; }));
    EXPECT_TRUE(is_another([](Row& row) { row.size = {64, 48}; }));
}

// Whatever the figures: what is worse one way is better the other way.
TEST(Compare, is_symmetric) {
    std::mt19937 random(1);
    std::lognormal_distribution<double> factor(0.0, 0.4);
    for (int i = 0; i < 3000; ++i) {
        Results a = slower(factor(random));
        Results b = slower(factor(random));
        a.rows[1].error = test::made_error(factor(random));
        b.rows[1].error = test::made_error(factor(random));
        a.rows[1].timing->noise_floor = 0.1 * factor(random);
        const Comparison there = compare(a, b);
        const Comparison back = compare(b, a);
        ASSERT_EQ(there.changes.size(), back.changes.size());
        for (std::size_t k = 0; k < there.changes.size(); ++k) {
            const Verdict verdict = there.changes[k].verdict;
            const Verdict expected = verdict == Verdict::same     ? Verdict::same
                                     : verdict == Verdict::better ? Verdict::worse
                                                                  : Verdict::better;
            ASSERT_EQ(back.changes[k].verdict, expected);
        }
    }
}

class CompareProgram : public testing::Test {
protected:
    std::string file(const std::string& name, const Results& results) {
        return folder_.write(name, json_report(results)).string();
    }

    test::TemporaryFolder folder_;
};

TEST_F(CompareProgram, regression_is_status_1_and_one_line) {
    const auto a = file("a.json", slower(1.0));
    const auto b = file("b.json", slower(1.5));
    const auto worse = test::reljef_bench({"compare", a, b});
    EXPECT_EQ(worse.exit_code, 1);
    EXPECT_THAT(worse.out, HasSubstr("worse:\n  tables, natural, overview, polygons:lods=1, "
                                     "1024x768: median ms 8 -> 12 (+50.0 %)\n"));
    EXPECT_EQ(worse.err, "reljef-bench: " + b + ": 1 figure worse than in " + a + "\n");
    const auto better = test::reljef_bench({"compare", b, a});
    EXPECT_EQ(better.exit_code, 0) << better.err;
    EXPECT_THAT(better.out, HasSubstr("better:\n"));
    EXPECT_EQ(test::reljef_bench({"compare", a, b, "--threshold", "60"}).exit_code, 0);
}

TEST_F(CompareProgram, bad_input_is_one_sentence) {
    const auto good = file("good.json", test::made_results());
    const std::string text = json_report(test::made_results());
    const auto half = folder_.write("half.json", text.substr(0, text.size() / 2)).string();
    const auto expect_failure = [&](const std::string& bad, const std::string& part) {
        const auto result = test::reljef_bench({"compare", good, bad});
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_EQ(result.out, "");
        EXPECT_THAT(result.err, testing::StartsWith("reljef-bench: " + bad));
        EXPECT_THAT(result.err, HasSubstr(part));
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1);
    };
    expect_failure(half, "end is missing");
    expect_failure("/none/b.json", "cannot be read");
    expect_failure(folder_.path().string(), "folder");
    expect_failure(folder_.write("c.json", R"({"schema": "other/2"})").string(), "reljef-bench/1");
    expect_failure(folder_.write("d.txt", "hello").string(), "no JSON");
}

TEST_F(CompareProgram, runs_without_a_common_row_cannot_be_compared) {
    const auto a = file("a.json", test::made_results("natural"));
    const auto b = file("b.json", test::made_results("urban"));
    const auto result = test::reljef_bench({"compare", a, b});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("no row found in both"));
}

} // namespace
} // namespace reljef::bench
