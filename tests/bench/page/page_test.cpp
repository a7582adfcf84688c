#include "bench/page/page.h"

#include <random>
#include <span>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/report/report_json.h"
#include "bench/stress/stress_results.h"
#include "bench/suites/compare.h"
#include "bench/suites/flight_suite.h"
#include "tests/bench/page/made_page.h"
#include "tests/bench/report/made_figures.h"
#include "tests/bench/report/made_results.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_program.h"

namespace reljef::bench {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (auto at = text.find(part); at != text.npos; at = text.find(part, at + part.size())) {
        ++count;
    }
    return count;
}

// The data that a page holds under an id.
std::string data_of(const std::string& page, const std::string& id) {
    const std::string opening = "<script type=\"application/json\" id=\"" + id + "\">";
    const auto begin = page.find(opening) + opening.size();
    return page.substr(begin, page.find("</script>", begin) - begin);
}

Result<void> write_page(const std::filesystem::path& folder, const Results& results) {
    auto page = prepare_page(folder, results);
    return page ? page->file.commit() : page.error();
}

void write_table(const std::filesystem::path& folder, const FigureTable& table) {
    auto page = prepare_page(folder, table);
    ASSERT_TRUE(page && page->file.commit());
}

std::string page_of(const Results& results) {
    const test::TemporaryFolder folder;
    const auto written = write_page(folder.path() / "page", results);
    EXPECT_TRUE(written) << written.error().message;
    return test::read_bytes(folder.path() / "page" / "index.html");
}

TEST(Page, holds_the_report_as_it_is) {
    const Results report = test::made_report();
    const std::string page = page_of(report);
    EXPECT_EQ(json::parse(data_of(page, "report")), json::parse(json_report(report)));
    EXPECT_EQ(count_of(page, "<!DOCTYPE html>"), 1U);
    EXPECT_EQ(count_of(page, "</html>"), 1U);
}

TEST(Page, refers_to_nothing_outside_itself) {
    const std::string page = page_of(test::with_pictures(test::made_report()));
    EXPECT_EQ(count_of(page, "src=\""), 0U);
    EXPECT_EQ(count_of(page, "url("), 0U);
    EXPECT_EQ(count_of(page, "@import"), 0U);
    EXPECT_EQ(count_of(page, "<link"), 1U); // an empty icon; without it browsers request one
    EXPECT_EQ(count_of(page, "http"), 2U);  // the policy, and the name of SVG
    EXPECT_THAT(page, HasSubstr("default-src 'none'"));
    EXPECT_THAT(page, Not(HasSubstr("{{")));
}

TEST(Page, no_name_ends_a_script_or_begins_markup) {
    for (const char* const name :
         {"</script><script>alert(1)</script>", "<!--<script>", "]]>{{pictures}}",
          "a\"b'c&amp;<img>", "\\u003c/script>", "</SCRIPT >"}) {
        const Results report = test::made_report(name);
        const std::string page = page_of(report);
        EXPECT_EQ(json::parse(data_of(page, "report")), json::parse(json_report(report))) << name;
        EXPECT_EQ(count_of(page, "<script"), count_of(page_of(test::made_report()), "<script"));
        EXPECT_EQ(data_of(page, "report").find('<'), std::string::npos) << name;
        EXPECT_EQ(count_of(page, "</html>"), 1U);
    }
}

TEST(Page, any_name_comes_back_as_it_was) {
    std::mt19937 random(7);
    const std::string letters = "<>&\"'\\/{}!-scriptSCRIPT\n\t=; \x7F\xC3\xA9";
    for (int round = 0; round < 200; ++round) {
        std::string name;
        for (int i = 0; i < 24; ++i) {
            name += letters[random() % (letters.size() - 2)]; // only whole UTF-8 letters
        }
        const std::string page = page_of(test::made_report(name));
        ASSERT_EQ(json::parse(data_of(page, "report"))["rows"].back()["scene"], name);
    }
}

TEST(Page, takes_what_the_json_report_writes) {
    const std::string page = page_of(test::made_results("caf\xE9.tif"));
    EXPECT_EQ(json::parse(data_of(page, "report")).at("rows").size(), 3U);
}

TEST(Page, rows_of_one_view_share_their_truth) {
    const json album =
        json::parse(data_of(page_of(test::with_pictures(test::made_report())), "album"));
    ASSERT_EQ(album.at("rows").size(), 3U);
    EXPECT_EQ(album.at("images").size(), 7U); // three pictures, three heat maps, one truth
    for (const json& row : album.at("rows")) {
        EXPECT_EQ(row.at("truth"), album.at("rows").at(0).at("truth"));
        EXPECT_NE(row.at("heat"), row.at("shown"));
        EXPECT_EQ(row.at("width"), 64);
        EXPECT_EQ(row.at("height"), 48);
        const auto image = [&](const char* key) {
            return album.at("images").at(row.at(key).get<std::size_t>()).get<std::string>();
        };
        EXPECT_THAT(image("shown"), testing::StartsWith("data:image/jpeg;base64,"));
        EXPECT_THAT(image("heat"), testing::StartsWith("data:image/png;base64,"));
    }
    EXPECT_EQ(album.at("scale").at("colors").size(), heat_levels);
}

TEST(Page, folder_is_made_where_its_parent_exists) {
    const test::TemporaryFolder folder;
    const auto refused = write_page(folder.path() / "none" / "page", test::made_report());
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("none"));
    EXPECT_TRUE(folder.names().empty());
    ASSERT_TRUE(write_page(folder.path() / "page", test::made_report()));
    EXPECT_EQ(folder.names(), std::vector<std::string>{"page"});
}

TEST(Page, file_in_place_of_the_folder_is_named_and_kept) {
    const test::TemporaryFolder folder;
    const auto file = folder.write("page", "earlier");
    for (const auto& refused : {write_page(file, test::made_report()), check_page_target(file)}) {
        ASSERT_FALSE(refused);
        EXPECT_THAT(refused.error().message, HasSubstr("page"));
    }
    EXPECT_EQ(test::read_bytes(file), "earlier");
}

TEST(Page, target_is_checked_without_a_trace) {
    const test::TemporaryFolder folder;
    EXPECT_TRUE(check_page_target(folder.path()));
    EXPECT_TRUE(check_page_target(folder.path() / "page"));
    const auto refused = check_page_target(folder.path() / "none" / "page");
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("none"));
    EXPECT_TRUE(folder.names().empty());
}

// RFC 4648, section 10.
TEST(DataUri, is_base64_as_the_standard_has_it) {
    const std::pair<std::string, std::string> vectors[] = {{"", ""},
                                                           {"f", "Zg=="},
                                                           {"fo", "Zm8="},
                                                           {"foo", "Zm9v"},
                                                           {"foob", "Zm9vYg=="},
                                                           {"fooba", "Zm9vYmE="},
                                                           {"foobar", "Zm9vYmFy"},
                                                           {"\xFF\xFE\xFB", "//77"}};
    for (const auto& [text, encoded] : vectors) {
        EXPECT_EQ(data_uri("a/b", std::as_bytes(std::span(text))), "data:a/b;base64," + encoded);
    }
}

// Stress, figures, a flight and a comparison, whose names are `hostile`.
void write_pages_with_columns(const std::filesystem::path& folder, const std::string& hostile) {
    StressResults stress;
    for (const double elevation : {90.0, 1.0}) {
        for (const char* technique : {"relief:n=11", "exact"}) {
            stress.add({.stress = "grazing view",
                        .terrain = hostile,
                        .technique = technique,
                        .figure = "% of pixels wrong",
                        .value = 0.1 * elevation,
                        .limit = 0.1,
                        .at = std::to_string(elevation) + " degrees"});
        }
    }
    write_table(folder / "stress", figure_table(stress));

    FigureTable figures = test::made_figures();
    figures.rows[0][0] = figures.rows[1][0] = hostile;
    write_table(folder / "figures", figures);
    FlightResults flight;
    flight.options.terrain.memory_megabytes = 64;
    flight.times.drawing_ms = {4.0, 5.0, 6.0};
    flight.times.waiting_ms = {0.0, 1.0, 9.0};
    write_table(folder / "flight", figure_table(flight));
    Results worse = test::made_results();
    worse.rows[1].error->flip = 0.9;
    write_table(folder / "compare",
                figure_table(compare(test::made_results(), worse), {.before = "a.json",
                                                                    .after = "b.json",
                                                                    .suite = "tables",
                                                                    .threshold = 0.1,
                                                                    .environment = {}}));
}

// Skipped without a browser.
TEST(PageInBrowser, loads_plots_sorts_wipes_and_fits_everywhere) {
    RELJEF_RELEASE_ONLY("the browser is not ours, and the page has tests of its own");
    const test::TemporaryFolder folder;
    const std::string hostile =
        "</script><script>window.broken=1</script><img src=x onerror=window.broken=2>.tif";
    ASSERT_TRUE(write_page(folder.path() / "tables", test::with_pictures(test::made_report())));
    ASSERT_TRUE(write_page(folder.path() / "pareto", test::made_pareto_report()));
    ASSERT_TRUE(
        write_page(folder.path() / "hostile", test::with_pictures(test::made_report(hostile))));

    Results bare = test::made_results();
    bare.stopped = Error{"interrupted"};
    for (Row& row : bare.rows) {
        row.error.reset();
    }
    ASSERT_TRUE(write_page(folder.path() / "bare", bare));

    write_pages_with_columns(folder.path(), hostile);

    const auto folder_of = [&](const char* name) { return (folder.path() / name).string(); };
    test::ProgramOptions options;
    options.environment["PYTHONDONTWRITEBYTECODE"] = "1";
    const auto result =
        test::run_program(RELJEF_PYTHON3,
                          {RELJEF_PAGE_BROWSER_TEST, folder_of("tables"), folder_of("pareto"),
                           folder_of("hostile"), folder_of("bare"), folder_of("stress"),
                           folder_of("figures"), folder_of("flight"), folder_of("compare")},
                          options);
    constexpr int skipped = 77;
    constexpr int not_started = 127;
    if (result.exit_code == skipped || result.exit_code == not_started) {
        GTEST_SKIP() << "python3, chromium and chromium-driver are needed: " << result.out;
    }
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
}

} // namespace
} // namespace reljef::bench
