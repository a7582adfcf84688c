#include "bench/report/report_text.h"

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bench/report/made_results.h"

namespace reljef::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string line_with(const std::string& report, const std::string& word) {
    std::istringstream lines(report);
    for (std::string line; std::getline(lines, line);) {
        if (line.find(word) != std::string::npos) {
            return line;
        }
    }
    return {};
}

// Width of UTF-8 text on the screen.
std::size_t width_of(const std::string& line) {
    std::size_t width = 0;
    for (const char c : line) {
        width += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1U : 0U;
    }
    return width;
}

TEST(TerminalReport, row_holds_time_interval_rates_ratio_drop_and_error) {
    const std::string row = line_with(terminal_report(test::made_results()), "polygons");
    for (const char* part :
         {"polygons:lods=1", "8.00", "10.0 %", "125", "62.5", "4.00", "75 %", "0.250", "1.2 %"}) {
        EXPECT_THAT(row, HasSubstr(part));
    }
}

TEST(TerminalReport, heading_holds_scene_pose_size_frames_and_floor) {
    EXPECT_THAT(terminal_report(test::made_results()),
                HasSubstr("natural, overview, 1024x768, 20 frames, noise floor 5.0 %\n"));
}

TEST(TerminalReport, sources_figures_stand_beside_ours) {
    const std::string report = terminal_report(test::made_source_results());
    EXPECT_THAT(report, HasSubstr("relief-4: natural 1025"));
    EXPECT_THAT(line_with(report, "polygons:lods=1"), HasSubstr("164.80"));
    EXPECT_THAT(terminal_report(test::made_results()), Not(HasSubstr("source")));
}

TEST(TerminalReport, noisy_table_says_so) {
    Results results = test::made_results();
    EXPECT_THAT(terminal_report(results), Not(HasSubstr("NOISY")));
    for (Row& row : results.rows) {
        row.timing.noise_floor = 0.123;
    }
    EXPECT_THAT(terminal_report(results), HasSubstr("noise floor 12.3 %: NOISY\n"));
}

TEST(TerminalReport, fronts_and_what_they_dominate_are_named) {
    Results results = test::made_results();
    results.fronts = {{"natural", scene::Pose::low, 0.25, {"a", "b"}, {{"c", "b"}}, {"d"}}};
    const std::string report = terminal_report(results);
    EXPECT_THAT(report, HasSubstr("natural, low: front a, b; area 0.250\n"));
    EXPECT_THAT(report, HasSubstr("c is dominated by b\n"));
    EXPECT_THAT(report, HasSubstr("holes over 0.1 % of the picture: d\n"));
    results.fronts[0].area.reset();
    EXPECT_THAT(terminal_report(results), HasSubstr("low: front a, b; no area"));
    results.fronts[0].front.clear();
    EXPECT_THAT(terminal_report(results), HasSubstr("low: front none; no area"));
}

TEST(TerminalReport, pixels_without_a_bound_are_told_beside_the_rms) {
    Results results = test::made_results();
    results.rows[1].error->reprojection_px->unbounded = 17;
    const std::string report = terminal_report(results);
    EXPECT_THAT(line_with(report, "polygons"), HasSubstr("≥0.250"));
    EXPECT_THAT(line_with(report, "texture"), Not(HasSubstr("≥")));
    EXPECT_THAT(report, HasSubstr("not in it: polygons:lods=1 17\n"));
}

TEST(TerminalReport, ratio_is_no_figure_where_texture_shows_nothing) {
    Results results = test::made_results();
    results.rows[0].error->reprojection_px.reset();
    for (Row& row : results.rows) {
        row.timing.ratio_to_texture.reset();
    }
    const std::string report = terminal_report(results);
    EXPECT_THAT(line_with(report, "polygons"), HasSubstr("–     –"));
    EXPECT_THAT(report, HasSubstr("shows nothing of the terrain here, so its time says nothing: "
                                  "texture\n"));
    EXPECT_THAT(report, HasSubstr(", noise floor 5.0 %\n"));
    results.rows[2].setting = results.rows[1].setting;
    EXPECT_THAT(terminal_report(results), HasSubstr(", noise floor of polygons:lods=1 5.0 %\n"));
}

TEST(TerminalReport, floor_of_the_pictures_errors_is_that_of_exact) {
    Results results = test::made_results();
    EXPECT_THAT(terminal_report(results), Not(HasSubstr("floor of the pictures")));
    results.rows[1].setting = {"exact", {}, "exact"};
    const std::string report = terminal_report(results);
    EXPECT_THAT(report, HasSubstr("that of exact: FLIP 0.020, PSNR 40.0 dB, SSIM 0.975\n"));
    EXPECT_THAT(report, HasSubstr("colour map included"));
}

TEST(TerminalReport, says_on_what_it_was_measured) {
    const std::string report = terminal_report(test::made_results());
    for (const char* part : {"a renderer", "4.5 of it", "osmesa", "2 threads", "a processor",
                             "0123456789ab", "1024x768", "overview"}) {
        EXPECT_THAT(report, HasSubstr(part));
    }
}

TEST(TerminalReport, columns_line_up_whatever_the_names_length) {
    Results results = test::made_results("Međimurje.tif");
    results.rows[0].setting.label = "ć";
    results.rows[1].setting.label = "a name that is longer than any column";
    const std::string report = terminal_report(results);
    const std::string heading = line_with(report, "1 % low");
    ASSERT_FALSE(heading.empty());
    for (const char* name : {"ć", "longer than any"}) {
        EXPECT_EQ(width_of(line_with(report, name)), width_of(heading)) << report;
    }
}

TEST(TerminalReport, fits_the_screen_with_the_built_in_terrains) {
    Results results = test::made_source_results();
    results.rows[2].setting.label = "parallax:offset=-0.5";
    std::istringstream lines(terminal_report(results));
    for (std::string line; std::getline(lines, line);) {
        EXPECT_LE(width_of(line), 100U) << line;
    }
}

TEST(TerminalReport, name_neither_forges_a_line_nor_steers_the_terminal) {
    Results results = test::made_results("a\nb\x1b[31m\xC2\x9B\x7F.tif");
    results.rows[1].setting.label = "c\rd";
    const std::string report = terminal_report(results);
    EXPECT_THAT(report, HasSubstr("a\\x0ab\\x1b[31m\\x9b\\x7f.tif, overview"));
    EXPECT_THAT(report, HasSubstr("c\\x0dd"));
    EXPECT_EQ(report.find_first_of("\x1b\r\x7F"), report.npos);
}

TEST(TerminalReport, long_notes_and_fronts_are_broken_between_words) {
    Results results = test::made_source_results();
    const std::vector<std::string> many(40, "relief:n=11,k=8");
    results.fronts = {{"natural", scene::Pose::low, 0.25, many, {{many[0], many[1]}}, {}}};
    results.notes = {"Ć" + std::string(60, 'x') + " " + std::string(38, 'y'),
                     "Ć" + std::string(60, 'x') + " " + std::string(39, 'y')};
    const std::string report = terminal_report(results);
    std::istringstream lines(report);
    for (std::string line; std::getline(lines, line);) {
        EXPECT_LE(width_of(line), 100U) << line;
    }
    EXPECT_THAT(report, HasSubstr("x " + std::string(38, 'y') + "\n"));
    EXPECT_THAT(report, HasSubstr("x\n  " + std::string(39, 'y') + "\n"));
    EXPECT_THAT(report, HasSubstr(many[0] + "; area 0.250\n"));
}

TEST(TerminalReport, times_below_a_millisecond_keep_their_digits) {
    Results results = test::made_results();
    results.rows[0].timing.ms = {0.042, 0.051, 0.06};
    EXPECT_THAT(terminal_report(results), HasSubstr("0.042"));
}

TEST(TerminalReport, floor_that_was_not_measured_is_told) {
    Results results = test::made_results();
    results.rows.resize(1);
    results.rows[0].timing.noise_floor.reset();
    EXPECT_THAT(terminal_report(results), HasSubstr("noise floor unknown"));
}

TEST(TerminalReport, cautions_about_too_few_frames) {
    Results results = test::made_results();
    EXPECT_THAT(terminal_report(results), Not(HasSubstr("Caution")));
    results.rows[1].timing.frames = 4;
    EXPECT_THAT(terminal_report(results), HasSubstr("Caution: under 5 frames"));
}

} // namespace
} // namespace reljef::bench
