#include <algorithm>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/app/command_line.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef {
namespace {

constexpr const char* tile = "natural/srtm3/N45E006.hgt";

constexpr const char* track =
    "<gpx version=\"1.1\" creator=\"t\" xmlns=\"http://www.topografix.com/GPX/1/1\"><trk><trkseg>"
    "<trkpt lat=\"45.62\" lon=\"6.6\"><ele>4000</ele></trkpt>"
    "<trkpt lat=\"45.8\" lon=\"6.8\"><ele>5000</ele></trkpt></trkseg></trk></gpx>";

// The lines of all ```sh blocks, without their comments.
std::vector<std::string> shell_lines() {
    std::ifstream readme(RELJEF_README);
    std::vector<std::string> lines;
    bool inside = false;
    for (std::string line; std::getline(readme, line);) {
        if (line.rfind("```", 0) == 0) {
            inside = line == "```sh";
        } else if (inside) {
            const auto comment = line.find(" #");
            line.erase(std::min(comment, line.size()));
            lines.push_back(line.substr(0, line.find_last_not_of(' ') + 1));
        }
    }
    return lines;
}

int example_lines() {
    std::ifstream readme(RELJEF_README);
    int count = 0;
    bool inside = false;
    for (std::string line; std::getline(readme, line);) {
        if (line.rfind("```", 0) == 0) {
            inside = line == "```cpp";
        } else {
            count += inside ? 1 : 0;
        }
    }
    return count;
}

// The words as a shell takes them, some of them in quotes.
std::vector<std::string> shell_words_of(const std::string& line) {
    std::vector<std::string> words;
    std::istringstream rest(line);
    for (std::string word; rest >> std::quoted(word, '\'');) {
        words.push_back(word);
    }
    return words;
}

// A shell runs what it alone understands. All else is a fork of this program, which needs no
// linker.
test::ProgramResult run_line(const std::string& line, const test::ProgramOptions& options) {
    std::vector<std::string> words = shell_words_of(line);
    if (words.front() != "reljef" || line.find_first_of("|<>$*\"\\") != std::string::npos) {
        return test::run_program("/bin/sh", {"-c", line}, options);
    }
    words.erase(words.begin());
    return test::reljef(words, options);
}

TEST(Readme, first_two_commands_are_the_two_of_dev) {
    const auto lines = shell_lines();
    ASSERT_GE(lines.size(), 2U);
    EXPECT_EQ(lines[0], "./dev fly");
    EXPECT_EQ(lines[1], "./dev test");
}

TEST(Readme, example_has_at_most_30_lines_and_draws_a_picture) {
    EXPECT_LE(example_lines(), 30);
    RELJEF_NEED_DATA(tile);
    const test::TemporaryFolder folder;
    test::ProgramOptions options;
    options.folder = folder.path();
    const auto result =
        test::run_program(RELJEF_README_EXAMPLE, {test::data_path(tile).string()}, options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(io::read_image(folder.path() / "picture.png"));
}

TEST(Readme, every_command_works) {
    RELJEF_RELEASE_ONLY("each verb has tests of its own");
    RELJEF_NEED_DATA(tile);
    const test::TemporaryFolder folder;
    std::filesystem::create_symlink(test::data_path(tile), folder.path() / "N45E006.hgt");
    std::filesystem::create_directory(folder.path() / "srtm");
    std::filesystem::create_symlink(test::data_path(tile), folder.path() / "srtm" / "N45E006.hgt");
    folder.write("track.gpx", track);
    folder.write("places.csv", "45.8326,6.8652\n");
    test::ProgramOptions options;
    options.folder = folder.path();
    options.environment["XDG_CACHE_HOME"] = (folder.path() / "cache").string();
    const std::string binaries = std::filesystem::path(RELJEF_BINARY).parent_path().string();
    options.environment["PATH"] = binaries + ":/usr/bin:/bin";
    int commands = 0;
    for (std::string line : shell_lines()) {
        if (line.rfind("reljef", 0) != 0 && line.rfind("gdal_translate", 0) != 0) {
            continue;
        }
        const bool is_view = line.rfind("reljef view ", 0) == 0;
        if (is_view && !test::has_display()) {
            continue;
        }
        line += is_view ? " --frames 1 --size 320x240" : "";
        if (line.rfind("reljef render", 0) == 0 && line.find(" --size ") == std::string::npos) {
            line += " --size 160x120"; // what it draws is tested elsewhere
        }
        if (line.rfind("reljef-bench tables", 0) == 0) {
            line += " --size 160x120 --rounds 2 --technique polygons --technique relief";
        }
        const auto result = run_line(line, options);
        EXPECT_EQ(result.exit_code, 0) << line << '\n' << result.err;
        ++commands;
    }
    EXPECT_GE(commands, 10);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "frames" / "0007.png"));
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "flight.mp4"));
}

} // namespace
} // namespace reljef
