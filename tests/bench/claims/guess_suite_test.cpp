#include "bench/claims/guess_suite.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/bench/bench_program.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

constexpr int side = 64;

// A share of the height range, [0,1]: bumps that repeat every 16 samples.
double bump(int col, int row) {
    const double turn = 2.0 * 3.141592653589793 / 16.0;
    return 0.5 + 0.25 * (std::sin(turn * col) + std::sin(turn * row));
}

std::string heights_text() {
    std::string text = "ncols 64\nnrows 64\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            text += std::to_string(100.0 * bump(col, row)) + " ";
        }
        text += "\n";
    }
    return text;
}

// The heights as a grey picture; `sign` -1: dark is high, 0: no contrast.
std::string grey_picture(double sign) {
    std::string text = "P5\n64 64\n255\n";
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            text += static_cast<char>(std::lround(128.0 + sign * 200.0 * (bump(col, row) - 0.5)));
        }
    }
    return text;
}

class GuessSuite : public testing::Test {
protected:
    GuessResults guess(double sign) {
        folder_.write("heights.asc", heights_text());
        folder_.write("grey.pgm", grey_picture(sign));
        const auto scene = folder_.write("scene.toml", "name = \"bumps\"\n[terrain]\nheights = "
                                                       "\"heights.asc\"\nimagery = \"grey.pgm\"\n");
        return run_guesses(options_over(scene.string()), {});
    }

    static GuessOptions options_over(const std::string& terrain) {
        GuessOptions options;
        options.suite.size = {96, 72};
        options.suite.quiet = true;
        options.terrains = {terrain};
        return options;
    }

    test::TemporaryFolder folder_;
};

TEST_F(GuessSuite, GreyBumpsGiveTheirHeightsBack) {
    const GuessResults results = guess(1.0);
    ASSERT_FALSE(results.end.stopped) << results.end.stopped->message;
    ASSERT_EQ(results.rows.size(), 3U);
    const double flat = results.rows[0].reprojection.distribution.rms;
    EXPECT_EQ(results.rows[0].heights, "flat");
    EXPECT_GT(results.rows[1].correlation, 0.9);
    EXPECT_LT(results.rows[1].reprojection.distribution.rms, 0.7 * flat);
    EXPECT_LT(results.rows[2].reprojection.distribution.rms, 0.7 * flat);
    const auto json = nlohmann::json::parse(figure_json(figure_table(results)));
    EXPECT_EQ(json["rows"][1]["heights"], "guessed");
    EXPECT_EQ(json["rows"][1]["scene"], "bumps");
}

TEST_F(GuessSuite, AFitTurnsAroundWhatIsDarkAndHigh) {
    const GuessResults results = guess(-1.0);
    ASSERT_EQ(results.rows.size(), 3U);
    EXPECT_LT(results.rows[1].correlation, -0.9);
    EXPECT_GT(results.rows[1].reprojection.distribution.rms,
              results.rows[0].reprojection.distribution.rms);
    EXPECT_LT(results.rows[2].reprojection.distribution.rms,
              0.7 * results.rows[0].reprojection.distribution.rms);
}

TEST_F(GuessSuite, AFitToAPictureWithoutContrastIsFlat) {
    const GuessResults results = guess(0.0);
    ASSERT_EQ(results.rows.size(), 3U);
    EXPECT_EQ(results.rows[2].correlation, 0.0);
    EXPECT_EQ(results.rows[2].reprojection.distribution.rms,
              results.rows[0].reprojection.distribution.rms);
}

TEST_F(GuessSuite, ATerrainWithoutColoursIsOneSentence) {
    const GuessResults results =
        run_guesses(options_over(folder_.write("heights.asc", heights_text()).string()), {});
    ASSERT_TRUE(results.end.stopped);
    EXPECT_THAT(results.end.stopped->message, testing::HasSubstr("no colours found"));
    EXPECT_TRUE(results.end.failed);
}

TEST_F(GuessSuite, TerrainsOfFewSamplesCostTheOthersNothing) {
    ASSERT_EQ(guess(1.0).rows.size(), 3U);
    GuessOptions options = options_over((folder_.path() / "scene.toml").string());
    for (const auto& [name, size] : {std::pair{"one", "ncols 1\nnrows 1\n"},
                                     {"two", "ncols 1\nnrows 2\n"},
                                     {"four", "ncols 2\nnrows 2\n"},
                                     {"nine", "ncols 3\nnrows 3\n"}}) {
        std::string text = std::string(size) + "xllcorner 0\nyllcorner 0\ncellsize 10\n";
        for (int i = 0; i < 9; ++i) { // samples beyond the size are not read
            text += std::to_string(i % 4) + "\n";
        }
        folder_.write(std::string(name) + ".asc", text);
        const std::string scene = fmt::format("name = \"{0}\"\n[terrain]\nheights = \"{0}.asc\"\n"
                                              "imagery = \"grey.pgm\"\n",
                                              name);
        options.terrains.insert(options.terrains.begin(),
                                folder_.write(std::string(name) + ".toml", scene).string());
    }
    const GuessResults results = run_guesses(options, {});
    ASSERT_TRUE(results.end.stopped);
    EXPECT_FALSE(results.end.failed);
    EXPECT_THAT(results.end.stopped->message, testing::HasSubstr("one.asc: has 1×1 samples"));
    EXPECT_THAT(results.end.stopped->message, testing::HasSubstr("two.asc: has 1×2 samples"));
    ASSERT_EQ(results.rows.size(), 9U);
    EXPECT_EQ(results.rows[0].scene, "nine");
    EXPECT_EQ(results.rows[3].scene, "four");
    EXPECT_EQ(results.rows[6].scene, "bumps");
}

TEST_F(GuessSuite, RefusesWhatItDoesNotUse) {
    const auto with_technique =
        test::reljef_bench({"tables", "--guesses", "--technique", "relief"});
    EXPECT_EQ(with_technique.exit_code, 2);
    EXPECT_THAT(with_technique.err, testing::HasSubstr("--guesses: --technique found"));
    EXPECT_EQ(test::reljef_bench({"tables", "--guesses", "--distances"}).exit_code, 2);
}

} // namespace
} // namespace reljef::bench
