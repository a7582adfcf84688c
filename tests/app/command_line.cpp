#include "tests/app/command_line.h"

#include <algorithm>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::test {

ProgramResult reljef(const std::vector<std::string>& arguments, const ProgramOptions& options) {
    return run_program(RELJEF_BINARY, arguments, options);
}

void expect_refusal(const ProgramResult& result, int exit_code,
                    const std::vector<std::string>& parts) {
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_FALSE(result.timed_out);
    EXPECT_EQ(result.err.rfind("reljef: ", 0), 0U) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    for (const std::string& part : parts) {
        EXPECT_THAT(result.err, testing::HasSubstr(part));
    }
}

bool has_display() {
    const char* display = std::getenv("DISPLAY");
    return display != nullptr && *display != '\0';
}

} // namespace reljef::test
