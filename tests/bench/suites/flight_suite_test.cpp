#include "bench/suites/flight_suite.h"

#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/session/log.h"
#include "engine/session/terrain_index.h"
#include "tests/bench/bench_program.h"
#include "tests/support/process_state.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

/// 301 by 301 samples on Earth; a memory budget of 1 MB holds an overview.
std::string large_dem() {
    std::string text = "ncols 301\nnrows 301\nxllcenter 7\nyllcenter 45\ncellsize 0.001\n";
    for (int row = 0; row < 301; ++row) {
        for (int col = 0; col < 301; ++col) {
            text += std::to_string(500 + (col * 7 + row * 5) % 11) + " ";
        }
        text += "\n";
    }
    return text;
}

FlightOptions short_flight(const test::TemporaryFolder& folder) {
    FlightOptions options;
    options.terrain.terrain = folder.write("dem.asc", large_dem()).string();
    folder.write("dem.prj",
                 R"(GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,)"
                 R"(298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]])");
    options.terrain.memory_megabytes = 1;
    options.terrain.quiet = true;
    options.view.path =
        folder
            .write("line.geojson",
                   R"({"type":"LineString","coordinates":[[7.1,45.1,900],[7.2,45.2,900]]})")
            .string();
    options.view.frames = 4;
    options.view.size = {64, 48};
    options.view.context = session::BackendKind::osmesa;
    return options;
}

TEST(Flight, counts_what_it_read_took_and_waited_for) {
    const test::TemporaryFolder folder;
    const auto results = run_flight(short_flight(folder), {});
    ASSERT_TRUE(results) << results.error().message;
    EXPECT_FALSE(results->end.stopped);
    ASSERT_TRUE(results->stream);
    EXPECT_GT(results->stream->read, 1);
    // Counts the four bytes of each value, not the characters of the text.
    EXPECT_GE(results->stream->bytes_read, 4U * 129U * 129U);
    EXPECT_EQ(results->times.drawing_ms.size(), 4U);
    EXPECT_EQ(results->times.waiting_ms.size(), 4U);
    EXPECT_GE(results->seconds, results->seconds_to_first_frame);
    EXPECT_GE(results->max_memory, results->times.memory_before);
    const auto report = nlohmann::json::parse(figure_json(figure_table(*results)));
    EXPECT_EQ(report.at("suite"), "flight");
    ASSERT_EQ(report.at("rows").size(), 1U);
    const auto& row = report.at("rows").at(0);
    EXPECT_EQ(row.at("frames"), 4);
    EXPECT_EQ(row.at("tiles").at("read"), results->stream->read);
    EXPECT_EQ(row.at("memory").at("allowed"), 1 << 20);
}

TEST(Flight, that_does_not_wait_draws_what_is_there_and_states_its_error) {
    const test::TemporaryFolder folder;
    FlightOptions options = short_flight(folder);
    options.waits_for_tiles = false;
    options.view.max_error = 0.5;
    for (const auto context : {session::BackendKind::osmesa, session::BackendKind::cpu}) {
        options.view.context = context;
        options.terrain.placement = terrain::PlacementKind::plane;
        const auto results = run_flight(options, {});
        ASSERT_TRUE(results) << results.error().message;
        EXPECT_EQ(results->times.drawing_ms.size(), 4U);
        EXPECT_EQ(results->times.waiting_ms, std::vector<double>(4, 0.0));
        const auto report = nlohmann::json::parse(figure_json(figure_table(*results)));
        EXPECT_EQ(report.at("settings").at("waits_for_tiles"), false);
        const auto& row = report.at("rows").at(0);
        EXPECT_GE(row.at("kept_error_px"), row.at("median_kept_error_px"));
    }
}

TEST(Flight, UsesAnIndexThatIsThereAndTellsWhichOneItHad) {
    const test::TemporaryFolder folder;
    const test::EnvironmentVariable cache("XDG_CACHE_HOME", (folder.path() / "cache").string());
    FlightOptions options = short_flight(folder);
    options.terrain.index = session::IndexUse::existing;
    options.view.max_error = 0.5;
    for (const bool has_index : {false, true}) {
        if (has_index) {
            session::Log silent;
            const auto indexed = session::index_terrain(options.terrain, silent, {});
            ASSERT_TRUE(indexed) << indexed.error().message;
        }
        const auto results = run_flight(options, {});
        ASSERT_TRUE(results) << results.error().message;
        const auto report = nlohmann::json::parse(figure_json(figure_table(*results)));
        EXPECT_EQ(report.at("settings").at("index"), has_index ? "whole" : "none");
        EXPECT_EQ(results->max_tiles_unproven > 0, !has_index);
        EXPECT_EQ(report.at("rows").at(0).at("kept_error_px").is_number(), has_index);
    }
}

std::string few_samples(int cols, int rows) {
    std::string text = fmt::format(
        "ncols {}\nnrows {}\nxllcenter 7.1\nyllcenter 45.1\ncellsize 0.001\n", cols, rows);
    for (int i = 0; i < cols * rows; ++i) {
        text += fmt::format("{}\n", 500 + i);
    }
    return text;
}

TEST(Flight, OverFewSamplesDrawsEachFrameOrIsOneSentence) {
    const test::TemporaryFolder folder;
    FlightOptions options = short_flight(folder);
    for (const auto context : {session::BackendKind::osmesa, session::BackendKind::cpu}) {
        options.view.context = context;
        options.view.path = "orbit";
        for (const auto& [cols, rows] : {std::pair{1, 1}, {1, 2}, {2, 2}, {3, 3}}) {
            options.terrain.terrain = folder.write("few.asc", few_samples(cols, rows)).string();
            const auto results = run_flight(options, {});
            if (cols == 1) {
                ASSERT_FALSE(results);
                EXPECT_THAT(results.error().message,
                            testing::HasSubstr(fmt::format("has 1×{} samples", rows)));
            } else {
                ASSERT_TRUE(results) << results.error().message;
                EXPECT_EQ(results->times.drawing_ms.size(), 4U);
            }
        }
    }
}

TEST(Flight, AFileOfTooFewSamplesIsLeftOutReportedAndTheRestIsFlownOver) {
    const test::TemporaryFolder folder;
    FlightOptions options = short_flight(folder);
    for (const char* const name : {"dem.asc", "dem.prj"}) {
        folder.write(std::string("tiles/") + name, test::read_bytes(folder.path() / name));
    }
    folder.write("tiles/few.asc", few_samples(1, 2));
    folder.write("tiles/few.prj", test::read_bytes(folder.path() / "dem.prj"));
    options.terrain.terrain = (folder.path() / "tiles").string();
    const auto results = run_flight(options, {});
    ASSERT_TRUE(results) << results.error().message;
    EXPECT_EQ(results->times.drawing_ms.size(), 4U);
    EXPECT_EQ(results->failed_files, 1U);
    const auto checked = check_files(*results);
    ASSERT_FALSE(checked);
    EXPECT_THAT(checked.error().message, testing::HasSubstr("1 of the files asked for"));
    const auto report = nlohmann::json::parse(figure_json(figure_table(*results)));
    EXPECT_EQ(report.at("rows").at(0).at("faulty_files"), 1);
}

TEST(Flight, FromStandardInputNamesNoTemporaryFile) {
    const test::TemporaryFolder folder;
    test::ProgramOptions options;
    options.input = folder.write("dem.asc", test::small_dem);
    const auto json = folder.path() / "flight.json";
    const auto result =
        test::run_program(RELJEF_BENCH_BINARY,
                          {"flight", "-", "--path", "orbit", "--frames", "1", "--size", "16x12",
                           "--context", "osmesa", "--quiet", "--json", json.string()},
                          options);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(nlohmann::json::parse(test::read_bytes(json)).at("rows").at(0).at("terrain"), "-");
    EXPECT_THAT(result.out, testing::Not(testing::HasSubstr(".reljef-")));
}

TEST(Flight, that_is_stopped_says_so) {
    const test::TemporaryFolder folder;
    std::stop_source stop;
    stop.request_stop();
    const auto results = run_flight(short_flight(folder), stop.get_token());
    EXPECT_TRUE(!results || results->end.stopped);
}

} // namespace
} // namespace reljef::bench
