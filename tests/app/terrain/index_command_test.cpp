#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/command_line.h"
#include "tests/session/made_waves.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

/// An ASCII grid in degrees that does not fit one megabyte.
std::string write_dem(const test::TemporaryFolder& folder) {
    constexpr int side = 300;
    std::string text = "ncols 300\nnrows 300\nxllcorner 6\nyllcorner 45\ncellsize 0.001\n";
    for (int i = 0; i < side * side; ++i) {
        text += std::to_string((i * 37) % 101 + i / side) + (i % side == side - 1 ? "\n" : " ");
    }
    folder.write("dem.prj", "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,"
                            "298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\","
                            "0.0174532925199433]]");
    return folder.write("dem.asc", text).string();
}

class IndexCommand : public testing::Test {
protected:
    [[nodiscard]] test::ProgramResult index(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "index");
        test::ProgramOptions options;
        options.environment["XDG_CACHE_HOME"] = (folder_.path() / "cache").string();
        return test::reljef(arguments, options);
    }
    /// Draws with little memory.
    [[nodiscard]] test::ProgramResult drawn(std::vector<std::string> more,
                                            bool from_input = false) const {
        const std::string dem = folder_.path() / "waves.tif";
        std::vector<std::string> arguments{"render",    from_input ? "-" : dem,
                                           "-o",        folder_.path() / "a.png",
                                           "--size",    "64x48",
                                           "--context", "osmesa",
                                           "--memory",  "1"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        test::ProgramOptions options;
        options.environment["XDG_CACHE_HOME"] = (folder_.path() / "cache").string();
        options.input = from_input ? dem : "/dev/null";
        return test::reljef(arguments, options);
    }
    /// The same; whether an index is there afterwards.
    [[nodiscard]] bool render(std::vector<std::string> more, bool from_input = false) const {
        const auto result = drawn(std::move(more), from_input);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_NE(result.err.find("finer tiles are read"), std::string::npos) << result.err;
        std::error_code ignored;
        const std::filesystem::directory_iterator files(folder_.path() / "cache/reljef", ignored);
        return std::any_of(begin(files), end(files),
                           [](const auto& file) { return file.path().extension() == ".index"; });
    }
    test::TemporaryFolder folder_;
};

TEST_F(IndexCommand, StatesTilesBytesAndTheLargestErrorOfEachLevel) {
    const std::string dem = write_dem(folder_);
    const auto result = index({dem, "--memory", "1", "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto found = nlohmann::json::parse(result.out);
    ASSERT_EQ(found["levels"].size(), 4U);
    EXPECT_EQ(found["levels"][0]["tiles"], 25);
    EXPECT_EQ(found["levels"][0]["max_error_m"], 0.0);
    EXPECT_GT(found["levels"][1]["max_error_m"], 10.0);
    EXPECT_EQ(found["levels"][2]["unproven"], 0);
    EXPECT_TRUE(std::filesystem::exists(found["file"].get<std::string>()));
    const auto text = index({dem, "--memory", "1"});
    EXPECT_EQ(text.exit_code, 0) << text.err;
    EXPECT_NE(text.out.find("39 tiles, 0 unproven"), std::string::npos) << text.out;
}

TEST_F(IndexCommand, StatesNoErrorOfLevelsWithoutAProof) {
    const auto file = folder_.path() / "waves.tif";
    test::write_waves(file, 300, 300);
    std::string bytes = test::read_bytes(file);
    bytes.resize(bytes.size() - 100'000); // the last samples of the finest level
    const std::string damaged = folder_.write("damaged.tif", bytes).string();
    const auto text = index({damaged, "--memory", "1"});
    EXPECT_NE(text.out.find("unknown"), std::string::npos) << text.out << text.err;
    const auto found = nlohmann::json::parse(index({damaged, "--memory", "1", "--json"}).out);
    EXPECT_GT(found["levels"][0]["unproven"], 0);
    EXPECT_TRUE(found["levels"][0]["max_error_m"].is_null()) << found;
}

TEST_F(IndexCommand, SaysWhichTerrainsNeedNone) {
    EXPECT_EQ(index({write_dem(folder_)}).out, "dem.asc fits in --memory 512 and needs no index\n");
    EXPECT_EQ(index({"natural"}).out, "natural is generated in memory and needs no index\n");
}

TEST_F(IndexCommand, RenderMakesAnIndexOnlyForANamedBound) {
    test::write_waves(folder_.path() / "waves.tif", 300, 300);
    EXPECT_FALSE(render({}));
    EXPECT_FALSE(render({"--max-error", "none"}));
    EXPECT_FALSE(render({"--max-error", "2", "--no-index"}));
    EXPECT_FALSE(render({"--max-error", "2"}, true)) << "a copy of standard input";
    EXPECT_TRUE(render({"--max-error", "2"}));
}

TEST_F(IndexCommand, RefusesStandardInputAndWhatIsNoFolder) {
    test::expect_refusal(index({"-"}), 2, {"index: - found"});
    const std::string dem = write_dem(folder_);
    { const std::ofstream file(folder_.path() / "cache"); }
    test::expect_refusal(index({dem, "--memory", "1"}), 1, {"cache"});
}

// Else "kept error: 0.00 px" beside tiles with estimated errors looked like a proof of them.
TEST_F(IndexCommand, StatisticsSayWhichErrorsAreKept) {
    // Its void is proven, too.
    test::write_waves(folder_.path() / "waves.tif", 300, 300);
    const auto none = drawn({"--max-error", "2", "--no-index", "--stats"});
    EXPECT_NE(none.out.find("unproven: 1, kept error: not proven"), std::string::npos) << none.out;
    EXPECT_NE(none.err.find("'reljef index' proves them"), std::string::npos) << none.err;
    for (const char* const bound : {"1", "0.7", "0.5", "0.3", "0.1"}) {
        const auto frame = drawn({"--max-error", bound, "--stats"});
        EXPECT_EQ(frame.err.find("reljef index"), std::string::npos) << "it is made: " << frame.err;
        EXPECT_NE(frame.out.find("unproven: 0,"), std::string::npos) << frame.out;
        EXPECT_EQ(frame.out.find("proven\n"), std::string::npos) << frame.out;
    }
}

} // namespace
} // namespace reljef
