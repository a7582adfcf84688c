#include "bench/suites/pareto_suite.h"

#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/bench/bench_program.h"
#include "tests/scene/technique/terrain_techniques.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<double> values_between(double default_value, double low, double high,
                                   bool whole = false) {
    return values_over_range(
        {.name = "x", .low = low, .high = high, .default_value = default_value, .whole = whole});
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
    for (const scene::Technique& technique : settings_over_range(scene::terrain_techniques())) {
        const std::string label = scene::to_string(technique);
        EXPECT_TRUE(scene::parse_technique(label)) << label;
        EXPECT_TRUE(labels.insert(label).second) << label;
    }
    for (const scene::TechniqueInfo& info : scene::terrain_techniques()) {
        EXPECT_EQ(labels.count(scene::to_string(scene::make_technique(info.id))), 1U);
    }
}

TEST(SettingsOverRange, begin_with_every_technique_the_cheap_kinds_first) {
    const std::vector<scene::Technique> settings = settings_over_range(scene::terrain_techniques());
    const std::size_t techniques = scene::terrain_techniques().size();
    std::vector<std::string> names;
    for (std::size_t i = 0; i < techniques; ++i) {
        EXPECT_EQ(settings[i], scene::make_technique(settings[i].id()));
        names.emplace_back(scene::technique_info(settings[i].id()).name);
    }
    const auto place = [&](const std::string& name) {
        const auto found = std::find(names.begin(), names.end(), name);
        EXPECT_NE(found, names.end()) << name;
        return found - names.begin();
    };
    EXPECT_EQ(place("texture"), 0);
    EXPECT_LT(place("parallax-iterated"), place("steep"));
    EXPECT_LT(place("relief"), place("exact"));
    EXPECT_LT(place("exact"), place("polygons"));
}

// A run that is short of time then measures some settings of every technique.
TEST(SettingsOverRange, go_through_the_techniques_in_turns_from_their_defaults_outward) {
    const std::vector<scene::Technique> settings = settings_over_range(scene::terrain_techniques());
    const auto place = [&](const std::string& label) {
        const auto found =
            std::find_if(settings.begin(), settings.end(), [&](const scene::Technique& setting) {
                return scene::to_string(setting) == label;
            });
        EXPECT_NE(found, settings.end()) << label;
        return found - settings.begin();
    };
    EXPECT_LT(place("steep:n=8"), place("steep:n=4096"));
    EXPECT_LT(place("pom:min=64,max=32"), place("steep:n=4096"));
    EXPECT_LT(place("relief:n=8,k=8"), place("parallax-iterated:offset=-0.5,k=64"));
}

// "tile fence oblique lattice:n=32,k=6"
std::vector<std::string> planned(const std::vector<std::string>& techniques,
                                 const std::vector<std::string>& terrains = {}) {
    ParetoOptions options;
    options.terrains = terrains;
    for (const std::string& technique : techniques) {
        options.techniques.push_back(scene::parse_technique(technique).value());
    }
    std::vector<std::string> rows;
    for (const Group& group : pareto_groups(options)) {
        const std::string scene =
            group.scene.detail.empty() ? group.scene.terrain : group.scene.detail;
        for (const Candidate& candidate : group.candidates) {
            rows.push_back(scene + " " + std::string(scene::to_string(group.pose)) + " " +
                           scene::to_string(candidate.technique));
        }
    }
    return rows;
}

TEST(ParetoGroups, technique_of_meshes_stands_where_it_suits) {
    const auto rows = planned({"lattice", "bump", "relief:shadow=hard"});
    for (const char* row :
         {"fence oblique lattice:n=32,k=6", "fence oblique texture", "brick oblique bump",
          "brick oblique relief:n=11,k=8,shadow=hard", "natural low relief:n=11,k=8,shadow=hard"}) {
        EXPECT_THAT(rows, testing::Contains(row));
    }
    for (const char* row : {"copper oblique texture", "natural oblique bump", "brick low bump",
                            "fence oblique relief:n=11,k=8,shadow=hard"}) {
        EXPECT_THAT(rows, testing::Not(testing::Contains(row)));
    }
}

TEST(ParetoGroups, hold_every_technique_and_option_by_themselves) {
    std::string all;
    for (const std::string& row : planned({})) {
        all += row + "\n";
    }
    for (const scene::TechniqueInfo& info : scene::technique_catalogue()) {
        EXPECT_THAT(all, HasSubstr(" " + scene::to_string(scene::make_technique(info.id)) + "\n"));
    }
    for (const scene::Technique& setting : settings_of_options()) {
        EXPECT_THAT(all, HasSubstr("brick oblique " + scene::to_string(setting) + "\n"));
    }
}

TEST(ParetoGroups, terrain_that_is_named_is_drawn_as_asked_for_or_the_run_says_why_not) {
    EXPECT_THAT(planned({"bump"}, {"natural"}), testing::Contains("natural oblique bump"));
    EXPECT_THAT(planned({"polygons"}, {"gallery"}), testing::IsEmpty());
}

TEST(ParetoSuite, technique_that_nothing_suits_costs_no_measuring) {
    ParetoOptions options;
    options.techniques = {scene::make_technique(scene::TechniqueId::polygons)};
    options.terrains = {"gallery"};
    const Results results = run_pareto(options, {});
    ASSERT_TRUE(results.stopped);
    EXPECT_THAT(results.stopped->message, HasSubstr("--technique"));
}

TEST(SettingsOfOptions, hold_each_choice_that_is_not_the_default) {
    std::vector<std::string> labels;
    for (const scene::Technique& setting : settings_of_options()) {
        labels.push_back(scene::to_string(setting));
    }
    EXPECT_THAT(labels,
                ElementsAre("relief:n=11,k=8,steps=8..32", "relief:n=11,k=8,fade=0..1",
                            "relief:n=11,k=8,shadow=hard", "relief:n=11,k=8,shadow=soft,0.2",
                            "relief:n=11,k=8,edges=smooth,0.005", "relief:n=11,k=8,sides=two",
                            "relief:n=11,k=8,border=wrap", "relief:n=11,k=8,depth=none",
                            "relief:n=11,k=8,depth=write", "relief:n=11,k=8,silhouettes=true"));
}

TEST(SettingsOfOptions, hold_every_option_there_is) {
    std::string labels;
    for (const scene::Technique& setting : settings_of_options()) {
        labels += scene::to_string(setting) + " ";
    }
    for (const scene::OptionInfo& option : scene::option_catalogue()) {
        EXPECT_THAT(labels, HasSubstr("," + std::string(option.name) + "="));
    }
}

TEST(ParetoSuite, front_that_lacks_a_technique_has_no_area) {
    const test::TemporaryFolder folder;
    ParetoOptions options;
    options.terrains = {folder.write("dem.asc", test::small_dem).string()};
    options.techniques = {scene::make_technique(scene::TechniqueId::polygons)};
    options.suite.size = {64, 48};
    options.suite.context = session::BackendKind::osmesa;
    options.suite.quiet = true;
    options.suite.quick = true;
    for (const double seconds : {0.0, 1000.0}) {
        options.suite.quick_seconds = seconds;
        const Results results = run_pareto(options, {});
        ASSERT_FALSE(results.stopped) << results.stopped->message;
        ASSERT_EQ(results.fronts.size(), 4U);
        EXPECT_EQ(results.complete(), seconds > 0.0);
        EXPECT_EQ(results.fronts[0].area.has_value(), seconds > 0.0); // the overview
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
        EXPECT_TRUE(front.at("area").is_null() || front.at("area") >= 0.0);
    }
    EXPECT_FALSE(report.at("fronts").at(0).at("front").empty());
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
