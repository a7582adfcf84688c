#include "bench/report_terminal.h"

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bench/made_results.h"

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

// Characters on the screen, for UTF-8.
std::size_t width_of(const std::string& line) {
    std::size_t width = 0;
    for (const char c : line) {
        width += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1U : 0U;
    }
    return width;
}

TEST(TerminalReport, row_holds_time_rate_ratio_triangles_and_floor) {
    const std::string row = line_with(terminal_report(test::made_results()), "polygons");
    for (const char* part : {"natural", "polygons:lods=1", "8.00", "9.00", "125.0", "4.00",
                             "2,097,152", "20", "5.0 %"}) {
        EXPECT_THAT(row, HasSubstr(part));
    }
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
    Results more = test::made_results("a name that is longer than any column.tif");
    results.rows.insert(results.rows.end(), more.rows.begin(), more.rows.end());
    const std::string report = terminal_report(results);
    const std::string heading = line_with(report, "median ms");
    ASSERT_FALSE(heading.empty());
    for (const char* name : {"Međimurje.tif", "longer than any"}) {
        EXPECT_EQ(width_of(line_with(report, name)), width_of(heading)) << report;
    }
}

TEST(TerminalReport, fits_the_screen_with_the_built_in_terrains) {
    std::istringstream lines(terminal_report(test::made_results()));
    for (std::string line; std::getline(lines, line);) {
        EXPECT_LE(width_of(line), 100U) << line;
    }
}

TEST(TerminalReport, times_below_a_millisecond_keep_their_digits) {
    Results results = test::made_results();
    results.rows[0].ms = {0.042, 0.051, 0.06};
    EXPECT_THAT(terminal_report(results), HasSubstr("0.042"));
}

TEST(TerminalReport, floor_that_was_not_measured_is_a_question_mark) {
    Results results = test::made_results();
    results.rows.resize(1);
    results.rows[0].noise_floor.reset();
    const std::string row = line_with(terminal_report(results), "natural");
    EXPECT_THAT(row, HasSubstr("?"));
    EXPECT_THAT(row, Not(HasSubstr("%")));
}

TEST(TerminalReport, cautions_about_too_few_frames) {
    Results results = test::made_results();
    EXPECT_THAT(terminal_report(results), Not(HasSubstr("Caution")));
    results.rows[1].frames = 4;
    EXPECT_THAT(terminal_report(results), HasSubstr("Caution: under 5 frames"));
}

} // namespace
} // namespace reljef::bench
