#include "bench/suites/scaling.h"

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/suites/scaling_terrain.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

class Scaling : public testing::Test {
protected:
    void SetUp() override {
        options_.suite.size = {64, 48};
        options_.suite.context = session::BackendKind::osmesa;
        options_.suite.quiet = true;
        options_.sides = {64, 700};
        options_.memory_megabytes = 16; // 700² samples take 19
        options_.folder = folder_.path();
    }

    test::TemporaryFolder folder_;
    ScalingOptions options_;
};

TEST_F(Scaling, TheSameGroundIsSeenWholeAndTileByTile) {
    const ScalingResults results = run_scaling(options_, {});
    ASSERT_FALSE(results.end.stopped) << results.end.stopped->message;
    ASSERT_EQ(results.rows.size(), 4U);
    EXPECT_FALSE(results.rows[0].streamed);
    EXPECT_TRUE(results.rows[2].streamed);
    for (const ScalingRow& row : results.rows) {
        EXPECT_GT(row.pixels, 20U);
        EXPECT_GT(row.tiles, 0);
        EXPECT_LE(row.first_picture, row.last_picture);
        EXPECT_GT(row.memory_bytes, std::size_t{1} << 20U);
        EXPECT_LE(row.worst_px, row.streamed ? 8.0 : 1.0) << row.side;
    }
    EXPECT_TRUE(folder_.names().empty());
    const auto report = nlohmann::json::parse(figure_json(figure_table(results)));
    EXPECT_GT(report.at("summary").at("frame_ratio"), 0.0);
    EXPECT_EQ(report.at("suite"), "lod-growth");
    EXPECT_EQ(report.at("rows").at(3).at("pose"), "low");
    EXPECT_THAT(figure_markdown(figure_table(results)), testing::HasSubstr("| 700 | low | true |"));
}

// Ten times the frame time, an early first picture and exactly the memory budget.
ScalingResults made_scaling() {
    ScalingResults results;
    results.options.sides = {64, 700};
    results.options.memory_megabytes = 16;
    for (const int side : results.options.sides) {
        for (const scene::Pose pose : {scene::Pose::overview, scene::Pose::low}) {
            ScalingRow row;
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

TEST(ScalingMarks, WhatIsMissedIsSaidBesideIt) {
    ScalingResults results = made_scaling();
    const std::string slow = figure_text(figure_table(results));
    EXPECT_THAT(slow, testing::HasSubstr("10.00 times the frame time (at most 1.3: missed)"));
    EXPECT_THAT(slow, testing::HasSubstr("0.50 s (at most 2: met)"));
    EXPECT_THAT(slow, testing::HasSubstr("16 MiB (at most 16: met)"));
    const auto met =
        nlohmann::json::parse(figure_json(figure_table(results))).at("summary").at("met");
    EXPECT_FALSE(met.at("frame_ratio"));
    EXPECT_TRUE(met.at("memory_bytes"));
    for (ScalingRow& row : results.rows) {
        row.ms.median = 1.0;
        row.first_picture = 2.5;
        row.memory_bytes += row.side == 700 ? 1 : 0;
    }
    const std::string late = figure_markdown(figure_table(results));
    EXPECT_THAT(late, testing::HasSubstr("1.00 times the frame time (at most 1.3: met)"));
    EXPECT_THAT(late, testing::HasSubstr("2.50 s (at most 2: missed)"));
    EXPECT_THAT(late, testing::HasSubstr("16 MiB (at most 16: missed)"));
}

TEST_F(Scaling, StoppedItLeavesNothing) {
    std::stop_source stop;
    options_.suite.progress = [&](double /*fraction*/) { stop.request_stop(); };
    const ScalingResults results = run_scaling(options_, stop.get_token());
    ASSERT_TRUE(results.end.stopped);
    EXPECT_EQ(results.rows.size(), 1U);
    EXPECT_TRUE(figure_table(results).notes.empty());
    EXPECT_TRUE(folder_.names().empty());
}

TEST_F(Scaling, ItsFolderCannotBeGuessedOrReadByOthers) {
    const auto made = make_scaling_folder(folder_.path(), 64);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(std::filesystem::status(made->path()).permissions(),
              std::filesystem::perms::owner_all);
    EXPECT_EQ(made->path().filename().string().find(std::to_string(::getpid())), std::string::npos);
}

TEST_F(Scaling, AFolderThatIsNotThereIsTold) {
    options_.folder = folder_.path() / "none";
    const ScalingResults results = run_scaling(options_, {});
    ASSERT_TRUE(results.end.failed);
    EXPECT_THAT(results.end.stopped->message, testing::HasSubstr("none"));
}

} // namespace
} // namespace reljef::bench
