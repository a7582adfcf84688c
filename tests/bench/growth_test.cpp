#include "bench/growth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/growth_report.h"
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
