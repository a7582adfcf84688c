#include "bench/pareto_suite.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/bench/bench_program.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<double> values_between(double default_value, double low, double high,
                                   bool whole = false) {
    return values_over_range({"x", default_value, low, high, whole, ""});
}

TEST(ValuesOverRange, go_in_even_steps_of_the_range_or_of_its_logarithm) {
    EXPECT_THAT(values_between(0.5, 0.0, 1.0), ElementsAre(0.0, 0.25, 0.5, 0.75, 1.0));
    EXPECT_THAT(values_between(0.1, 0.0, 1.0), ElementsAre(0.0, 0.1, 0.25, 0.5, 0.75, 1.0));
    EXPECT_THAT(values_between(16.0, 1.0, 256.0, true), ElementsAre(1.0, 4.0, 16.0, 64.0, 256.0));
    EXPECT_THAT(values_between(20.0, 1.0, 256.0, true),
                ElementsAre(1.0, 4.0, 16.0, 20.0, 64.0, 256.0));
    EXPECT_THAT(values_between(1.0, 1.0, 3.0, true), ElementsAre(1.0, 2.0, 3.0));
    EXPECT_THAT(values_between(1.0, 1.0, 1.0, true), ElementsAre(1.0));
}

TEST(SettingsOverRange, hold_every_technique_as_it_is_none_twice_and_none_refused) {
    std::set<std::string> labels;
    for (const scene::Technique& technique : settings_over_range()) {
        const std::string label = scene::to_string(technique);
        EXPECT_TRUE(scene::parse_technique(label)) << label;
        EXPECT_TRUE(labels.insert(label).second) << label;
    }
    for (const scene::TechniqueInfo& info : scene::terrain_techniques()) {
        EXPECT_EQ(labels.count(scene::to_string(scene::make_technique(info.id))), 1U);
    }
}

TEST(ParetoProgram, tells_rows_and_fronts_of_every_pose_in_every_form) {
    RELJEF_RELEASE_ONLY("the suite, its fronts and its forms have tests of their own");
    const test::TemporaryFolder folder;
    const auto dem = folder.write("dem.asc", test::small_dem).string();
    const auto json_file = folder.path() / "p.json";
    const auto csv_file = folder.path() / "p.csv";
    const auto markdown_file = folder.path() / "p.md";
    const auto result = test::reljef_bench(
        {"pareto",      "--terrain",       dem,           "--size",
         "64x48",       "--context",       "osmesa",      "--rounds",
         "2",           "--quiet",         "--technique", "polygons:lods=1",
         "--technique", "parallax",        "--json",      json_file.string(),
         "--csv",       csv_file.string(), "--markdown",  markdown_file.string()});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_THAT(result.out, HasSubstr("dem.asc, grazing: front"));
    const auto report = nlohmann::json::parse(test::read_bytes(json_file));
    std::set<std::string> poses;
    for (const auto& front : report.at("fronts")) {
        poses.insert(front.at("pose").get<std::string>());
        EXPECT_EQ(front.at("scene"), "dem.asc");
        EXPECT_GE(front.at("area"), 0.0);
        EXPECT_FALSE(front.at("front").empty());
    }
    EXPECT_EQ(poses, (std::set<std::string>{"overview", "oblique", "low", "grazing"}));
    EXPECT_EQ(report.at("rows").size(), 4 * (3 + 1));
    for (const auto& row : report.at("rows")) {
        EXPECT_EQ(row.at("suite"), "pareto");
        // Seen from below its plane, parallax shows nothing at all.
        EXPECT_TRUE(row.at("error").at("reprojection_px").is_object() ||
                    row.at("error").at("holes") > 0);
    }
    EXPECT_THAT(test::read_bytes(csv_file), HasSubstr("pareto,,dem.asc,low,polygons:lods=1"));
    EXPECT_THAT(test::read_bytes(markdown_file), HasSubstr("## Pareto fronts"));
}

} // namespace
} // namespace reljef::bench
