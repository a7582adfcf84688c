#include "bench/suites/promise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/suites/promise_report.h"
#include "tests/bench/bench_program.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

PromiseOptions few_poses(const std::string& terrain) {
    PromiseOptions options;
    options.suite.size = {64, 48};
    options.suite.context = platform::ContextKind::osmesa;
    options.suite.quiet = true;
    options.terrains = {terrain};
    options.poses = 10;
    return options;
}

TEST(Promise, judges_random_poses_and_two_flights_the_same_each_time) {
    RELJEF_RELEASE_ONLY("drawing and judging have tests of their own");
    const test::TemporaryFolder folder;
    const auto dem = folder.write("dem.asc", test::small_dem).string();
    const PromiseResults results = run_promise(few_poses(dem), {});
    ASSERT_FALSE(results.stopped) << results.stopped->message;
    ASSERT_EQ(results.rows.size(), 3U);
    EXPECT_TRUE(results.kept());
    EXPECT_EQ(results.rows[0].views, "random");
    EXPECT_EQ(results.rows[0].frames, 10U);
    EXPECT_GT(results.rows[0].pixels, 100U);
    EXPECT_GT(results.rows[2].ms->median, 0.0);
    const PromiseResults again = run_promise(few_poses(dem), {});
    EXPECT_EQ(again.rows[0].pixels, results.rows[0].pixels);
    EXPECT_EQ(again.rows[0].worst_px, results.rows[0].worst_px);
    const auto report = nlohmann::json::parse(promise_json(results));
    EXPECT_EQ(report.at("schema"), "reljef-bench-promise/1");
    EXPECT_EQ(report.at("rows").at(1).at("views"), "orbit");
}

TEST(Promise, flights_are_judged_by_each_error_that_is_asked_for) {
    const test::TemporaryFolder folder;
    auto options = few_poses(folder.write("dem.asc", test::small_dem).string());
    options.poses = 1;
    options.flight_errors = {0.5, 4.0};
    const PromiseResults results = run_promise(options, {});
    ASSERT_EQ(results.rows.size(), 5U);
    for (const std::size_t i : {1U, 3U}) {
        EXPECT_EQ(results.rows[i].error, 0.5);
        EXPECT_EQ(results.rows[i + 1].error, 4.0);
        EXPECT_EQ(results.rows[i + 1].views, results.rows[i].views);
        EXPECT_GE(*results.rows[i].triangles, *results.rows[i + 1].triangles);
        EXPECT_LE(results.rows[i].worst_px, 0.5);
    }
    const auto report = nlohmann::json::parse(promise_json(results));
    EXPECT_EQ(report.at("rows").at(2).at("max_error"), 4.0);
}

TEST(Promise, a_pixel_too_far_off_is_a_violation) {
    PromiseResults results;
    results.rows.emplace_back();
    EXPECT_TRUE(results.kept());
    results.rows.back().violations = 1;
    EXPECT_FALSE(results.kept());
    EXPECT_FALSE(report(results, ""));
}

TEST(Promise, stops_when_it_is_asked_to) {
    const test::TemporaryFolder folder;
    const auto dem = folder.write("dem.asc", test::small_dem).string();
    std::stop_source stop;
    auto options = few_poses(dem);
    int told = 0;
    options.suite.progress = [&](double /*fraction*/) {
        if (++told == 4) {
            stop.request_stop();
        }
    };
    const PromiseResults results = run_promise(options, stop.get_token());
    ASSERT_TRUE(results.stopped);
    ASSERT_EQ(results.rows.size(), 1U);
    EXPECT_EQ(results.rows[0].frames, 4U);
    EXPECT_EQ(nlohmann::json::parse(promise_json(results)).at("complete"), false);
}

} // namespace
} // namespace reljef::bench
