#include "bench/suites/growth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/suites/growth_report.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

class Growth : public testing::Test {
protected:
    void SetUp() override {
        options_.suite.size = {64, 48};
        options_.suite.context = platform::ContextKind::osmesa;
        options_.suite.quiet = true;
        options_.sides = {64, 700};
        options_.memory_megabytes = 16; // 700² samples take 19
        options_.folder = folder_.path();
    }

    test::TemporaryFolder folder_;
    GrowthOptions options_;
};

TEST_F(Growth, TheSameGroundIsSeenWholeAndTileByTile) {
    const GrowthResults results = run_growth(options_, {});
    ASSERT_FALSE(results.stopped) << results.stopped->message;
    ASSERT_EQ(results.rows.size(), 4U);
    EXPECT_FALSE(results.rows[0].streamed);
    EXPECT_TRUE(results.rows[2].streamed);
    for (const GrowthRow& row : results.rows) {
        EXPECT_GT(row.pixels, 20U);
        EXPECT_GT(row.tiles, 0);
        EXPECT_LE(row.first_picture, row.last_picture);
        EXPECT_GT(row.memory_bytes, std::size_t{1} << 20U);
        EXPECT_LE(row.worst_px, row.streamed ? 8.0 : 1.0) << row.side;
    }
    EXPECT_TRUE(folder_.names().empty());
    EXPECT_GT(marks_of(results)->frame_ratio, 0.0);
    const auto report = nlohmann::json::parse(growth_json(results));
    EXPECT_EQ(report.at("schema"), "reljef-bench-growth/1");
    EXPECT_EQ(report.at("rows").at(3).at("pose"), "low");
    EXPECT_THAT(growth_markdown(results), testing::HasSubstr("| 700 | low | read |"));
}

// Ten times the time, the picture soon, and just the memory that there is.
GrowthResults made_growth() {
    GrowthResults results;
    results.options.sides = {64, 700};
    results.options.memory_megabytes = 16;
    for (const int side : results.options.sides) {
        for (const scene::Pose pose : {scene::Pose::overview, scene::Pose::low}) {
            GrowthRow row;
            row.side = side;
            row.pose = pose;
            row.ms.median = side == 64 ? 1.0 : 10.0;
            row.first_picture = 0.5;
            row.memory_bytes = std::size_t{16} << 20U;
            results.rows.push_back(row);
        }
    }
    return results;
}

TEST(GrowthMarks, WhatIsMissedIsSaidBesideIt) {
    GrowthResults results = made_growth();
    const std::string slow = growth_table(results);
    EXPECT_THAT(slow, testing::HasSubstr("10.00 times the frame (at most 1.3: missed)"));
    EXPECT_THAT(slow, testing::HasSubstr("0.50 s (at most 2: met)"));
    EXPECT_THAT(slow, testing::HasSubstr("16 MB (at most 16: met)"));
    const auto met = nlohmann::json::parse(growth_json(results)).at("marks").at("met");
    EXPECT_FALSE(met.at("frame_ratio"));
    EXPECT_TRUE(met.at("memory_bytes"));
    for (GrowthRow& row : results.rows) {
        row.ms.median = 1.0;
        row.first_picture = 2.5;
        row.memory_bytes += row.side == 700 ? 1 : 0;
    }
    const std::string late = growth_markdown(results);
    EXPECT_THAT(late, testing::HasSubstr("1.00 times the frame (at most 1.3: met)"));
    EXPECT_THAT(late, testing::HasSubstr("2.50 s (at most 2: missed)"));
    EXPECT_THAT(late, testing::HasSubstr("16 MB (at most 16: missed)"));
}

TEST_F(Growth, StoppedItLeavesNothing) {
    std::stop_source stop;
    options_.suite.progress = [&](double /*fraction*/) { stop.request_stop(); };
    const GrowthResults results = run_growth(options_, stop.get_token());
    ASSERT_TRUE(results.stopped);
    EXPECT_EQ(results.rows.size(), 1U);
    EXPECT_FALSE(marks_of(results));
    EXPECT_TRUE(folder_.names().empty());
}

TEST_F(Growth, AFolderThatIsNotThereIsTold) {
    options_.folder = folder_.path() / "none";
    const GrowthResults results = run_growth(options_, {});
    ASSERT_TRUE(results.failed);
    EXPECT_THAT(results.stopped->message, testing::HasSubstr("none"));
}

} // namespace
} // namespace reljef::bench
