#include "bench/suites/error_bound.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/bench/bench_program.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

ErrorBoundOptions few_poses(const std::string& terrain) {
    ErrorBoundOptions options;
    options.suite.size = {64, 48};
    options.suite.context = session::BackendKind::osmesa;
    options.suite.quiet = true;
    options.terrains = {terrain};
    options.poses = 10;
    return options;
}

TEST(ErrorBound, checks_random_poses_and_two_flights_the_same_each_time) {
    RELJEF_RELEASE_ONLY("drawing and checking have tests of their own");
    const test::TemporaryFolder folder;
    const auto dem = folder.write("dem.asc", test::small_dem).string();
    const ErrorBoundResults results = run_error_bound(few_poses(dem), {});
    ASSERT_FALSE(results.end.stopped) << results.end.stopped->message;
    ASSERT_EQ(results.rows.size(), 3U);
    EXPECT_TRUE(results.within_bound());
    EXPECT_EQ(results.rows[0].views, "random");
    EXPECT_EQ(results.rows[0].frames, 10U);
    EXPECT_GT(results.rows[0].pixels, 100U);
    EXPECT_GT(results.rows[2].ms->median, 0.0);
    const ErrorBoundResults again = run_error_bound(few_poses(dem), {});
    EXPECT_EQ(again.rows[0].pixels, results.rows[0].pixels);
    EXPECT_EQ(again.rows[0].worst_px, results.rows[0].worst_px);
    const auto report = nlohmann::json::parse(figure_json(figure_table(results)));
    EXPECT_EQ(report.at("suite"), "lod-poses");
    EXPECT_EQ(report.at("rows").at(1).at("views"), "orbit");
}

TEST(ErrorBound, flights_are_checked_with_each_error_bound) {
    const test::TemporaryFolder folder;
    auto options = few_poses(folder.write("dem.asc", test::small_dem).string());
    options.poses = 1;
    options.flight_errors = {0.5, 4.0};
    const ErrorBoundResults results = run_error_bound(options, {});
    ASSERT_EQ(results.rows.size(), 5U);
    for (const std::size_t i : {1U, 3U}) {
        EXPECT_EQ(results.rows[i].error, 0.5);
        EXPECT_EQ(results.rows[i + 1].error, 4.0);
        EXPECT_EQ(results.rows[i + 1].views, results.rows[i].views);
        EXPECT_GE(*results.rows[i].triangles, *results.rows[i + 1].triangles);
        EXPECT_LE(results.rows[i].worst_px, 0.5);
    }
    const auto report = nlohmann::json::parse(figure_json(figure_table(results)));
    EXPECT_EQ(report.at("rows").at(2).at("max_error"), 4.0);
}

TEST(ErrorBound, a_pixel_too_far_off_is_a_violation) {
    ErrorBoundResults results;
    results.rows.emplace_back();
    EXPECT_TRUE(results.within_bound());
    results.rows.back().violations = 1;
    EXPECT_FALSE(results.within_bound());
    EXPECT_FALSE(figure_table(results).notes.empty());
}

TEST(ErrorBound, stops_when_it_is_asked_to) {
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
    const ErrorBoundResults results = run_error_bound(options, stop.get_token());
    ASSERT_TRUE(results.end.stopped);
    ASSERT_EQ(results.rows.size(), 1U);
    EXPECT_EQ(results.rows[0].frames, 4U);
    EXPECT_EQ(nlohmann::json::parse(figure_json(figure_table(results))).at("complete"), false);
}

} // namespace
} // namespace reljef::bench
