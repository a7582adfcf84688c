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
        const auto result = test::reljef_bench(
            {"stress", "--terrain", dem_, "--quick", "--only", "camera-path", "--only",
             "tangent-frames", "--quiet", "--shard", part, "--json", file("stress-%d.json")});
        ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
        const auto json = nlohmann::json::parse(
            test::read_bytes(file(std::string("stress-") + part[0] + ".json")));
        EXPECT_EQ(json.at("shard"), part);
        std::set<std::string> own;
        for (const auto& row : json.at("rows")) {
            own.insert(row.at("stress").get<std::string>());
        }
        EXPECT_EQ(own.size(), 1U);
        all.insert(own.begin(), own.end());
    }
    EXPECT_EQ(all, (std::set<std::string>{"camera path", "tangent frames"}));
}

} // namespace
} // namespace reljef::bench
