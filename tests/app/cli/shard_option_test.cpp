#include "app/cli/shard_option.h"

#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/rendering/finished_frames.h"

namespace reljef::cli {
namespace {

using ::testing::HasSubstr;
using Variables = std::map<std::string, std::string>;

Result<Shard> parsed(const std::string& text, const Variables& variables = {}) {
    return parse_shard(text, [&](const char* name) {
        const auto found = variables.find(name);
        return found == variables.end() ? nullptr : found->second.c_str();
    });
}

std::string error_of(const std::string& text, const Variables& variables = {}) {
    const auto shard = parsed(text, variables);
    return shard ? shard_text(*shard) : shard.error().message;
}

TEST(ShardOption, EveryItemBelongsToExactlyOneShardOfAnyNumber) {
    for (const int items : {0, 1, 2, 7, 100, 101}) {
        for (const int count : {1, 2, 3, 7, 64, 150}) {
            std::vector<int> times(static_cast<std::size_t>(items));
            std::size_t largest = 0;
            std::size_t smallest = 1000;
            for (int index = 0; index < count; ++index) {
                const auto own = app::frames_of({index, count}, items);
                largest = std::max(largest, own.size());
                smallest = std::min(smallest, own.size());
                for (const int item : own) {
                    ++times.at(static_cast<std::size_t>(item));
                }
            }
            EXPECT_THAT(times, ::testing::Each(1)) << items << " items, " << count << " shards";
            EXPECT_LE(largest - smallest, 1U) << items << " items, " << count << " shards";
        }
    }
}

TEST(ShardOption, TheWholeIsTheOnlyShardOfOne) {
    EXPECT_TRUE(Shard().is_whole());
    EXPECT_TRUE(parsed("0/1")->is_whole());
    EXPECT_FALSE(parsed("0/2")->is_whole());
}

TEST(ShardOption, NumbersOutsideTheirRangeAreRefused) {
    EXPECT_EQ(*parsed("3/4"), (Shard{3, 4}));
    for (const char* text :
         {"",     "/",    "1",     "4/4",       "5/4",           "-1/2",          "0/0",
          "0/-1", "1/",   "/2",    "a/b",       "1/2/3",         "0x1/2",         "1 /2",
          "1/ 2", "+1/2", "1.0/2", "0/1000001", "99999999999/2", "0/99999999999", "AUTO"}) {
        EXPECT_THAT(error_of(text), HasSubstr("I/N with I from 0 to N-1")) << text;
        EXPECT_THAT(error_of(text), HasSubstr("'" + std::string(text) + "' found")) << text;
    }
}

TEST(ShardOption, LaunchersNumberTheirProcesses) {
    EXPECT_EQ(error_of("slurm", {{"SLURM_PROCID", "2"}, {"SLURM_NTASKS", "8"}}), "2/8");
    EXPECT_EQ(error_of("auto", {{"SLURM_PROCID", "2"}, {"SLURM_NTASKS", "8"}}), "2/8");
    const Variables mpi{{"OMPI_COMM_WORLD_RANK", "0"}, {"OMPI_COMM_WORLD_SIZE", "4"}};
    EXPECT_EQ(error_of("openmpi", mpi), "0/4");
    EXPECT_EQ(error_of("auto/4", mpi), "0/4");
    EXPECT_EQ(error_of("kubernetes/16", {{"JOB_COMPLETION_INDEX", "15"}}), "15/16");
    EXPECT_EQ(error_of("auto/16", {{"JOB_COMPLETION_INDEX", "15"}}), "15/16");
}

TEST(ShardOption, WrongVariablesAreNamed) {
    EXPECT_THAT(error_of("auto"), HasSubstr("none of $SLURM_PROCID"));
    EXPECT_THAT(error_of("slurm", {{"SLURM_PROCID", "0"}}), HasSubstr("$SLURM_NTASKS: ''"));
    EXPECT_THAT(error_of("slurm", {{"SLURM_NTASKS", "2"}}), HasSubstr("$SLURM_PROCID: ''"));
    EXPECT_THAT(error_of("slurm", {{"SLURM_PROCID", "2"}, {"SLURM_NTASKS", "2"}}),
                HasSubstr("$SLURM_PROCID: '2'"));
    EXPECT_THAT(error_of("slurm", {{"SLURM_PROCID", "x"}, {"SLURM_NTASKS", "2"}}),
                HasSubstr("$SLURM_PROCID: 'x'"));
    EXPECT_THAT(error_of("slurm", {{"SLURM_PROCID", "0"}, {"SLURM_NTASKS", "0"}}),
                HasSubstr("$SLURM_NTASKS: '0'"));
    EXPECT_THAT(error_of("kubernetes", {{"JOB_COMPLETION_INDEX", "1"}}),
                HasSubstr("kubernetes/N was expected"));
    EXPECT_THAT(error_of("kubernetes/1", {{"JOB_COMPLETION_INDEX", "1"}}),
                HasSubstr("$JOB_COMPLETION_INDEX: '1'"));
}

TEST(ShardOption, ContradictionsAreRefused) {
    const Variables slurm{{"SLURM_PROCID", "1"}, {"SLURM_NTASKS", "4"}};
    EXPECT_THAT(error_of("slurm/5", slurm), HasSubstr("/5 found, but $SLURM_NTASKS is 4"));
    Variables both = slurm;
    both.insert({{"OMPI_COMM_WORLD_RANK", "2"}, {"OMPI_COMM_WORLD_SIZE", "4"}});
    EXPECT_THAT(error_of("auto", both), HasSubstr("slurm says 1/4 and openmpi says 2/4"));
    EXPECT_EQ(error_of("openmpi", both), "2/4") << "a named launcher is used";
    EXPECT_EQ(error_of("0/3", both), "0/3") << "numbers are used whatever launchers say";
    both["OMPI_COMM_WORLD_RANK"] = "1";
    EXPECT_EQ(error_of("auto", both), "1/4") << "they agree";
}

} // namespace
} // namespace reljef::cli
