#include "bench/claims/distance_suite.h"

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

TEST(DistanceSuite, AnEyeBelowTheGroundIsOneSentence) {
    const test::TemporaryFolder folder;
    std::string wall = "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 100\n";
    wall += "0 0 0\n0 0 0\n900 900 900\n"; // south
    const auto results = run_distances(options_over(folder.write("wall.asc", wall).string()), {});
    ASSERT_TRUE(results.end.stopped);
    EXPECT_THAT(results.end.stopped->message,
                testing::HasSubstr("ground found 100 m from its middle"));
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
