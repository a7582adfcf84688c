#include "bench/report/report_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/bench/report/made_results.h"

namespace reljef::bench {
namespace {

using nlohmann::json;

TEST(JsonReport, has_the_schema_the_environment_and_a_row_a_technique) {
    const json report = json::parse(json_report(test::made_results()));
    EXPECT_EQ(report.at("schema"), "reljef-bench/1");
    EXPECT_EQ(report.at("complete"), true);
    EXPECT_TRUE(report.at("stopped").is_null());
    EXPECT_EQ(report.at("notes"), json::array());
    EXPECT_EQ(report.at("left_out"), json::array());
    EXPECT_EQ(report.at("environment"), json({{"renderer", "a renderer"},
                                              {"gl", "4.5 of it"},
                                              {"context", "osmesa"},
                                              {"threads", 2},
                                              {"cpu", "a processor"},
                                              {"commit", "0123456789ab"},
                                              {"costs", "built-in"}}));
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
    EXPECT_EQ(row.at("label"), "polygons:lods=1");
    EXPECT_EQ(row.at("missing"), false);
    EXPECT_EQ(row.at("noisy"), false);
    EXPECT_EQ(row.at("ms").at("median"), 8.0);
    EXPECT_EQ(row.at("ms").at("p95"), 10.0);
    EXPECT_EQ(row.at("ms").at("p99"), 12.0);
    EXPECT_EQ(row.at("ms").at("interval"), json({0.9 * 8.0, 1.1 * 8.0}));
    EXPECT_EQ(row.at("fps_1_percent_low"), 62.5);
    EXPECT_EQ(row.at("fps"), 125.0);
    EXPECT_EQ(row.at("ratio_to_texture"), 4.0);
    EXPECT_EQ(row.at("noise_floor"), 0.05);
    EXPECT_EQ(row.at("triangles"), 2'097'152);
    EXPECT_EQ(row.at("draws"), 2);
    EXPECT_EQ(row.at("uploads"), 1);
    EXPECT_EQ(row.at("skipped").at("tiles_outside_frustum"), 17);
    EXPECT_EQ(row.at("null_row"), false);
    EXPECT_TRUE(row.at("gpu_ms").is_null());
    EXPECT_TRUE(row.at("taps").is_null()); // not counted
    EXPECT_TRUE(row.at("test").is_null()); // not a test of the sources
    EXPECT_TRUE(row.at("source").is_null());
}

TEST(JsonReport, work_is_that_of_the_picture_and_taps_those_of_a_pixel) {
    Results results = test::made_results();
    results.rows[1].work = view::WorkTotals{.taps = 1024 * 768 * 3 / 2, .steps = 7, .rays = 5};
    const json row = json::parse(json_report(results)).at("rows").at(1);
    EXPECT_EQ(row.at("taps"), 1.5);
    EXPECT_EQ(row.at("work"), json({{"taps", 1024 * 768 * 3 / 2}, {"steps", 7}, {"rays", 5}}));
}

TEST(JsonReport, time_of_the_gpu_is_told_where_it_was_measured) {
    Results results = test::made_results();
    results.rows[1].timing.gpu_ms = 7.5;
    EXPECT_EQ(json::parse(json_report(results)).at("rows").at(1).at("gpu_ms"), 7.5);
}

TEST(JsonReport, every_row_has_every_key_and_null_where_there_is_nothing) {
    Results results = test::made_source_results();
    results.rows[1].error.reset();
    const json rows = json::parse(json_report(results)).at("rows");
    for (const json& row : rows) {
        ASSERT_EQ(row.size(), rows.at(0).size());
        for (const auto& [key, value] : rows.at(0).items()) {
            EXPECT_TRUE(row.contains(key)) << key;
        }
    }
    EXPECT_TRUE(rows.at(1).at("error").is_null());
}

TEST(JsonReport, too_few_frames_are_noisy_and_have_neither_interval_nor_floor) {
    Results results = test::made_results();
    results.rows[1].timing.frames = min_frames - 1;
    results.rows[1].timing.interval.reset();
    results.rows[1].timing.noise_floor.reset();
    const json rows = json::parse(json_report(results)).at("rows");
    EXPECT_EQ(rows.at(1).at("noisy"), true);
    EXPECT_TRUE(rows.at(1).at("ms").at("interval").is_null());
    EXPECT_TRUE(rows.at(1).at("noise_floor").is_null());
    EXPECT_EQ(rows.at(0).at("noisy"), false);
}

TEST(JsonReport, run_that_left_settings_out_is_not_complete_and_says_which) {
    Results results = test::made_results();
    results.left_out = {{"natural", scene::Pose::low, 7, {"exact", "polygons"}}};
    results.notes = {"a note"};
    const json report = json::parse(json_report(results));
    EXPECT_EQ(report.at("complete"), false);
    EXPECT_TRUE(report.at("stopped").is_null());
    EXPECT_EQ(report.at("notes"), json({"a note"}));
    EXPECT_EQ(report.at("left_out"),
              json::parse(R"([{"scene": "natural", "pose": "low", "settings": 7,
                               "techniques": ["exact", "polygons"]}])"));
}

TEST(JsonReport, row_says_how_wrong) {
    const json error = json::parse(json_report(test::made_results())).at("rows").at(1).at("error");
    EXPECT_EQ(error.at("reprojection_px"), json({{"median", 0.125},
                                                 {"p95", 0.5},
                                                 {"p99", 0.75},
                                                 {"max", 1.0},
                                                 {"rms", 0.25},
                                                 {"count", 700'000},
                                                 {"unbounded", 0}}));
    EXPECT_EQ(error.at("wrong_percent"), 1.25);
    EXPECT_EQ(error.at("holes"), 3);
    EXPECT_EQ(error.at("rmse"), 0.01);
    EXPECT_EQ(error.at("psnr"), 40.0);
    EXPECT_EQ(error.at("ssim"), 0.975);
    EXPECT_EQ(error.at("flip"), 0.02);
}

TEST(JsonReport, error_without_a_figure_is_null) {
    Results results = test::made_results();
    results.rows[0].error->reprojection_px.reset();
    results.rows[0].error->psnr.reset();
    results.rows[0].error->ssim.reset();
    const json error = json::parse(json_report(results)).at("rows").at(0).at("error");
    EXPECT_TRUE(error.at("reprojection_px").is_null());
    EXPECT_TRUE(error.at("psnr").is_null());
    EXPECT_TRUE(error.at("ssim").is_null());
}

TEST(JsonReport, row_has_the_figure_of_the_sources) {
    const json row = json::parse(json_report(test::made_source_results())).at("rows").at(2);
    EXPECT_EQ(row.at("technique"), "relief");
    EXPECT_EQ(row.at("test"), "relief-4");
    EXPECT_EQ(
        row.at("source"),
        json({{"fps", 55.0}, {"ratio", 824.0 / 55.0}, {"where", "relief-4, configuration 2"}}));
}

TEST(JsonReport, row_above_the_noise_is_noisy) {
    Results results = test::made_results();
    results.rows[0].timing.noise_floor = max_noise;
    results.rows[1].timing.noise_floor = 1.01 * max_noise;
    const json rows = json::parse(json_report(results)).at("rows");
    EXPECT_EQ(rows.at(0).at("noisy"), false);
    EXPECT_EQ(rows.at(1).at("noisy"), true);
}

TEST(JsonReport, fronts_name_who_dominates_whom) {
    Results results = test::made_results();
    EXPECT_FALSE(json::parse(json_report(results)).contains("fronts"));
    results.fronts = {{"natural", scene::Pose::low, 0.25, {"a", "b"}, {{"c", "b"}}, {"d"}}};
    EXPECT_EQ(json::parse(json_report(results)).at("fronts"),
              json::parse(R"([{"scene": "natural", "pose": "low", "area": 0.25,
                              "front": ["a", "b"], "dominated": [{"label": "c", "by": "b"}],
                              "holed": ["d"]}])"));
    results.fronts[0].area.reset();
    EXPECT_TRUE(json::parse(json_report(results)).at("fronts").at(0).at("area").is_null());
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
    results.rows[0].timing.noise_floor.reset();
    const json report = json::parse(json_report(results));
    EXPECT_EQ(report.at("complete"), false);
    EXPECT_EQ(report.at("stopped"), "interrupted");
    EXPECT_TRUE(report.at("rows").at(0).at("noise_floor").is_null());
}

TEST(JsonReport, scene_name_that_is_no_utf8_does_no_harm) {
    const std::string text = json_report(test::made_results("caf\xE9.tif"));
    EXPECT_TRUE(json::accept(text));
}

} // namespace
} // namespace reljef::bench
