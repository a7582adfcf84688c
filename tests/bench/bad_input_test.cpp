#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bench/bench_program.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

// One line on stderr that begins with the program's name and holds each of `parts`; no table.
void expect_refusal(const test::ProgramResult& result, int exit_code,
                    const std::vector<std::string>& parts) {
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err.rfind("reljef-bench: ", 0), 0U) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    for (const std::string& part : parts) {
        EXPECT_THAT(result.err, testing::HasSubstr(part));
    }
}

struct Misuse {
    std::vector<std::string> arguments;
    std::vector<std::string> parts;
};

class BenchMisused : public testing::TestWithParam<Misuse> {};

TEST_P(BenchMisused, is_one_line_and_status_2) {
    expect_refusal(test::reljef_bench(GetParam().arguments), 2, GetParam().parts);
}

INSTANTIATE_TEST_SUITE_P(
    Arguments, BenchMisused,
    testing::Values(Misuse{{}, {"suite", "tables"}}, //
                    Misuse{{"levels"}, {"levels", "tables", "pareto", "compare"}},
                    Misuse{{"strain", "--quick"}, {"strain", "tables"}},
                    Misuse{{"tables", "--technique", "magic"}, {"magic", "texture"}},
                    Misuse{{"tables", "--technique", "polygons:lods=0"}, {"lods=0"}},
                    Misuse{{"tables", "--technique", "displacement"},
                           {"--technique: displacement", "shows nothing of natural, urban"}},
                    Misuse{{"pareto", "--terrain", "gallery", "--technique", "polygons"},
                           {"--technique: polygons:lods=1", "shows nothing of gallery"}},
                    Misuse{{"tables", "--terrain", "gallery", "--technique", "auto"},
                           {"--technique: auto:error=1", "shows nothing of gallery"}},
                    Misuse{{"tables", "--rounds", "0"}, {"--rounds", "'0'"}},
                    Misuse{{"tables", "--rounds", "many"}, {"--rounds", "'many'"}},
                    Misuse{{"tables", "--threads", "-1"}, {"--threads", "'-1'"}},
                    Misuse{{"tables", "--size", "0x768"}, {"--size", "0x768"}},
                    Misuse{{"tables", "--context", "vulkan"}, {"--context", "vulkan", "osmesa"}},
                    Misuse{{"tables", "--html"}, {"--html"}},
                    Misuse{{"lod", "--poses", "0"}, {"--poses", "0"}},
                    Misuse{{"lod", "--poses", "9", "--max-error", "nan"}, {"--max-error"}},
                    Misuse{{"lod", "--poses", "9", "--max-error", "-1"}, {"--max-error"}},
                    Misuse{{"lod", "--max-error", "1"}, {"--max-error", "--poses"}},
                    Misuse{{"peers", "--rounds", "0"}, {"--rounds", "'0'"}},
                    Misuse{{"peers", "--calibration", "a.json"}, {"--calibration"}},
                    Misuse{{"tables", "--claims", "--terrain", "natural"},
                           {"--claims: --terrain found"}},
                    Misuse{{"flight", "natural"}, {"no --path found"}},
                    Misuse{{"tables", "--terrain"}, {"--terrain"}},
                    Misuse{{"tables", "natural"}, {"natural"}}));

TEST(BenchBadInput, unknown_terrain) {
    expect_refusal(test::reljef_bench({"tables", "--terrain", "atlantis", "--context", "osmesa"}),
                   1, {"atlantis", "natural, urban"});
}

TEST(BenchBadInput, name_that_steers_a_terminal_is_told_in_plain_letters) {
    const auto result = test::reljef_bench(
        {"tables", "--terrain", "a\n\x1b[31mb.tif", "--context", "osmesa", "--quiet"});
    expect_refusal(result, 1, {"a; \\x1b[31mb.tif"});
    EXPECT_EQ(result.err.find('\x1b'), result.err.npos);
}

// Each suite measures the other terrain, writes its file and names the bad ones at its end.
TEST(BenchBadInput, bad_terrains_cost_the_others_nothing) {
    const test::TemporaryFolder folder;
    const std::string head = "xllcenter 0\nyllcenter 0\ncellsize 1\n";
    const std::string one = folder.write("one.asc", "ncols 1\nnrows 1\n" + head + "1\n");
    const std::string two = folder.write("two.asc", "ncols 1\nnrows 2\n" + head + "1\n2\n");
    const std::string four = folder.write("four.asc", "ncols 2\nnrows 2\n" + head + "1 2\n3 4\n");
    std::string text = "ncols 20\nnrows 20\nxllcenter 0\nyllcenter 0\ncellsize 1\n";
    for (int i = 0; i < 400; ++i) {
        text += std::to_string((i * 7) % 11) + " ";
    }
    const std::string good = folder.write("good.asc", text);
    const std::string json = (folder.path() / "rows.json").string();
    for (const std::vector<std::string>& suite :
         {std::vector<std::string>{"tables", "--technique", "relief"},
          {"tables", "--distances", "--technique", "relief"},
          {"lod", "--poses", "4"},
          {"skip", "--kind", "frustum"},
          {"pareto", "--technique", "relief"},
          {"stress", "--only", "grazing-view", "--technique", "relief"}}) {
        std::vector<std::string> arguments = suite;
        for (const std::string& terrain :
             {folder.path().string() + "/none.asc", one, two, four, good}) {
            arguments.insert(arguments.end(), {"--terrain", terrain});
        }
        arguments.insert(arguments.end(), {"--context", "osmesa", "--size", "32x24", "--quick",
                                           "--quiet", "--json", json});
        const auto result = test::reljef_bench(arguments);
        EXPECT_EQ(result.exit_code, 1) << suite[0];
        for (const char* const part :
             {"none.asc", "one.asc: has 1×1 samples", "two.asc: has 1×2 samples"}) {
            EXPECT_THAT(result.err, testing::HasSubstr(part)) << suite[0];
        }
        EXPECT_THAT(result.out, testing::HasSubstr("good")) << suite[0];
        EXPECT_THAT(test::read_bytes(json), testing::HasSubstr("none.asc")) << suite[0];
        std::filesystem::remove(json);
    }
}

TEST(BenchBadInput, each_bad_terrain_has_a_line) {
    const auto result = test::reljef_bench({"tables", "--terrain", "/none/a.asc", "--terrain",
                                            "/none/b.asc", "--terrain", "/none/c.asc", "--context",
                                            "osmesa", "--size", "32x24", "--quick", "--quiet"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 3) << result.err;
    for (const char* const name : {"a", "b", "c"}) {
        EXPECT_THAT(result.err,
                    testing::HasSubstr(std::string("reljef-bench: /none/") + name + ".asc: "));
    }
}

TEST(BenchBadInput, missing_file) {
    expect_refusal(
        test::reljef_bench({"tables", "--terrain", "/none/a.tif", "--context", "osmesa"}), 1,
        {"/none/a.tif"});
}

TEST(BenchBadInput, json_that_cannot_be_written_costs_no_measuring) {
    expect_refusal(test::reljef_bench({"tables", "--json", "/nonexistent/t.json"}), 1,
                   {"/nonexistent/t.json"});
}

TEST(BenchBadInput, json_that_is_a_folder) {
    const test::TemporaryFolder folder;
    expect_refusal(test::reljef_bench({"tables", "--json", folder.path().string()}), 1,
                   {folder.path().string(), "folder"});
    EXPECT_TRUE(folder.names().empty());
}

TEST(BenchBadInput, failed_run_keeps_the_earlier_results) {
    const test::TemporaryFolder folder;
    const auto file = folder.write("t.json", "earlier");
    expect_refusal(test::reljef_bench({"tables", "--terrain", "atlantis", "--context", "osmesa",
                                       "--json", file.string()}),
                   1, {"atlantis"});
    EXPECT_EQ(test::read_bytes(file), "earlier");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"t.json"});
}

} // namespace
} // namespace reljef
