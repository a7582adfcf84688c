#include "bench/report/result_parts.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/report/report_json.h"
#include "tests/bench/report/made_results.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using ::testing::HasSubstr;

Results part(int index, int count, const std::string& scene) {
    Results results = test::made_results(scene);
    results.shard = {index, count};
    return results;
}

std::string error_of(std::vector<Results> parts) {
    const auto all = merged(std::move(parts));
    return all ? "" : all.error().message;
}

TEST(ResultParts, TheRowsOfAllPartsAreOneRun) {
    Results stopped = part(1, 2, "b");
    stopped.stopped = Error{"interrupted"};
    stopped.notes = {"noisy"};
    const auto all = merged({stopped, part(0, 2, "a")});
    ASSERT_TRUE(all) << all.error().message;
    ASSERT_EQ(all->rows.size(), 6U);
    EXPECT_EQ(all->rows.front().scene, "a");
    EXPECT_EQ(all->rows.back().scene, "b");
    EXPECT_TRUE(all->shard.is_whole());
    EXPECT_EQ(all->notes.size(), 1U);
    EXPECT_FALSE(all->complete());
}

TEST(ResultParts, RowsAndFrontsAreInTheOrderOfOneProcess) {
    Results first = part(0, 2, "a");
    Results second = part(1, 2, "b");
    const std::vector<Row> more = part(0, 2, "c").rows;
    first.rows.insert(first.rows.end(), more.begin(), more.end());
    const auto front_of = [](const std::string& scene) {
        Front front;
        front.scene = scene;
        return front;
    };
    first.fronts = {front_of("a"), front_of("c")};
    second.fronts = {front_of("b")};
    const auto all = merged({first, second});
    ASSERT_TRUE(all) << all.error().message;
    std::string scenes;
    for (const Row& row : all->rows) {
        scenes += row.scene;
    }
    EXPECT_EQ(scenes, "aaabbbccc");
    std::string fronts;
    for (const Front& front : all->fronts) {
        fronts += front.scene;
    }
    EXPECT_EQ(fronts, "abc");
}

// The same terrain twice, whose items follow each other in a part.
TEST(ResultParts, TheNullRowEndsAnItem) {
    Results first = part(0, 2, "a");
    const std::vector<Row> again = first.rows;
    first.rows.insert(first.rows.end(), again.begin(), again.end());
    const auto all = merged({first, part(1, 2, "b")});
    ASSERT_TRUE(all) << all.error().message;
    ASSERT_EQ(all->rows.size(), 9U);
    EXPECT_EQ(all->rows[3].scene, "b");
}

TEST(ResultParts, MissingAndForeignPartsAreRefused) {
    EXPECT_EQ(error_of({part(0, 2, "a"), part(1, 2, "b")}), "");
    EXPECT_THAT(error_of({}), HasSubstr("no parts"));
    EXPECT_THAT(error_of({part(0, 2, "a")}), HasSubstr("1 parts found, 2 were expected"));
    EXPECT_THAT(error_of({part(1, 2, "a")}), HasSubstr("part 1/2 found, 0/2 was expected"));
    EXPECT_THAT(error_of({part(0, 2, "a"), part(0, 2, "b")}), HasSubstr("1/2 was expected"));
    EXPECT_THAT(error_of({part(0, 2, "a"), part(1, 3, "b")}), HasSubstr("1/2 was expected"));
    Results other = part(1, 2, "b");
    other.environment.cpu = "another processor";
    EXPECT_THAT(error_of({part(0, 2, "a"), other}), HasSubstr("another environment"));
    other = part(1, 2, "b");
    other.environment.costs = "those of a calibration";
    EXPECT_THAT(error_of({part(0, 2, "a"), other}), HasSubstr("another environment"));
}

TEST(ResultParts, APartsFileKeepsItsNumber) {
    const test::TemporaryFolder folder;
    const auto name = folder.path() / "part-%d.json";
    for (const int index : {0, 1}) {
        const Results results = part(index, 2, index == 0 ? "a" : "b");
        folder.write("part-" + std::to_string(index) + ".json", json_report(results));
    }
    EXPECT_EQ(part_file(name, {1, 2}), folder.path() / "part-1.json");
    EXPECT_EQ(part_file("a.json", {1, 2}), "a.json");
    EXPECT_EQ(read_json_report(part_file(name, {1, 2}))->shard, (Shard{1, 2}));
    const auto all = read_result_parts(name);
    ASSERT_TRUE(all) << all.error().message;
    EXPECT_EQ(all->rows.size(), 6U);
    std::filesystem::remove(folder.path() / "part-1.json");
    const auto missing = read_result_parts(name);
    ASSERT_FALSE(missing);
    EXPECT_THAT(missing.error().message, HasSubstr("part-1.json"));
}

TEST(ResultParts, TheFilesThatAreThereAreCounted) {
    const test::TemporaryFolder folder;
    const auto name = folder.path() / "part-%d.json";
    EXPECT_TRUE(part_files(name).empty());
    const auto first = folder.write("part-0.json", "");
    const auto second = folder.write("part-1.json", "");
    folder.write("part-3.json", "");
    EXPECT_EQ(part_files(name), (std::vector{first, second}));
    EXPECT_EQ(part_files("a.json"), std::vector<std::filesystem::path>{"a.json"});
}

TEST(ResultParts, AWrongPartInAFileIsRefused) {
    const test::TemporaryFolder folder;
    for (const char* wrong : {"2/2", "auto", "", "-1/2"}) {
        std::string json = json_report(part(1, 2, "a"));
        const auto place = json.find("\"1/2\"");
        ASSERT_NE(place, std::string::npos);
        json.replace(place + 1, 3, wrong);
        const auto read = read_json_report(folder.write("p.json", json));
        ASSERT_FALSE(read) << wrong;
        EXPECT_THAT(read.error().message, HasSubstr("shard"));
    }
}

} // namespace
} // namespace reljef::bench
