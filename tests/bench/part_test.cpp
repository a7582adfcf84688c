// Parts of a run that several processes measure.
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/suites/pareto_suite.h"
#include "tests/bench/bench_program.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using ::testing::HasSubstr;

std::vector<std::string> names_of(const std::vector<Group>& groups) {
    std::vector<std::string> names;
    for (const Group& group : groups) {
        names.push_back(group.scene.terrain + group.scene.detail + " " +
                        std::string(scene::to_string(group.pose)));
    }
    return names;
}

TEST(BenchParts, EachSceneAndPoseIsMeasuredByOneShard) {
    ParetoOptions options;
    const auto whole = names_of(pareto_groups(options));
    for (const int count : {1, 2, 5, 100}) {
        std::multiset<std::string> all;
        for (int index = 0; index < count; ++index) {
            options.shard = {index, count};
            for (const std::string& name : names_of(pareto_groups(options))) {
                all.insert(name);
            }
        }
        EXPECT_EQ(all, std::multiset<std::string>(whole.begin(), whole.end())) << count;
    }
}

class BenchPartFiles : public testing::Test {
protected:
    [[nodiscard]] test::ProgramResult pareto(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"pareto", "--terrain", dem_,          "--size",
                                           "32x24",  "--context", "osmesa",      "--rounds",
                                           "2",      "--quiet",   "--technique", "parallax"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::reljef_bench(arguments);
    }
    [[nodiscard]] test::ProgramResult stress(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"stress",    "--terrain",      dem_,     "--quick",
                                           "--context", "osmesa",         "--only", "camera-path",
                                           "--only",    "tangent-frames", "--only", "depth-order",
                                           "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::reljef_bench(arguments);
    }
    [[nodiscard]] std::string file(const std::string& name) const {
        return (folder_.path() / name).string();
    }
    test::TemporaryFolder folder_;
    std::string dem_ = folder_.write("dem.asc", test::small_dem).string();
};

TEST_F(BenchPartFiles, AreComparedAsOneRunAndDoneOnce) {
    for (const char* part : {"0/2", "1/2"}) {
        const auto result = pareto({"--shard", part, "--json", file("part-%d.json")});
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }
    ASSERT_EQ(pareto({"--json", file("whole.json")}).exit_code, 0);
    const auto compared = test::reljef_bench(
        {"compare", file("whole.json"), file("part-%d.json"), "--threshold", "1000000"});
    EXPECT_EQ(compared.exit_code, 0) << compared.out << compared.err;
    const std::string before = test::read_bytes(file("part-1.json"));
    const auto again = pareto({"--shard", "1/2", "--json", file("part-%d.json"), "--resume"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(again.out, "") << "it was complete";
    EXPECT_EQ(test::read_bytes(file("part-1.json")), before);
    std::filesystem::remove(file("part-1.json"));
    EXPECT_EQ(test::reljef_bench({"compare", file("whole.json"), file("part-%d.json")}).exit_code,
              1);
    const auto resumed = pareto({"--shard", "1/2", "--json", file("part-%d.json"), "--resume"});
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_NE(resumed.out, "");
}

// What does not depend on the time: of each row, in the order of the rows.
std::vector<nlohmann::json> untimed_rows(const std::string& file) {
    std::vector<nlohmann::json> rows;
    const auto report = nlohmann::json::parse(test::read_bytes(file));
    for (const auto& row : report.at("rows")) {
        rows.push_back({row.at("scene"), row.at("pose"), row.at("label"), row.at("null_row"),
                        row.at("triangles"), row.at("work"), row.at("error")});
    }
    return rows;
}

TEST_F(BenchPartFiles, AreMergedIntoTheReportOfOneProcess) {
    for (const char* part : {"0/3", "1/3", "2/3"}) {
        const auto result = pareto({"--shard", part, "--json", file("part-%d.json")});
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }
    ASSERT_EQ(pareto({"--json", file("whole.json")}).exit_code, 0);
    const auto merged =
        test::reljef_bench({"pareto", "--merge", file("part-%d.json"), "--json", file("all.json"),
                            "--csv", file("all.csv"), "--html", file("page")});
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_THAT(merged.out, HasSubstr("parallax"));
    EXPECT_EQ(untimed_rows(file("all.json")), untimed_rows(file("whole.json")));
    EXPECT_FALSE(nlohmann::json::parse(test::read_bytes(file("all.json"))).contains("shard"));
    EXPECT_FALSE(test::read_bytes(file("all.csv")).empty());
    EXPECT_THAT(test::read_bytes(file("page/index.html")), HasSubstr("parallax"));
    std::filesystem::remove(file("part-2.json"));
    const auto missing =
        test::reljef_bench({"pareto", "--merge", file("part-%d.json"), "--json", file("b.json")});
    EXPECT_EQ(missing.exit_code, 1);
    EXPECT_THAT(missing.err, HasSubstr("part-2.json"));
    EXPECT_FALSE(std::filesystem::exists(file("b.json")));
}

TEST_F(BenchPartFiles, MergingMeasuresNothingAndReplacesNoPart) {
    folder_.write("part-0.json", "earlier");
    for (const std::vector<std::string>& more :
         std::vector<std::vector<std::string>>{{"--shard", "0/2"},
                                               {"--terrain", dem_},
                                               {"--rounds", "5"},
                                               {"--json", file("part-0.json")}}) {
        for (const char* suite : {"pareto", "stress"}) {
            std::vector<std::string> arguments{suite, "--merge", file("part-%d.json")};
            arguments.insert(arguments.end(), more.begin(), more.end());
            const auto result = test::reljef_bench(arguments);
            EXPECT_EQ(result.exit_code, 2) << result.err;
            EXPECT_THAT(result.err, HasSubstr("--merge"));
        }
    }
    EXPECT_EQ(test::read_bytes(file("part-0.json")), "earlier");
}

TEST_F(BenchPartFiles, DamagedResultsAreMeasuredAgain) {
    for (const char* json : {"", "{", "[]", R"({"complete": false, "shard": "0/4"})",
                             R"({"complete": true, "shard": "1/4"})", R"({"complete": true})"}) {
        folder_.write("p.json", json);
        const auto result = pareto({"--shard", "0/4", "--json", file("p.json"), "--resume"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_NE(result.out, "") << json;
    }
}

TEST_F(BenchPartFiles, MisuseIsRefused) {
    EXPECT_EQ(pareto({"--resume"}).exit_code, 2);
    EXPECT_EQ(pareto({"--shard", "4/4"}).exit_code, 2);
    const auto none = pareto({"--shard", "4/5"});
    EXPECT_EQ(none.exit_code, 1);
    EXPECT_THAT(none.err, HasSubstr("4/5 found, but there are fewer scenes and poses"));
}

TEST_F(BenchPartFiles, StressesAreDividedToo) {
    std::set<std::string> all;
    for (const char* part : {"0/2", "1/2"}) {
        const auto result = stress({"--shard", part, "--json", file("stress-%d.json")});
        ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
        const auto json = nlohmann::json::parse(
            test::read_bytes(file(std::string("stress-") + part[0] + ".json")));
        EXPECT_EQ(json.at("shard"), part);
        std::set<std::string> own;
        for (const auto& row : json.at("rows")) {
            own.insert(row.at("stress").get<std::string>());
        }
        EXPECT_EQ(own.size(), part[0] == '0' ? 2U : 1U);
        all.insert(own.begin(), own.end());
    }
    EXPECT_EQ(all, (std::set<std::string>{"camera path", "depth order", "tangent frames"}));
    EXPECT_EQ(stress({"--shard", "3/4", "--json", file("stress-%d.json")}).exit_code, 1);
}

TEST_F(BenchPartFiles, StressesAreMergedIntoTheReportOfOneProcess) {
    for (const char* part : {"0/2", "1/2"}) {
        const auto result = stress({"--shard", part, "--json", file("stress-%d.json")});
        ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
    }
    const auto whole = stress({"--json", file("whole.json")});
    ASSERT_EQ(whole.exit_code, 0) << whole.err;
    const auto merged = test::reljef_bench({"stress", "--merge", file("stress-%d.json"), "--json",
                                            file("all.json"), "--html", file("page")});
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_EQ(test::read_bytes(file("all.json")), test::read_bytes(file("whole.json")));
    EXPECT_EQ(merged.out, whole.out);
    EXPECT_THAT(test::read_bytes(file("page/index.html")), HasSubstr("tangent frames"));
    const std::string before = test::read_bytes(file("stress-1.json"));
    const auto again = stress({"--shard", "1/2", "--json", file("stress-%d.json"), "--resume"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(again.out, "") << "it was complete";
    EXPECT_EQ(test::read_bytes(file("stress-1.json")), before);
}

} // namespace
} // namespace reljef::bench
