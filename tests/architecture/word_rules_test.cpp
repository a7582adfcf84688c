#include "tests/architecture/word_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(DialectNames, AreNamesNotTexts) {
    EXPECT_THAT(dialect_names({"engine/core/a.cpp", "int most_bytes = 1; // least_bytes\n"
                                                    "auto key = \"most_bytes\";\n"}),
                ElementsAre("engine/core/a.cpp names most_bytes, max was expected"));
    EXPECT_THAT(dialect_names({"engine/core/a.cpp", "int utmost_1 = max_bytes; default_value;"}),
                IsEmpty());
}

TEST(DialectNames, AreFoundInsideOthers) {
    EXPECT_THAT(dialect_names({"engine/io/a.h", "struct TileFault { int file_fault; };"}),
                ElementsAre("engine/io/a.h names TileFault, error was expected",
                            "engine/io/a.h names file_fault, error was expected"));
}

TEST(DialectComments, AreThoseOfHeaders) {
    const std::string text = "int a; ///< so many samples\n// of so many\nauto b = \" so many\";\n";
    EXPECT_THAT(dialect_comments({"engine/io/a.h", text}),
                ElementsAre("engine/io/a.h says \" so many\": ///< so many samples",
                            "engine/io/a.h says \" so many\": // of so many"));
    EXPECT_THAT(dialect_comments({"engine/io/a.cpp", text}), IsEmpty());
}

} // namespace
} // namespace reljef::test
