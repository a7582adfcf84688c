#include "bench/claims/distance_suite.h"

#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/bench/bench_program.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

// A tower on a plain.
std::string tower() {
    std::string text = "ncols 33\nnrows 33\nxllcorner 0\nyllcorner 0\ncellsize 2\n";
    for (int row = 0; row < 33; ++row) {
        for (int col = 0; col < 33; ++col) {
            const bool is_tower = std::abs(row - 12) < 4 && std::abs(col - 16) < 4;
            text += is_tower ? "10 " : "0 ";
        }
        text += "\n";
    }
    return text;
}

DistanceOptions options_over(const std::string& terrain) {
    DistanceOptions options;
    options.suite.size = {96, 72};
    options.suite.context = session::BackendKind::osmesa;
    options.suite.quiet = true;
    options.terrains = {terrain};
    options.techniques = {{scene::Texture{}}, {scene::Exact{}}};
    options.distances = {100.0, 1000.0};
    return options;
}

TEST(DistanceSuite, AnErrorInPixelsShrinksAsTheEyeGoesAwayAndExactHasNone) {
    const test::TemporaryFolder folder;
    const auto results =
        run_distances(options_over(folder.write("tower.asc", tower()).string()), {});
    ASSERT_FALSE(results.end.stopped) << results.end.stopped->message;
    ASSERT_EQ(results.rows.size(), 4U);
    const auto rms = [&](std::size_t row) {
        return results.rows[row].error.reprojection_px->distribution.rms;
    };
    EXPECT_EQ(results.rows[2].label, "texture");
    EXPECT_EQ(results.rows[2].distance, 1000.0);
    // Ten times as far: a tenth, up to the perspective of 66 m of terrain and few pixels.
    EXPECT_LT(rms(2), 0.2 * rms(0));
    EXPECT_GT(rms(0), 1.0);
    EXPECT_LT(rms(1), 0.01);
    EXPECT_LT(rms(3), 0.01);
    const auto json = nlohmann::json::parse(figure_json(figure_table(results)));
    EXPECT_EQ(json["rows"][2]["at"], "1 km");
    EXPECT_EQ(json["rows"][0]["at"], "100 m");
    EXPECT_EQ(json["rows"][2]["distance_m"], 1000.0);
    EXPECT_TRUE(json["rows"][0]["error"]["wrong_percent"].is_number());
}

TEST(DistanceSuite, AnEyeBelowTheGroundIsOneSentenceAndOtherDistancesAreMeasured) {
    const test::TemporaryFolder folder;
    std::string wall = "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 100\n";
    wall += "0 0 0\n0 0 0\n900 900 900\n"; // south
    const auto results = run_distances(options_over(folder.write("wall.asc", wall).string()), {});
    ASSERT_TRUE(results.end.stopped);
    EXPECT_THAT(results.end.stopped->message,
                testing::HasSubstr("ground found 100 m from its middle"));
    ASSERT_EQ(results.rows.size(), 2U);
    EXPECT_EQ(results.rows[0].distance, 1000.0);
}

// From far away, a few samples are smaller than a pixel.
TEST(DistanceSuite, TerrainsOfFewSamplesLoseOnlyTheDistancesThatCannotBe) {
    const test::TemporaryFolder folder;
    const std::string head = "xllcorner 0\nyllcorner 0\ncellsize 10\n";
    DistanceOptions options = options_over(folder.write("tower.asc", tower()).string());
    options.techniques = {{scene::Exact{}}};
    options.distances = {20000.0, 100.0};
    for (const auto& [name, text] :
         {std::pair{"one.asc", "ncols 1\nnrows 1\n" + head + "1\n"},
          {"two.asc", "ncols 1\nnrows 2\n" + head + "1\n2\n"},
          {"four.asc", "ncols 2\nnrows 2\n" + head + "1 2\n3 4\n"},
          {"nine.asc", "ncols 3\nnrows 3\n" + head + "1 2 3\n4 5 6\n7 8 9\n"}}) {
        options.terrains.insert(options.terrains.begin(), folder.write(name, text).string());
    }
    const auto results = run_distances(options, {});
    ASSERT_TRUE(results.end.stopped);
    EXPECT_FALSE(results.end.failed);
    std::vector<std::string> scenes;
    for (const DistanceRow& row : results.rows) {
        EXPECT_EQ(row.distance, 100.0);
        scenes.push_back(row.scene);
    }
    EXPECT_THAT(scenes, testing::ElementsAre("nine.asc", "four.asc", "tower.asc"));
    for (const char* const part :
         {"one.asc: has 1×1 samples", "two.asc: has 1×2 samples",
          "nine.asc, from 20000 m: no pixel of terrain found", "tower.asc, from 20000 m"}) {
        EXPECT_THAT(results.end.stopped->message, testing::HasSubstr(part));
    }
}

TEST(DistanceSuite, RefusesWhatItDoesNotUse) {
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{"--pose", "low"}, {"--rounds", "5"}, {"--cold"}}) {
        std::vector<std::string> arguments{"tables", "--distances"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto run = test::reljef_bench(arguments);
        EXPECT_EQ(run.exit_code, 2) << more[0];
        EXPECT_THAT(run.err, testing::HasSubstr(more[0])) << run.err;
    }
}

} // namespace
} // namespace reljef::bench
