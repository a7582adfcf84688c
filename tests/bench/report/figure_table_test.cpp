#include "bench/report/figure_table.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bench/report/made_figures.h"

namespace reljef::bench {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

TEST(FigureTable, HasTheHeadAndTheColumnsOfADocument) {
    FigureTable table = test::made_figures();
    table.shard = {1, 3};
    table.end.stopped = Error{"interrupted"};
    const json report = json::parse(figure_json(table));
    EXPECT_EQ(report.at("schema"), "reljef-bench/1");
    EXPECT_EQ(report.at("suite"), "peers");
    EXPECT_EQ(report.at("complete"), false);
    EXPECT_EQ(report.at("stopped"), "interrupted");
    EXPECT_EQ(report.at("notes"), json::array({"A note."}));
    EXPECT_EQ(report.at("environment").at("cpu"), "a processor");
    EXPECT_EQ(report.at("shard"), "1/3");
    EXPECT_EQ(report.at("settings"), json({{"quick", true}, {"size", "64x48"}}));
    EXPECT_EQ(report.at("columns").at(0),
              json({{"key", "/scene"}, {"heading", "terrain"}, {"role", "group"}}));
    EXPECT_EQ(report.at("columns").at(2), json({{"key", "/ms/median"},
                                                {"heading", "median"},
                                                {"role", "measured"},
                                                {"unit", "ms"},
                                                {"better", "less"},
                                                {"noise", "/noise"}}));
    EXPECT_EQ(report.at("columns").at(3).at("detail"), true);
    EXPECT_EQ(report.at("columns").at(6).at("limit"), "/limit");
    EXPECT_EQ(report.at("rows").at(0).at("ms").at("median"), 10.0);
    EXPECT_TRUE(report.at("rows").at(1).at("error").is_null());
}

TEST(FigureTable, InfiniteFiguresAreNull) {
    FigureTable table = test::made_figures();
    table.rows[0][4] = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(json::parse(figure_json(table)).at("rows").at(0).at("error").at("px").is_null());
    EXPECT_THAT(figure_text(table), HasSubstr("∞"));
    EXPECT_THAT(figure_csv(table), HasSubstr("natural,ours,10.0,0.05,,100"));
}

TEST(FigureTable, EachGroupIsATableWithoutEmptyColumns) {
    const std::string text = figure_text(test::made_figures());
    EXPECT_THAT(text, testing::StartsWith("peers: quick, size 64x48\na renderer, 2 threads\n\n"
                                          "natural\nwhat"));
    const std::string urban = text.substr(text.find("urban"));
    EXPECT_THAT(text, HasSubstr("sent MB"));
    EXPECT_THAT(urban, Not(HasSubstr("sent MB")));
    EXPECT_THAT(text, Not(HasSubstr("noise"))); // a detail
    EXPECT_THAT(urban, HasSubstr("median ms  error px"));
    EXPECT_THAT(urban, testing::EndsWith("\nA note.\n"));
}

TEST(FigureTable, MarkdownHasAHeadingForEachGroup) {
    FigureTable table = test::made_figures();
    table.rows[0][1] = "a|b";
    table.end.stopped = Error{"interrupted"};
    const std::string text = figure_markdown(table);
    EXPECT_THAT(text, testing::StartsWith("# reljef-bench peers\n\n- quick, size 64x48\n"));
    EXPECT_THAT(text, HasSubstr("## urban\n\n| what | median ms |"));
    EXPECT_THAT(text, HasSubstr("| a\\|b | 10.00 |"));
    EXPECT_THAT(text, HasSubstr("Ended early: interrupted"));
}

TEST(FigureTable, ASingleRowIsShownByLines) {
    FigureTable table = test::made_figures();
    table.rows.resize(1);
    EXPECT_THAT(figure_markdown(table), HasSubstr("| median ms | 10.00 |\n| error px | 0.500 |"));
}

TEST(FigureTable, CsvHasALineForEachRow) {
    EXPECT_EQ(figure_csv(test::made_figures()),
              "scene,what,ms.median,noise,error.px,rate,value,limit,bytes\n"
              "natural,ours,10.0,0.05,0.5,100,1.0,3.0,2500000\n"
              "natural,\"theirs, too\",20.0,0.05,,50,1.0,3.0,\n"
              "urban,ours,12.0,0.05,0.25,80,2.0,3.0,\n");
}

} // namespace
} // namespace reljef::bench
