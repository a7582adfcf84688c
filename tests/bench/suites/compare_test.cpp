#include "bench/suites/compare.h"

#include <functional>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "bench/report/report_json.h"
#include "tests/bench/bench_program.h"
#include "tests/bench/report/made_results.h"
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
    EXPECT_EQ(comparison.changes.size(), 21U); // a time and six errors of three rows
    EXPECT_THAT(comparison.untimed, IsEmpty());
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
    noisy.rows[1].timing.noise_floor = 0.5;
    EXPECT_EQ(verdict(noisy, 0.1), Verdict::same); // the floor of one run
    EXPECT_EQ(verdict_of_polygons(compare(noisy, slower(1.0)), "median ms"), Verdict::same);
    Results sharp = slower(1.15);
    sharp.rows[1].timing.interval = ConfidenceInterval{9.1, 9.3};
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

// The figures that a change of one row makes worse; the reverse change makes them better.
void expect_worse(const std::string& figure, const std::function<void(RowError&)>& change) {
    Results worse = test::made_results();
    change(*worse.rows[1].error);
    EXPECT_EQ(verdict_of_polygons(compare(test::made_results(), worse), figure), Verdict::worse);
    EXPECT_EQ(verdict_of_polygons(compare(worse, test::made_results()), figure), Verdict::better);
    EXPECT_EQ(verdict_of_polygons(compare(worse, worse), figure), Verdict::same);
    EXPECT_EQ(compare(test::made_results(), worse).regressions(), 1U) << figure;
}

TEST(Compare, every_error_that_grows_is_worse) {
    expect_worse("error px", [](RowError& e) { e.reprojection_px->distribution.rms = 0.3; });
    expect_worse("error px", [](RowError& e) { e.reprojection_px.reset(); });
    expect_worse("pixels without bound", [](RowError& e) { e.reprojection_px->unbounded = 1; });
    expect_worse("hit texels", [](RowError& e) { e.hit_texels->distribution.rms = 0.3; });
    expect_worse("hit texels", [](RowError& e) { e.hit_texels.reset(); });
    expect_worse("wrong %", [](RowError& e) { e.wrong_percent = 1.5; });
    expect_worse("holes", [](RowError& e) { e.holes = 300; });
    expect_worse("FLIP", [](RowError& e) { e.flip = 0.025; });
}

// At 1024 x 768 pixels; each error grows many times.
TEST(Compare, what_rounding_can_do_to_an_error_is_no_change) {
    Results a = test::made_results();
    RowError& before = *a.rows[1].error;
    before.reprojection_px->distribution.rms = before.hit_texels->distribution.rms = 1e-5;
    before.wrong_percent = 0.0;
    before.holes = 0;
    before.flip = 1e-5;
    Results b = a;
    RowError& after = *b.rows[1].error;
    after.reprojection_px->distribution.rms = after.hit_texels->distribution.rms = 9e-4;
    after.wrong_percent = 0.009;
    after.holes = 78;
    after.flip = 0.0019;
    EXPECT_EQ(compare(a, b).regressions(), 0U);
    EXPECT_EQ(compare(b, a).regressions(), 0U);
}

TEST(Compare, error_that_is_no_longer_measured_is_worse) {
    Results without = test::made_results();
    without.rows[1].error.reset();
    EXPECT_EQ(verdict_of_polygons(compare(test::made_results(), without), "error px"),
              Verdict::worse);
    EXPECT_EQ(verdict_of_polygons(compare(without, test::made_results()), "error px"),
              Verdict::better);
    EXPECT_EQ(compare(without, without).regressions(), 0U);
}

TEST(Compare, few_frames_get_no_verdict_of_time_and_are_named) {
    Results few = slower(5.0);
    few.rows[1].timing.frames = 4;
    few.rows[1].timing.interval.reset();
    few.rows[1].timing.noise_floor.reset();
    for (const Comparison& comparison : {compare(slower(1.0), few), compare(few, slower(1.0))}) {
        EXPECT_EQ(comparison.regressions(), 0U);
        EXPECT_THAT(comparison.untimed, ElementsAre(HasSubstr("polygons:lods=1")));
        EXPECT_THAT(comparison_report(comparison),
                    HasSubstr("no verdict of time: under 5 frames, no noise floor or no ratio to "
                              "texture:\n  "
                              "tables, natural, overview, polygons"));
    }
}

TEST(Compare, a_moving_view_is_not_compared_with_a_still_one_in_silence) {
    Results still = test::made_results();
    still.settings = RunSettings{};
    Results moving = still;
    moving.settings->moving = true;
    EXPECT_THAT(compare(still, moving).notes,
                ElementsAre("Other settings: moving false in the first run, true in the second."));
    moving.settings = still.settings;
    moving.settings->rounds = 9;
    EXPECT_THAT(compare(still, moving).notes, IsEmpty());
}

TEST(Compare, absent_ratio_gets_no_verdict_between_machines) {
    Results other = slower(5.0);
    other.rows[1].timing.ratio_to_texture.reset();
    EXPECT_THAT(compare(slower(1.0), other).untimed, IsEmpty());
    other.environment.cpu = "another processor";
    EXPECT_THAT(compare(slower(1.0), other).untimed, ElementsAre(HasSubstr("polygons")));
}

// The ends of the ranges that read_json_report() accepts.
TEST(Compare, figures_at_the_ends_of_their_range_abort_nothing) {
    const std::vector<double> ends{1e-9, 1.0, 1e9};
    for (const double median : ends) {
        for (const double ratio : ends) {
            for (const char* cpu : {"a processor", "another"}) {
                Results other = test::made_results();
                other.environment.cpu = cpu;
                other.rows[1].timing = test::made_timing(median, ratio);
                other.rows[1].timing.interval = ConfidenceInterval{1e-9, 1e9};
                EXPECT_FALSE(comparison_report(compare(slower(1.0), other)).empty());
                EXPECT_FALSE(comparison_report(compare(other, slower(1.0))).empty());
            }
        }
    }
}

TEST(Compare, other_machines_are_compared_by_ratios_alone) {
    Results other = test::made_results();
    other.environment.cpu = "another processor";
    for (Row& row : other.rows) { // everything takes three times as long
        row.timing = test::made_timing(3.0 * row.timing.ms.median, *row.timing.ratio_to_texture);
    }
    const Comparison comparison = compare(test::made_results(), other);
    EXPECT_FALSE(comparison.same_environment);
    EXPECT_EQ(comparison.regressions(), 0U);
    EXPECT_EQ(verdict_of_polygons(comparison, "ratio to texture"), Verdict::same);
    EXPECT_THAT(comparison_report(comparison), HasSubstr("environments differ"));
    other.rows[1].timing.ratio_to_texture = 6.0;
    EXPECT_EQ(verdict_of_polygons(compare(test::made_results(), other), "ratio to texture"),
              Verdict::worse);
}

TEST(Compare, run_that_is_not_complete_is_told) {
    Results stopped = test::made_results();
    stopped.stopped = Error{"interrupted"};
    EXPECT_THAT(comparison_report(compare(test::made_results(), stopped)),
                HasSubstr("The second run ended early: interrupted.\n"));
    Results short_of_time = test::made_results();
    short_of_time.left_out = {{"natural", scene::Pose::low, 7, {}}};
    EXPECT_THAT(comparison_report(compare(short_of_time, stopped)),
                HasSubstr("The first run left settings out"));
    EXPECT_THAT(compare(stopped, test::made_results()).notes,
                ElementsAre(HasSubstr("The first run")));
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
    EXPECT_EQ(comparison.regressions(), 1U); // it is gone
    EXPECT_EQ(compare(fewer, test::made_results()).regressions(), 0U);
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

// For random figures, a change that is worse in one direction is better in the other.
TEST(Compare, is_symmetric) {
    std::mt19937 random(1);
    std::lognormal_distribution<double> factor(0.0, 0.4);
    for (int i = 0; i < 3000; ++i) {
        Results a = slower(factor(random));
        Results b = slower(factor(random));
        a.rows[1].error = test::made_error(factor(random));
        b.rows[1].error = test::made_error(factor(random));
        a.rows[1].timing.noise_floor = 0.1 * factor(random);
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
    EXPECT_EQ(worse.err, "reljef-bench: " + b + ": 1 figure worse or gone, against " + a + "\n");
    const auto better = test::reljef_bench({"compare", b, a});
    EXPECT_EQ(better.exit_code, 0) << better.err;
    EXPECT_THAT(better.out, HasSubstr("better:\n"));
    EXPECT_EQ(test::reljef_bench({"compare", a, b, "--threshold", "60"}).exit_code, 0);
}

TEST_F(CompareProgram, row_that_is_gone_is_status_1_and_named) {
    Results fewer = test::made_results();
    fewer.rows.erase(fewer.rows.begin() + 1);
    const auto gone = test::reljef_bench(
        {"compare", file("a.json", test::made_results()), file("b.json", fewer)});
    EXPECT_EQ(gone.exit_code, 1);
    EXPECT_THAT(gone.out, HasSubstr("gone, only in the first:\n  tables, natural, overview, "
                                    "polygons:lods=1, 1024x768\n"));
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

TEST_F(CompareProgram, what_never_ends_is_no_file) {
    const std::string pipe = (folder_.path() / "pipe").string();
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const auto result = test::reljef_bench({"compare", pipe, file("a.json", slower(1.0))});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("is a device, a file was expected"));
}

TEST_F(CompareProgram, names_neither_forge_lines_nor_steer_the_terminal) {
    const auto a = file("a.json", test::made_results("x\n\x1b[31m"));
    const auto result = test::reljef_bench(
        {"compare", a, file("b.json", test::made_results("y"))}); // no common row
    EXPECT_EQ(result.out.find('\x1b'), result.out.npos);
    Results worse = test::made_results("x\n\x1b[31m");
    worse.rows[1].error->flip = 0.5;
    EXPECT_THAT(test::reljef_bench({"compare", a, file("c.json", worse)}).out,
                HasSubstr("x\\x0a\\x1b[31m, overview, polygons"));
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
