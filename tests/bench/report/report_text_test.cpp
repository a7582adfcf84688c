#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/report/report_text.h"
#include "tests/bench/report/made_results.h"

namespace reljef::bench {
namespace {

using testing::HasSubstr;

// The fields of CSV lines (RFC 4180).
std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
    std::vector<std::vector<std::string>> lines(1, {""});
    bool is_quoted = false;
    for (const char c : text) {
        if (c == '"') {
            is_quoted = !is_quoted;
        } else if (c == ',' && !is_quoted) {
            lines.back().emplace_back();
        } else if (c == '\n' && !is_quoted) {
            lines.push_back({""});
        } else {
            lines.back().back() += c;
        }
    }
    lines.pop_back();
    return lines;
}

std::string field(const std::vector<std::vector<std::string>>& lines, std::size_t row,
                  const std::string& name) {
    const auto at = std::find(lines[0].begin(), lines[0].end(), name) - lines[0].begin();
    return lines[row + 1].at(static_cast<std::size_t>(at));
}

TEST(CsvReport, every_line_has_every_field) {
    Results results = test::made_source_results();
    results.rows[1].error.reset();
    results.rows[0].error->reprojection_px.reset();
    results.rows[0].error->hit_texels.reset();
    const auto lines = parse_csv(csv_report(results));
    ASSERT_EQ(lines.size(), results.rows.size() + 1);
    for (const auto& line : lines) {
        EXPECT_EQ(line.size(), lines[0].size());
    }
}

TEST(CsvReport, figures_stand_below_their_names) {
    const auto lines = parse_csv(csv_report(test::made_source_results()));
    EXPECT_EQ(field(lines, 1, "test"), "relief-4");
    EXPECT_EQ(field(lines, 1, "technique"), "polygons:lods=1");
    EXPECT_EQ(field(lines, 1, "width"), "1024");
    EXPECT_EQ(field(lines, 1, "median_ms"), "8");
    EXPECT_EQ(field(lines, 1, "fps"), "125");
    EXPECT_EQ(field(lines, 1, "noise_floor"), "0.05");
    EXPECT_EQ(field(lines, 1, "triangles"), "2097152");
    EXPECT_EQ(field(lines, 1, "reprojection_rms_px"), "0.25");
    EXPECT_EQ(field(lines, 1, "reprojection_max_px"), "1");
    EXPECT_EQ(field(lines, 1, "hit_max_texels"), "1");
    EXPECT_EQ(field(lines, 1, "wrong_percent"), "1.25");
    EXPECT_EQ(field(lines, 1, "flip"), "0.02");
    EXPECT_EQ(field(lines, 1, "source_fps"), "5");
    EXPECT_EQ(field(lines, 2, "missing"), "false");
    EXPECT_EQ(field(lines, 2, "source_fps"), "55");
    EXPECT_EQ(field(lines, 3, "null_row"), "true");
}

TEST(CsvReport, names_what_was_drawn_without_a_proof) {
    Results results = test::made_results("natural");
    results.rows[1].timing.stats.choice =
        view::Choice{.tiles_by_rays = 3, .typical = view::TypicalChoice{"interval:n=4,k=2", 0.93}};
    const auto lines = parse_csv(csv_report(results));
    EXPECT_EQ(field(lines, 0, "unproven_search"), "");
    EXPECT_EQ(field(lines, 1, "unproven_search"), "interval:n=4,k=2");
}

TEST(CsvReport, names_with_commas_quotes_and_lines_stay_one_field) {
    const auto text = csv_report(test::made_results("a,\"b\"\nc.tif"));
    EXPECT_THAT(text, HasSubstr("\"a,\"\"b\"\"\nc.tif\""));
    for (const auto& line : parse_csv(text)) {
        EXPECT_EQ(line.size(), parse_csv(text)[0].size());
    }
}

TEST(MarkdownReport, holds_the_tables_and_the_environment) {
    const std::string report = markdown_report(test::made_source_results());
    EXPECT_THAT(report, HasSubstr("# reljef-bench tables\n"));
    EXPECT_THAT(report, HasSubstr("a processor"));
    EXPECT_THAT(report, HasSubstr("## relief-4: natural 1025"));
    EXPECT_THAT(report, HasSubstr("| polygons:lods=1 | 8.00 |"));
}

TEST(MarkdownReport, lines_of_a_table_have_as_many_cells) {
    std::istringstream lines(markdown_report(test::made_source_results()));
    std::ptrdiff_t bars = 0;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('|')) {
            const auto count = std::count(line.begin(), line.end(), '|');
            EXPECT_EQ(count, bars == 0 ? count : bars) << line;
            bars = count;
        }
    }
    EXPECT_GT(bars, 0);
}

TEST(MarkdownReport, names_are_text_and_no_markup) {
    const std::string report = markdown_report(test::made_results("a|b<i>*x*</i>_\n# c.tif"));
    EXPECT_THAT(report, HasSubstr("a\\|b\\<i\\>\\*x\\*\\</i\\>\\_\\\\x0a\\# c.tif"));
}

} // namespace
} // namespace reljef::bench
