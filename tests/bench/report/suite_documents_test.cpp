// All suites and their modes write documents of one schema.
#include <algorithm>
#include <filesystem>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/baselines/baseline_suite.h"
#include "bench/claims/claim_suite.h"
#include "bench/claims/distance_suite.h"
#include "bench/claims/guess_suite.h"
#include "bench/page/page.h"
#include "bench/report/document.h"
#include "bench/report/report_json.h"
#include "bench/stress/stress_results.h"
#include "bench/suites/compare.h"
#include "bench/suites/error_bound.h"
#include "bench/suites/flight_suite.h"
#include "bench/suites/scaling.h"
#include "bench/suites/selection_suite.h"
#include "tests/bench/bench_program.h"
#include "tests/bench/report/made_results.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using nlohmann::json;
using testing::HasSubstr;

FigureTable made_peers() {
    const truth::Distribution error{7, 0.1, 0.2, 0.3, 0.4, 0.15};
    BaselineResults results;
    results.side = 33;
    for (const BaselineWork work : {BaselineWork::levels, BaselineWork::hits}) {
        BaselineRow row;
        row.work = work;
        row.what = "polygons:error=1";
        row.is_reference = true;
        row.ms = {10.0, 12.0, 13.0};
        row.error = error;
        results.rows.push_back(row);
        row.what = "another";
        row.hit_error = error;
        row.moving = work == BaselineWork::levels;
        row.error.reset();
        results.rows.push_back(row);
    }
    return figure_table(results);
}

FigureTable made_flight() {
    FlightResults results;
    results.options.terrain.memory_megabytes = 64;
    results.options.terrain.terrain = "alps";
    results.options.view.path = "orbit";
    results.times.drawing_ms = {4.0, 5.0, 6.0};
    results.times.waiting_ms = {0.0, 1.0, 9.0};
    results.stream.emplace();
    results.kept_errors = {0.5, 0.7};
    return figure_table(results);
}

FigureTable made_growth() {
    ScalingResults results;
    for (const int side : results.options.sides) {
        for (const scene::Pose pose : {scene::Pose::overview, scene::Pose::low}) {
            ScalingRow row;
            row.side = side;
            row.pose = pose;
            row.ms = {1.0, 2.0, 3.0};
            results.rows.push_back(row);
        }
    }
    return figure_table(results);
}

FigureTable made_selection() {
    SelectionResults results;
    results.rows = {{"all seen", 100, 90, {1.0, 2.0, 3.0}}, {"none seen", 100, 0, {0.1, 0.2, 0.3}}};
    return figure_table(results);
}

FigureTable made_poses() {
    ErrorBoundResults results;
    results.rows.resize(2);
    results.rows[0].views = "random";
    results.rows[1].views = "orbit";
    results.rows[1].worst.emplace();
    results.rows[1].triangles = 7.0;
    results.rows[1].ms = Summary{1.0, 2.0, 3.0};
    return figure_table(results);
}

FigureTable made_claims() {
    ClaimResults results;
    ClaimRow row;
    row.test = "repeat";
    row.timing = test::made_timing(3.0, 1.0);
    row.error = test::made_error(0.5);
    results.rows = {row, row};
    results.rows[1].bytes = 500;
    results.rows[1].error->reprojection_px.reset();
    return figure_table(results);
}

FigureTable made_distances() {
    DistanceResults results;
    results.rows = {{"urban", 100.0, "relief", test::made_error(0.5)},
                    {"urban", 300.0, "relief", test::made_error(0.2)}};
    return figure_table(results);
}

FigureTable made_guesses() {
    GuessResults results;
    results.rows = {{"urban", "flat", 0.0, *test::made_error(0.5).reprojection_px, 40.0},
                    {"urban", "guessed", 0.2, *test::made_error(0.3).reprojection_px, 30.0}};
    return figure_table(results);
}

FigureTable made_stress() {
    StressResults results;
    results.add({.stress = "scale", .figure = "pixels", .value = 1.0, .limit = 3.0});
    results.add({.stress = "scale", .terrain = "hills", .figure = "holes", .value = 2.0});
    return figure_table(results);
}

FigureTable made_comparison() {
    Results worse = test::made_results();
    worse.rows[1].error->flip = 0.9;
    worse.rows.pop_back();
    return figure_table(compare(test::made_results(), worse), {.before = "a.json",
                                                               .after = "b.json",
                                                               .suite = "tables",
                                                               .threshold = 0.1,
                                                               .environment = worse.environment});
}

std::vector<FigureTable> tables_of_all_suites() {
    return {made_peers(),  made_flight(),    made_growth(),  made_selection(), made_poses(),
            made_claims(), made_distances(), made_guesses(), made_stress(),    made_comparison()};
}

// What all documents have.
void expect_head(const json& document) {
    EXPECT_EQ(document.at("schema"), "reljef-bench/1");
    EXPECT_TRUE(document.at("suite").is_string());
    EXPECT_TRUE(document.at("complete").is_boolean());
    EXPECT_TRUE(document.contains("stopped"));
    EXPECT_TRUE(document.at("notes").is_array());
    for (const char* const key : {"renderer", "gl", "context", "threads", "cpu", "commit"}) {
        EXPECT_TRUE(document.at("environment").contains(key)) << key;
    }
    EXPECT_TRUE(document.contains("settings"));
    EXPECT_FALSE(document.at("rows").empty());
}

// Pointers to all values below a value, and not to objects of a column, such as a view.
void add_places(const json& value, const std::string& pointer, const std::set<std::string>& keys,
                std::set<std::string>& places) {
    if (!value.is_object() || keys.contains(pointer)) {
        places.insert(pointer);
        return;
    }
    for (const auto& [key, inner] : value.items()) {
        add_places(inner, pointer + "/" + key, keys, places);
    }
}

TEST(SuiteDocuments, HaveOneHeadAndColumnsThatNameEachKeyOfTheirRows) {
    std::set<std::string> suites;
    for (const FigureTable& table : tables_of_all_suites()) {
        const json document = json::parse(figure_json(table));
        SCOPED_TRACE(document.at("suite"));
        suites.insert(document.at("suite").get<std::string>());
        expect_head(document);
        std::set<std::string> keys;
        std::set<std::string> roles;
        for (const json& column : document.at("columns")) {
            keys.insert(column.at("key").get<std::string>());
            roles.insert(column.at("role").get<std::string>());
            EXPECT_NE(column.at("heading"), "") << column;
        }
        EXPECT_TRUE(roles.contains("group") || roles.contains("name"));
        EXPECT_TRUE(roles.contains("measured"));
        for (const json& row : document.at("rows")) {
            std::set<std::string> places;
            add_places(row, "", keys, places);
            for (const std::string& place : places) {
                const auto below = keys.lower_bound(place); // of an absent figure: "/ms" is null
                EXPECT_TRUE(below != keys.end() && below->starts_with(place)) << place;
            }
        }
    }
    EXPECT_THAT(suites, testing::ElementsAre("compare", "flight", "lod-growth", "lod-poses",
                                             "lod-selection", "peers", "stress", "tables-claims",
                                             "tables-distances", "tables-guesses"));
}

TEST(SuiteDocuments, OfTechniquesHaveTheSameHead) {
    Results results = test::made_results();
    results.settings = RunSettings{};
    for (const char* const suite : {"tables", "pareto", "lod", "skip", "objects"}) {
        for (Row& row : results.rows) {
            row.suite = suite;
        }
        const json document = json::parse(json_report(results));
        expect_head(document);
        EXPECT_EQ(document.at("suite"), suite);
        EXPECT_FALSE(document.contains("columns"));
    }
}

TEST(SuiteDocuments, AreReadBackAndHaveAPageAndALineForEachRow) {
    const test::TemporaryFolder folder;
    for (const FigureTable& table : tables_of_all_suites()) {
        const auto read = read_document(folder.write("d.json", figure_json(table)));
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(std::get<FigureTable>(*read).rows.size(), table.rows.size());
        const std::string csv = figure_csv(table);
        EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'),
                  static_cast<std::ptrdiff_t>(table.rows.size() + 1));
        auto page = prepare_page(folder.path() / "page", table);
        ASSERT_TRUE(page && page->file.commit());
        EXPECT_THAT(test::read_bytes(folder.path() / "page" / "index.html"),
                    HasSubstr("\"suite\": \"" + table.suite + "\""));
    }
}

// Outputs are checked before anything is measured, so that each call fails at once by its folder,
// not by an option.
TEST(SuiteDocuments, AreWrittenInFourFormsByAllSuitesAndModes) {
    const test::TemporaryFolder folder;
    const std::string dem = folder.write("dem.asc", test::small_dem).string();
    const std::string document = folder.write("a.json", json_report(test::made_results())).string();
    const std::vector<std::vector<std::string>> calls{{"tables"},
                                                      {"tables", "--claims"},
                                                      {"tables", "--distances"},
                                                      {"tables", "--guesses"},
                                                      {"pareto"},
                                                      {"lod"},
                                                      {"lod", "--growth"},
                                                      {"lod", "--selection"},
                                                      {"lod", "--poses", "1"},
                                                      {"skip"},
                                                      {"objects"},
                                                      {"peers"},
                                                      {"stress"},
                                                      {"flight", dem, "--path", "orbit"},
                                                      {"compare", document, document}};
    const std::vector<std::pair<std::string, std::string>> outputs{{"--json", "/nonexistent/a"},
                                                                   {"--csv", "/nonexistent/b"},
                                                                   {"--markdown", "/nonexistent/c"},
                                                                   {"--html", "/nonexistent/d/e"}};
    for (const std::vector<std::string>& call : calls) {
        for (const auto& [option, file] : outputs) {
            std::vector<std::string> arguments = call;
            arguments.insert(arguments.end(), {option, file});
            const auto result = test::reljef_bench(arguments);
            EXPECT_EQ(result.exit_code, 1) << call.front() << option << result.err;
            EXPECT_THAT(result.err, HasSubstr("/nonexistent")) << call.back() << option;
        }
    }
}

TEST(SuiteDocuments, OfAModeOfASuiteAreWrittenByTheProgram) {
    const test::TemporaryFolder folder;
    const auto path = [&](const char* name) { return (folder.path() / name).string(); };
    const auto result = test::reljef_bench({"lod", "--selection", "--quick", "--quiet", "--json",
                                            path("s.json"), "--csv", path("s.csv"), "--markdown",
                                            path("s.md"), "--html", path("page")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(json::parse(test::read_bytes(path("s.json"))).at("suite"), "lod-selection");
    EXPECT_THAT(test::read_bytes(path("s.csv")), testing::StartsWith("view,tiles,seen,median_ms"));
    EXPECT_THAT(test::read_bytes(path("s.md")), HasSubstr("| all seen | "));
    EXPECT_THAT(test::read_bytes(path("page/index.html")), HasSubstr("lod-selection"));
}

// Results that earlier versions wrote are read, too.
TEST(SuiteDocuments, CommittedResultsAreOfTheOneSchema) {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(
             std::filesystem::path(RELJEF_SOURCE) / "bench" / "results")) {
        if (entry.path().extension() == ".json") {
            const auto read = read_document(entry.path());
            EXPECT_TRUE(read) << (read ? "" : read.error().message);
            ++count;
        }
    }
    EXPECT_GT(count, 40U);
}

} // namespace
} // namespace reljef::bench
