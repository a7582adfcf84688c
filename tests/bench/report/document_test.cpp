#include "bench/report/document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/report/report_json.h"
#include "tests/bench/report/made_figures.h"
#include "tests/bench/report/made_results.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Documents : public testing::Test {
protected:
    std::string refusal(const std::string& text) {
        const auto read = read_document(folder_.write("d.json", text));
        return read ? "" : read.error().message;
    }

    // The error of a document after the value at a JSON pointer is replaced.
    std::string refusal(const std::string& pointer, const json& value) {
        json report = json::parse(figure_json(test::made_figures()));
        report[json::json_pointer(pointer)] = value;
        return refusal(report.dump());
    }

    test::TemporaryFolder folder_;
};

TEST_F(Documents, AreReadAsTheyWereWritten) {
    FigureTable table = test::made_figures();
    table.shard = {1, 3};
    table.summary = {{"over", 3}};
    table.end.stopped = Error{"interrupted"};
    const std::string text = figure_json(table);
    const auto read = read_document(folder_.write("d.json", text));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(suite_of(*read), "peers");
    EXPECT_EQ(figure_json(std::get<FigureTable>(*read)), text);
}

TEST_F(Documents, OfTechniquesHaveNoColumns) {
    const std::string text = json_report(test::made_results());
    const auto file = folder_.write("d.json", text);
    const auto read = read_document(file);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(suite_of(*read), "tables");
    EXPECT_EQ(json_report(std::get<Results>(*read)), text);
    const auto refused =
        read_json_report(folder_.write("f.json", figure_json(test::made_figures())));
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message,
                HasSubstr("suite: \"peers\" found, a suite of techniques was expected"));
}

TEST_F(Documents, OfOtherSchemasNameBoth) {
    EXPECT_THAT(refusal("/schema", "reljef-bench-peers/1"),
                HasSubstr("d.json: schema: \"reljef-bench-peers/1\" found, \"reljef-bench/1\" was "
                          "expected"));
}

TEST_F(Documents, DamageIsNamedWithItsPlace) {
    const std::vector<std::tuple<std::string, json, std::string>> damages{
        {"/columns", json::array(), "columns: "},
        {"/columns/1/key", "/scene", "columns[1].key: \"/scene\" found, a place in a row"},
        {"/columns/1/key", "/ms", "columns[2].key: \"/ms/median\" found, a place in a row"},
        {"/columns/1/key", "what", "columns[1].key: \"what\" found, a place in a row"},
        {"/columns/1/key", "/wh~t", "columns[1].key: \"/wh~t\" found, a place in a row"},
        {"/columns/1/key", "/0", "columns[1].key: \"/0\" found, a place in a row"},
        {"/columns/1/key", "/what/", "columns[1].key: \"/what/\" found, a place in a row"},
        {"/columns/1/role", "title", "columns[1].role: \"title\" found, group, name or measured"},
        {"/columns/2/better", "most", "columns[2].better: \"most\" found, less or more"},
        {"/columns/2/unit", 3, "columns[2].unit"},
        {"/rows", 5, "rows: 5 found"},
        {"/rows/1", 5, "rows[1]: 5 found, an object was expected"},
        {"/rows/1/ms/median", "fast", "rows[1]/ms/median: \"fast\" found, a number was expected"},
        {"/settings", nullptr, "settings: "},
        {"/environment", nullptr, "environment: "}};
    for (const auto& [pointer, value, part] : damages) {
        EXPECT_THAT(refusal(pointer, value), testing::AllOf(HasSubstr("d.json: "), HasSubstr(part)))
            << pointer << value;
    }
}

TEST_F(Documents, PartsAreReadAsOneRun) {
    const std::string name = (folder_.path() / "part-%d.json").string();
    const auto write_part = [&](int index, FigureTable table) {
        table.shard = {index, 2};
        folder_.write("part-" + std::to_string(index) + ".json", figure_json(table));
    };
    write_part(0, test::made_figures());
    write_part(1, test::made_figures());
    const auto all = read_document_parts(name);
    ASSERT_TRUE(all) << all.error().message;
    EXPECT_EQ(std::get<FigureTable>(*all).rows.size(), 6U);
    EXPECT_TRUE(std::get<FigureTable>(*all).shard.is_whole());

    FigureTable other = test::made_figures();
    other.suite = "flight";
    write_part(1, other);
    const auto refused = read_document_parts(name);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("parts with different columns found"));
}

TEST_F(Documents, PartsWithoutAShardAreNotOneOfThem) {
    for (const std::string& text :
         {figure_json(test::made_figures()), json_report(test::made_results())}) {
        const auto first = folder_.write("part-0.json", text);
        EXPECT_TRUE(read_document_parts(folder_.path() / "part-%d.json"));
        folder_.write("part-1.json", text);
        const auto refused = read_document_parts(folder_.path() / "part-%d.json");
        ASSERT_FALSE(refused);
        EXPECT_THAT(refused.error().message,
                    testing::AllOf(testing::StartsWith(first.string() + ": a whole run found"),
                                   HasSubstr("names its shard was expected")));
        std::filesystem::remove(folder_.path() / "part-1.json");
    }
}

} // namespace
} // namespace reljef::bench
