#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/cli/manual.h"
#include "bench/commands.h"
#include "tests/bench/bench_program.h"
#include "tests/support/plain_words.h"

namespace reljef::bench {
namespace {

TEST(BenchManual, UsesPlainWords) {
    for (const cli::ManualFile& file : cli::manual_of(reljef_bench_program())) {
        for (const char* const phrase : test::dialect_phrases) {
            EXPECT_THAT(file.text, testing::Not(testing::HasSubstr(phrase))) << file.path;
        }
    }
}

TEST(BenchManual, ListsTheSuites) {
    const auto help = test::reljef_bench({"--help"});
    EXPECT_EQ(help.exit_code, 0) << help.err;
    for (const char* const suite : {"tables", "pareto", "lod", "stress", "skip", "objects", "peers",
                                    "flight", "compare", "findings"}) {
        EXPECT_THAT(help.out, testing::ContainsRegex(fmt::format("\n  {} +[a-z]", suite)));
    }
}

} // namespace
} // namespace reljef::bench
