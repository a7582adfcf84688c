#include "bench/suites/selection_suite.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/bench/bench_program.h"

namespace reljef::bench {
namespace {

TEST(SelectionSuite, SeesAllHalfAndNoneOfItsTiles) {
    SelectionOptions options;
    options.suite.quiet = true;
    options.copies = 4;
    options.rounds = 2;
    const SelectionResults results = run_selection(options, {});
    ASSERT_FALSE(results.end.stopped);
    ASSERT_EQ(results.rows.size(), 3U);
    EXPECT_EQ(results.rows[0].selected, results.rows[0].tiles);
    EXPECT_GT(results.rows[1].selected, 0U);
    EXPECT_LT(results.rows[1].selected, results.rows[1].tiles / 2);
    EXPECT_EQ(results.rows[2].selected, 0U);
    for (const SelectionRow& row : results.rows) {
        EXPECT_EQ(row.tiles, 4U * 13U * 13U);
        EXPECT_GT(row.ms.median, 0.0);
    }
    const auto json = nlohmann::json::parse(figure_json(figure_table(results)));
    EXPECT_TRUE(json["complete"].get<bool>());
    EXPECT_EQ(json["rows"].size(), 3U);
}

TEST(SelectionSuite, HasNoUseForATerrain) {
    EXPECT_EQ(test::reljef_bench({"lod", "--selection", "--terrain", "natural"}).exit_code, 2);
    EXPECT_EQ(test::reljef_bench({"lod", "--selection", "--growth"}).exit_code, 2);
}

} // namespace
} // namespace reljef::bench
