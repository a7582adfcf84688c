#include "bench/suites/source_tests.h"

#include <algorithm>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef::bench {
namespace {

TEST(SourceTests, figures_are_those_of_the_thesis) {
    const char* const file = "../sources/thesis_fps.csv";
    RELJEF_NEED_DATA(file);
    std::string ours = "test,scene,config,technique,fps\n";
    for (const SourceMeasurement& row : source_measurements()) {
        ours += fmt::format("{},{},{},{},{}\n", row.test, row.scene, row.configuration,
                            row.technique, row.fps);
    }
    EXPECT_EQ(ours, test::read_bytes(test::data_path(file)));
}

TEST(SourceTests, there_are_seven_and_each_begins_with_texture) {
    std::set<std::string> names;
    for (const Group& group : source_groups()) {
        names.insert(group.test);
        EXPECT_EQ(group.candidates.front().technique.id(), scene::TechniqueId::texture);
        EXPECT_EQ(group.pose, scene::Pose::overview);
    }
    EXPECT_EQ(names, (std::set<std::string>{"parallax-1", "parallax-2", "parallax-3", "relief-1",
                                            "relief-2", "relief-3", "relief-4"}));
}

TEST(SourceTests, every_candidate_has_the_sources_figure_of_the_newer_machine) {
    for (const Group& group : source_groups()) {
        const double texture = group.candidates.front().source->fps;
        for (const Candidate& candidate : group.candidates) {
            const bool is_ours =
                setting_of(candidate.technique).technique == "exact" ||
                setting_of(candidate.technique).label.find("error=") != std::string::npos;
            ASSERT_NE(candidate.source.has_value(), is_ours);
            if (is_ours) {
                EXPECT_EQ(group.test, "relief-4");
                continue;
            }
            EXPECT_DOUBLE_EQ(candidate.source->ratio, texture / candidate.source->fps);
            EXPECT_EQ(candidate.source->where, group.test + ", configuration 2");
        }
    }
}

TEST(SourceTests, relief_4_asks_for_all_its_techniques_by_our_names) {
    const std::vector<Group> groups = source_groups();
    const auto relief_4 = std::find_if(groups.begin(), groups.end(),
                                       [](const Group& group) { return group.test == "relief-4"; });
    std::vector<std::string> techniques;
    for (const Candidate& candidate : relief_4->candidates) {
        techniques.push_back(setting_of(candidate.technique).technique);
    }
    EXPECT_THAT(techniques,
                testing::ElementsAre("texture", "polygons", "polygons", "polygons", "parallax",
                                     "relief", "polygons", "exact", "auto"));
    EXPECT_EQ(relief_4->candidates[1].source->fps, 5.0);
    EXPECT_EQ(scene::to_string(relief_4->candidates[1].technique), "polygons:lods=1");
}

TEST(SourceTests, quick_ones_differ_in_one_terrain_alone) {
    const std::vector<Group> whole = source_groups();
    const std::vector<Group> quick = source_groups(true);
    ASSERT_EQ(quick.size(), whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) {
        EXPECT_EQ(quick[i].test, whole[i].test);
        EXPECT_EQ(quick[i].candidates.size(), whole[i].candidates.size());
        EXPECT_EQ(quick[i].scene == whole[i].scene, whole[i].test != "parallax-2");
    }
}

TEST(SourceTests, terrains_follow_each_other_so_that_each_is_opened_once) {
    std::vector<SceneChoice> scenes;
    for (const Group& group : source_groups()) {
        if (scenes.empty() || !(scenes.back() == group.scene)) {
            EXPECT_EQ(std::count(scenes.begin(), scenes.end(), group.scene), 0);
            scenes.push_back(group.scene);
        }
    }
    EXPECT_EQ(scenes.size(), 5U);
}

} // namespace
} // namespace reljef::bench
