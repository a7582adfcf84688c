#include "bench/report_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/bench/made_results.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using nlohmann::json;

TEST(JsonReport, has_the_schema_the_environment_and_a_row_a_technique) {
    const json report = json::parse(json_report(test::made_results()));
    EXPECT_EQ(report.at("schema"), "reljef-bench/1");
    EXPECT_EQ(report.at("complete"), true);
    EXPECT_EQ(report.at("environment"), json({{"renderer", "a renderer"},
                                              {"gl", "4.5 of it"},
                                              {"context", "osmesa"},
                                              {"threads", 2},
                                              {"cpu", "a processor"},
                                              {"commit", "0123456789ab"}}));
    EXPECT_EQ(report.at("rows").size(), 3U);
}

TEST(JsonReport, row_says_what_was_drawn_how_and_how_fast) {
    const json row = json::parse(json_report(test::made_results())).at("rows").at(1);
    EXPECT_EQ(row.at("suite"), "tables");
    EXPECT_EQ(row.at("scene"), "natural");
    EXPECT_EQ(row.at("pose"), "overview");
    EXPECT_EQ(row.at("technique"), "polygons");
    EXPECT_EQ(row.at("params"), json({{"lods", 1}}));
    EXPECT_EQ(row.at("size"), "1024x768");
    EXPECT_EQ(row.at("frames"), 20);
    EXPECT_EQ(row.at("ms"), json({{"median", 8.0}, {"p95", 9.0}, {"p99", 10.0}}));
    EXPECT_EQ(row.at("fps"), 125.0);
    EXPECT_EQ(row.at("ratio_to_texture"), 4.0);
    EXPECT_EQ(row.at("noise_floor"), 0.05);
    EXPECT_EQ(row.at("triangles"), 2'097'152);
    EXPECT_EQ(row.at("draws"), 2);
    EXPECT_EQ(row.at("uploads"), 1);
    EXPECT_EQ(row.at("skipped").at("tiles_outside_frustum"), 17);
    EXPECT_EQ(row.at("null_row"), false);
    EXPECT_FALSE(row.contains("error")); // nothing measured it
}

TEST(JsonReport, technique_without_parameters_has_an_empty_object) {
    const json report = json::parse(json_report(test::made_results()));
    EXPECT_EQ(report.at("rows").at(0).at("params"), json::object());
}

TEST(JsonReport, null_row_is_marked) {
    const json report = json::parse(json_report(test::made_results()));
    EXPECT_EQ(report.at("rows").at(2).at("technique"), "texture");
    EXPECT_EQ(report.at("rows").at(2).at("null_row"), true);
}

TEST(JsonReport, run_that_ended_early_says_so_and_invents_no_floor) {
    Results results = test::made_results();
    results.stopped = Error{"interrupted"};
    results.rows.resize(1);
    results.rows[0].noise_floor.reset();
    const json report = json::parse(json_report(results));
    EXPECT_EQ(report.at("complete"), false);
    EXPECT_TRUE(report.at("rows").at(0).at("noise_floor").is_null());
}

TEST(JsonReport, scene_name_that_is_no_utf8_does_no_harm) {
    const std::string text = json_report(test::made_results("caf\xE9.tif"));
    EXPECT_TRUE(json::accept(text));
}

TEST(JsonReport, failed_writing_keeps_the_earlier_results) {
    const test::TemporaryFolder folder;
    const auto file = folder.write("t.json", "earlier");
    ASSERT_TRUE(write_json_report(file, test::made_results()));
    EXPECT_TRUE(json::accept(test::read_bytes(file)));
    EXPECT_EQ(folder.names(), std::vector<std::string>{"t.json"});

    const auto refused = write_json_report(folder.path() / "none" / "t.json", test::made_results());
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, testing::HasSubstr("none"));
}

} // namespace
} // namespace reljef::bench
