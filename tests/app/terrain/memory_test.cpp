#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/io/formats/raster_writer.h"
#include "tests/app/command_line.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_pattern.h"

namespace reljef::app {
namespace {

// Hills with a cliff in each block of 100 samples.
void fill_hills(int first_row, GridView<float> heights) {
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            const int at = first_row + row;
            heights(col, row) = static_cast<float>(
                200.0 * std::sin(0.01 * col) * std::cos(0.013 * at) +
                10.0 * std::sin(0.9 * col + 0.7 * at) + ((col / 50 + at / 50) % 2 == 0 ? 25 : 0));
        }
    }
}

// What the run needed beyond the program with another, small terrain, MB.
double megabytes_of(const std::vector<std::string>& arguments) {
    const auto result = test::run_program(RELJEF_BINARY, arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::string text = result.out + result.err;
    const auto found =
        test::matches(text, "memory: ([0-9.]+) MB of the process at most, ([0-9.]+) MB before");
    EXPECT_FALSE(found.empty()) << text;
    return found.empty() ? std::nan("") : std::stod(found[0][1]) - std::stod(found[0][2]);
}

class Memory : public testing::TestWithParam<std::vector<std::string>> {};

// The largest terrain that is read whole, and one that is streamed.
TEST_P(Memory, StaysWithinTheBudget) {
    RELJEF_RELEASE_ONLY("sanitizers need memory of their own");
    constexpr int side = 1801;
    const test::TemporaryFolder folder;
    const auto file = (folder.path() / "hills.tif").string();
    ASSERT_TRUE(io::write_heights(file, {side, side, 10.0, {400'000.0, 5e6}}, fill_hills));
    for (const int budget : {128, 64}) {
        std::vector<std::string> arguments{
            "render",    file,      "--memory", std::to_string(budget),
            "--size",    "640x480", "--stats",  "--quiet",
            "--context", "osmesa",  "-o",       (folder.path() / "picture.png").string()};
        arguments.insert(arguments.end(), GetParam().begin(), GetParam().end());
        EXPECT_LE(megabytes_of(arguments), 1.1 * budget) << budget;
    }
}

TEST(MemoryNote, TellsOfSamplesThatAreNotDrawn) {
    constexpr int side = 601;
    const test::TemporaryFolder folder;
    const auto file = (folder.path() / "hills.tif").string();
    ASSERT_TRUE(io::write_heights(file, {side, side, 10.0, {400'000.0, 5e6}}, fill_hills));
    const auto notes_with = [&](const char* megabytes) {
        const auto result =
            test::run_program(RELJEF_BINARY, {"render", file, "--technique", "polygons", "--memory",
                                              megabytes, "--size", "96x72", "--context", "osmesa",
                                              "-o", (folder.path() / "picture.png").string()});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.err;
    };
    const std::string told = "not every sample is drawn, and pixels are off by up to 0.5: "
                             "--memory 23 holds all triangles";
    EXPECT_NE(notes_with("22").find(told), std::string::npos);
    EXPECT_EQ(notes_with("23").find("not every sample"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    Techniques, Memory,
    testing::Values(
        std::vector<std::string>{"--technique", "texture"},
        std::vector<std::string>{"--technique", "polygons"},
        std::vector<std::string>{"--technique", "polygons:lods=3"},
        std::vector<std::string>{"--technique", "polygons:error=1"},
        std::vector<std::string>{"--technique", "polygons:error=1", "--placement", "plane"},
        std::vector<std::string>{"--technique", "exact", "--placement", "plane"},
        std::vector<std::string>{"--technique", "relief:shadow=hard", "--placement", "plane"}));

} // namespace
} // namespace reljef::app
