#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/bench/bench_program.h"
#include "tests/support/process_state.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

TEST(BenchCtrlC, keeps_the_rows_it_has_and_leaves_no_part_files) {
    const test::TemporaryFolder folder;
    const auto dem = folder.write("dem.asc", test::small_dem).string();
    const auto file = folder.path() / "t.json";
    test::ProgramOptions options;
    options.interruption = {SIGINT, [](int process) { // after some of a million rounds
                                return test::processor_seconds(process) > 2.5;
                            }};
    const auto result =
        test::run_program(RELJEF_BENCH_BINARY,
                          {"tables", "--terrain", dem, "--size", "64x48", "--context", "osmesa",
                           "--rounds", "1000000", "--quiet", "--json", file.string()},
                          options);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.err.rfind("reljef-bench: interrupted", 0), 0U) << result.err;
    EXPECT_THAT(result.out, testing::HasSubstr("polygons"));
    const auto report = nlohmann::json::parse(test::read_bytes(file));
    EXPECT_EQ(report.at("complete"), false);
    ASSERT_FALSE(report.at("rows").empty());
    EXPECT_GT(report.at("rows").at(0).at("frames"), 0);
    EXPECT_LT(report.at("rows").at(0).at("frames"), 1'000'000);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"dem.asc", "t.json"}));
}

} // namespace
} // namespace reljef
