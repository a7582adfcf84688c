#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/cli/manual.h"
#include "bench/commands.h"
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

} // namespace
} // namespace reljef::bench
