// What a start of the program loads. The program itself is started, not a fork.
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/command_line.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_program.h"

namespace reljef {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string dem_of_nine(const test::TemporaryFolder& folder) {
    return folder
        .write("dem.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 10\n"
                          "1 2 3\n4 5 6\n7 8 9\n")
        .string();
}

TEST(Start, LoadsOpenImageIoForPicturesOnly) {
    const test::TemporaryFolder folder;
    const std::string dem = dem_of_nine(folder);
    test::ProgramOptions traced;
    traced.environment = {{"LD_DEBUG", "files"}, {"LIBGL_ALWAYS_SOFTWARE", "1"}};
    traced.folder = folder.path();
    const auto expect_none = [](const test::ProgramResult& run) {
        EXPECT_EQ(run.exit_code, 0);
        EXPECT_THAT(run.err, AllOf(HasSubstr("libgdal"), Not(HasSubstr("libOpenImageIO"))));
    };
    const auto render = [&](const char* output) {
        return test::run_program(
            RELJEF_BINARY, {"render", dem, "--size", "32x32", "--context", "cpu", "-o", output},
            traced);
    };
    expect_none(test::run_program(RELJEF_BINARY, {"info", dem}, traced));
    expect_none(render("a.png")); // libpng suffices
    const auto jpeg = render("a.jpg");
    EXPECT_EQ(jpeg.exit_code, 0);
    EXPECT_THAT(jpeg.err, HasSubstr("libOpenImageIO"));
}

TEST(Start, WithoutTheLibraryOfPicturesIsOneSentenceWherePicturesAreNeeded) {
    const test::TemporaryFolder folder;
    const std::string dem = dem_of_nine(folder);
    const fs::path program = folder.path() / "reljef";
    fs::copy_file(RELJEF_BINARY, program);
    test::ProgramOptions options;
    options.folder = folder.path();
    EXPECT_EQ(test::run_program(program, {"info", dem}, options).exit_code, 0);
    const auto render_to = [&](const std::vector<std::string>& outputs) {
        std::vector<std::string> arguments{"render", dem, "--size", "32x32", "--context", "cpu"};
        arguments.insert(arguments.end(), outputs.begin(), outputs.end());
        return test::run_program(program, arguments, options);
    };
    EXPECT_EQ(render_to({"-o", "a.png"}).exit_code, 0);
    const std::vector<std::pair<std::string, std::vector<std::string>>> outputs{
        {"a.jpg", {"-o", "a.jpg"}},
        {"a.bmp", {"-o", "a.bmp"}},
        {"a.exr", {"--hit", "a.exr"}},
        {"sheet.png", {"-o", "b.png", "--contact-sheet", "sheet.png"}}};
    for (const auto& [output, options_of_output] : outputs) {
        const auto render = render_to(options_of_output);
        test::expect_refusal(render, 2,
                             {output, (folder.path() / "reljef-pictures.so").string(),
                              "does not exist, the library with which this reljef reads and "
                              "writes pictures was expected"});
        EXPECT_FALSE(fs::exists(folder.path() / output));
    }
    test::expect_refusal(
        test::run_program(program, {"maps", "a.png", "--normals", "n.png"}, options), 1,
        {"a.png: cannot be read: ", (folder.path() / "reljef-pictures.so").string()});
}

} // namespace
} // namespace reljef
