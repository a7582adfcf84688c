#include "tests/app/command_line.h"

#include <algorithm>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/commands.h"
#include "tests/support/forks/forked_program.h"
#include "tests/support/text_pattern.h"

namespace reljef::test {
namespace {

int reljef_main(int argc, char** argv) {
    return cli::run_program(app::reljef_program, argc, argv);
}

} // namespace

ProgramResult reljef(const std::vector<std::string>& arguments, const ProgramOptions& options) {
    return run_forked(reljef_main, RELJEF_BINARY, arguments, options);
}

std::string without_progress(const std::string& err) {
    return without_matches(err, "[^\n\r]* [0-9]+ %(, [^\n\r]* left)?[\n\r]+");
}

void expect_refusal(const ProgramResult& result, int exit_code,
                    const std::vector<std::string>& parts) {
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_FALSE(result.timed_out);
    const std::string err = without_progress(result.err);
    EXPECT_EQ(err.rfind("reljef: ", 0), 0U) << err;
    EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
    for (const std::string& part : parts) {
        EXPECT_THAT(result.err, testing::HasSubstr(part));
    }
}

std::string small_terrain(const TemporaryFolder& folder, const std::string& name) {
    return folder
        .write(name + ".toml",
               "name = \"" + name + "\"\n[terrain]\ngenerator = \"" + name + "\"\nsize = 129\n")
        .string();
}

bool has_display() {
    const char* display = std::getenv("DISPLAY");
    return display != nullptr && *display != '\0';
}

} // namespace reljef::test
