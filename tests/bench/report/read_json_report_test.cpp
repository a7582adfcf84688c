#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/report/report_json.h"
#include "bench/report/report_text.h"
#include "tests/bench/report/made_results.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class ReadJsonReport : public testing::Test {
protected:
    Result<Results> read(const std::string& text) {
        return read_json_report(folder_.write("t.json", text));
    }

    // The error of a report after the value at a JSON pointer is replaced.
    std::string refusal(const std::string& pointer, const json& value) {
        json report = json::parse(json_report(everything()));
        report[json::json_pointer(pointer)] = value;
        const auto results = read(report.dump());
        return results ? "" : results.error().message;
    }

    std::string refusal_without(const std::string& parent, const std::string& key) {
        json report = json::parse(json_report(everything()));
        report[json::json_pointer(parent)].erase(key);
        const auto results = read(report.dump());
        return results ? "" : results.error().message;
    }

    static Results everything() {
        Results results = test::made_source_results();
        results.rows[0].error->psnr.reset();
        results.rows[0].error->hit_texels.reset();
        results.rows[1].error->ssim.reset();
        results.rows[1].setting.parameters.push_back({"scale", 0.1});
        results.rows[3].timing.noise_floor.reset();
        results.rows[3].timing.interval.reset();
        results.rows[3].timing.ratio_to_texture.reset();
        results.rows[0].timing.gpu_ms = 1.5;
        results.fronts = {{"natural", scene::Pose::low, 0.25, {"a", "b"}, {{"c", "b"}}, {"d"}},
                          {"natural", scene::Pose::grazing, {}, {"a"}, {}, {}}};
        results.left_out = {{"natural", scene::Pose::grazing, 7, {"exact"}}};
        results.notes = {"a note", "another"};
        return results;
    }

    test::TemporaryFolder folder_;
};

TEST_F(ReadJsonReport, reads_what_was_written) {
    const std::string text = json_report(everything());
    const auto results = read(text);
    ASSERT_TRUE(results) << results.error().message;
    EXPECT_EQ(json_report(*results), text);
    EXPECT_FALSE(results->stopped);
    EXPECT_EQ(results->rows[1].setting.parameters,
              (std::vector<Setting::Parameter>{{"lods", 1.0}, {"scale", 0.1}}));
}

TEST_F(ReadJsonReport, every_figure_comes_back_to_the_bit) {
    std::mt19937 random(1);
    std::lognormal_distribution<double> figure(0.0, 3.0);
    for (int i = 0; i < 300; ++i) {
        Results results = test::made_results();
        results.rows[0].timing = test::made_timing(figure(random), figure(random));
        results.rows[0].error = test::made_error(figure(random));
        const auto back = read(json_report(results));
        ASSERT_TRUE(back);
        ASSERT_EQ(back->rows[0].timing.ms.p99, results.rows[0].timing.ms.p99);
        ASSERT_EQ(back->rows[0].timing.ratio_to_texture, results.rows[0].timing.ratio_to_texture);
        ASSERT_EQ(back->rows[0].error->reprojection_px->distribution.rms,
                  results.rows[0].error->reprojection_px->distribution.rms);
    }
}

TEST_F(ReadJsonReport, unproven_search_of_auto_comes_back_and_stands_in_the_table) {
    Results results = test::made_results();
    results.rows[0].timing.stats.choice =
        view::Choice{.tiles_by_rays = 3, .typical = view::TypicalChoice{"interval:n=4,k=2", 0.93}};
    const std::string text = json_report(results);
    const auto again = read(text);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(json_report(*again), text);
    EXPECT_EQ(again->rows[0].timing.stats.choice, results.rows[0].timing.stats.choice);
    EXPECT_NE(markdown_report(results).find("(unproven: interval:n=4,k=2)"), std::string::npos);
    EXPECT_EQ(markdown_report(test::made_results()).find("unproven"), std::string::npos);
}

TEST_F(ReadJsonReport, run_that_ended_early_still_says_so) {
    Results stopped = test::made_results();
    stopped.stopped = Error{"interrupted"};
    const auto results = read(json_report(stopped));
    ASSERT_TRUE(results);
    ASSERT_TRUE(results->stopped);
    EXPECT_EQ(results->stopped->message, "interrupted");
}

TEST_F(ReadJsonReport, what_skipping_saves_is_read_as_it_was_written) {
    Results results = test::made_results();
    results.rows[1].work = view::WorkTotals{.taps = 30, .steps = 20, .rays = 10};
    RowSkip& skip = results.rows[1].skip.emplace();
    skip.without = "beams";
    skip.meaning = "free space";
    skip.bytes_read = 4096.0;
    skip.difference = {.pixels = 3, .levels = 1, .hits = 9, .max_px = 1e-4, .tolerance_px = 2e-4};
    skip.saved.ms = -0.5;
    skip.saved.taps = 12.0;
    skip.saved.triangles = 100.0;
    const std::string text = json_report(results);
    const auto again = read(text);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(json_report(*again), text);
    EXPECT_EQ(again->rows[1].skip->saved.ms, -0.5);
    EXPECT_FALSE(again->rows[1].skip->saved.bytes_read.has_value());
    EXPECT_FALSE(again->rows[0].skip.has_value());
}

// The first files of the schema lacked these keys.
TEST_F(ReadJsonReport, results_without_the_newer_keys_are_read) {
    json report = json::parse(json_report(test::made_source_results()));
    for (const char* key : {"stopped", "notes", "left_out"}) {
        report.erase(key);
    }
    report["complete"] = false;
    for (json& row : report["rows"]) {
        for (const char* key :
             {"gpu_ms", "taps", "work", "skip", "bytes_uploaded", "state_changes"}) {
            row.erase(key);
        }
    }
    for (const char* key : {"ms", "fps", "frames", "error", "skipped", "ratio_to_texture"}) {
        report["rows"][2].erase(key);
    }
    report["rows"][2]["missing"] = true;
    report["rows"][0].erase("test");
    report["rows"][0].erase("source");
    const auto results = read(report.dump());
    ASSERT_TRUE(results) << results.error().message;
    EXPECT_TRUE(results->stopped);
    EXPECT_EQ(results->rows[0].test, "");
    EXPECT_EQ(results->rows.size(), 3U); // without the missing one
    EXPECT_TRUE(results->rows[2].null_row);
}

TEST_F(ReadJsonReport, file_cut_anywhere_is_refused) {
    const std::string text = json_report(everything());
    for (std::size_t length = 0; length + 2 < text.size(); length += 23) {
        const auto results = read(text.substr(0, length));
        ASSERT_FALSE(results) << length;
        ASSERT_THAT(results.error().message, HasSubstr("t.json"));
        ASSERT_THAT(results.error().message, HasSubstr("its end is missing")) << length;
    }
}

TEST_F(ReadJsonReport, what_is_no_json_or_another_schema_is_told) {
    const auto message = [&](const std::string& text) { return read(text).error().message; };
    EXPECT_THAT(message("hello"), HasSubstr("no JSON found at byte 1"));
    EXPECT_THAT(message("[1, 2]"), HasSubstr("[1,2] found, an object was expected"));
    EXPECT_THAT(message("{}"), HasSubstr("schema: nothing found"));
    EXPECT_THAT(message("{\"schema\": 1e999}"), HasSubstr("t.json"));
    EXPECT_THAT(refusal("/schema", "reljef-bench/2"),
                HasSubstr("schema: \"reljef-bench/2\" found, \"reljef-bench/1\" was expected"));
}

TEST_F(ReadJsonReport, place_found_and_expected_are_in_the_sentence) {
    EXPECT_THAT(refusal("/rows/1/ms/median", -1.0),
                HasSubstr("rows[1].ms.median: -1.0 found, a number from 1e-09 to 1000000000"));
    EXPECT_THAT(refusal("/rows/0/ms/interval", {2.0, 1.0}),
                HasSubstr("rows[0].ms.interval: [2.0,1.0] found, two numbers from 1e-09 to "
                          "1000000000, the lower one first was expected"));
    EXPECT_THAT(refusal("/rows/0/size", "1024"), HasSubstr("rows[0].size: \"1024\" found"));
    EXPECT_THAT(refusal_without("/rows/0", "pose"),
                HasSubstr("rows[0].pose: nothing found, a text was expected"));
}

TEST_F(ReadJsonReport, anything_of_a_wrong_kind_or_range_is_refused) {
    const std::vector<std::pair<std::string, json>> wrong{
        {"/complete", 1},
        {"/environment/threads", -1},
        {"/environment/threads", 1.5},
        {"/environment/cpu", nullptr},
        {"/rows", json::object()},
        {"/rows/0", 3},
        {"/rows/0/pose", "upside down"},
        {"/rows/0/size", "0x768"},
        {"/rows/0/size", "x"},
        {"/rows/0/size", ""},
        {"/rows/0/size", "1024x768x2"},
        {"/rows/0/missing", "no"},
        {"/rows/0/frames", 0},
        {"/rows/0/ms", nullptr},
        {"/rows/0/ms/p95", "fast"},
        {"/rows/0/ms/median", 1e300},
        {"/rows/0/ms/median", 1e-320},
        {"/rows/0/ratio_to_texture", 1e300},
        {"/rows/0/fps_1_percent_low", 1e10},
        {"/rows/0/ms/interval", {1.0, 1e300}},
        {"/rows/0/ms/interval", {-1.0, 1.0}},
        {"/rows/0/gpu_ms", -1.0},
        {"/rows/0/ms/interval", {2.0, 1.0}},
        {"/rows/0/ms/interval", {1.0}},
        {"/rows/0/ms/interval", {"a", "b"}},
        {"/rows/0/ratio_to_texture", 0},
        {"/rows/0/noise_floor", -0.1},
        {"/rows/0/triangles", 0.5},
        {"/rows/0/tiles", 1e12},
        {"/rows/0/error/wrong_percent", 101},
        {"/rows/0/error/holes", -1},
        {"/rows/0/error/ssim", 2},
        {"/rows/0/error/reprojection_px/count", 0},
        {"/rows/0/error/reprojection_px/rms", -1},
        {"/rows/0/source/fps", 0},
        {"/rows/1/params/lods", "one"},
        {"/rows/1/params", json::array()},
        {"/rows/0/skipped", json::object()},
        {"/fronts/0/area", 1.5},
        {"/fronts/0/front", {1}},
        {"/fronts/0/dominated/0/by", 2},
        {"/fronts/0/holed", 3},
        {"/left_out", 3},
        {"/left_out/0/settings", 0},
        {"/left_out/0/techniques", {1}},
        {"/notes", {1}},
        {"/stopped", 2},
    };
    for (const auto& [pointer, value] : wrong) {
        const std::string sentence = refusal(pointer, value);
        EXPECT_THAT(sentence, HasSubstr("was expected")) << pointer << " " << value;
        EXPECT_EQ(std::count(sentence.begin(), sentence.end(), '\n'), 0);
    }
}

TEST_F(ReadJsonReport, keys_beyond_the_schema_do_no_harm) {
    EXPECT_EQ(refusal("/rows/0/taps", 12), "");
}

TEST_F(ReadJsonReport, whatever_one_byte_is_changed_to_nothing_aborts) {
    const std::string text = json_report(everything());
    std::mt19937 random(2);
    for (int i = 0; i < 1000; ++i) {
        std::string broken = text;
        const auto at = std::uniform_int_distribution<std::size_t>(0, text.size() - 1)(random);
        broken[at] = static_cast<char>(std::uniform_int_distribution<int>(0, 255)(random));
        const auto results = read(broken);
        if (!results) {
            ASSERT_THAT(results.error().message, HasSubstr("t.json"));
        }
    }
}

} // namespace
} // namespace reljef::bench
