#include "app/cli/manual.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/commands.h"
#include "tests/app/command_line.h"
#include "tests/support/plain_words.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_program.h"

namespace reljef::cli {
namespace {

using testing::HasSubstr;

std::string text_of(const std::string& path) {
    const std::vector<ManualFile> files = manual_of(app::reljef_program());
    const auto found = std::find_if(files.begin(), files.end(),
                                    [&](const ManualFile& file) { return file.path == path; });
    return found == files.end() ? "no such file" : found->text;
}

TEST(Manual, HasAPageForTheProgramAndForEachVerb) {
    const std::string program = text_of("man/man1/reljef.1");
    for (const std::string verb : {"view", "render", "info", "height", "profile", "viewshed",
                                   "index", "maps", "techniques"}) {
        EXPECT_THAT(program, HasSubstr("\\fBreljef\\-" + verb + "\\fR(1)"));
        EXPECT_THAT(text_of("man/man1/reljef-" + verb + ".1"), HasSubstr(".SH SYNOPSIS")) << verb;
    }
    EXPECT_THAT(text_of("man/man1/reljef-render.1"), HasSubstr(".TP\n\\fB\\-\\-max\\-error\\fR"));
}

TEST(Manual, PagesAreFormattedWithoutWarnings) {
    const test::TemporaryFolder folder;
    for (const ManualFile& file : manual_of(app::reljef_program())) {
        if (!file.path.starts_with("man/")) {
            continue;
        }
        const std::string page = folder.write("page.1", file.text).string();
        const auto result = test::run_program("/bin/sh",
                                              {"-c", "command -v groff >/dev/null || exit 77; "
                                                     "groff -man -Tutf8 -ww '" +
                                                         page + "' > /dev/null"},
                                              {});
        if (result.exit_code == 77) {
            GTEST_SKIP() << "groff is not installed";
        }
        EXPECT_EQ(result.exit_code, 0) << file.path;
        EXPECT_EQ(result.err, "") << file.path;
    }
}

TEST(Manual, UsesPlainWords) {
    for (const ManualFile& file : manual_of(app::reljef_program())) {
        for (const char* const phrase : test::dialect_phrases) {
            EXPECT_THAT(file.text, testing::Not(HasSubstr(phrase))) << file.path;
        }
    }
}

TEST(Manual, BashCompletesVerbsAndOptions) {
    const test::TemporaryFolder folder;
    const std::string script =
        folder.write("reljef", text_of("bash-completion/completions/reljef")).string();
    const auto complete = [&](const std::string& words) {
        const std::string command =
            "source '" + script + "'; COMP_WORDS=(" + words +
            "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _reljef; echo \"${COMPREPLY[*]}\"";
        return test::run_program("/bin/bash", {"-c", command}, {}).out;
    };
    EXPECT_EQ(complete("reljef re"), "render\n");
    EXPECT_EQ(complete("reljef help inf"), "info\n");
    EXPECT_EQ(complete("reljef render --max"), "--max-error\n");
    EXPECT_EQ(complete("reljef info alps"), "\n") << "the shell completes files";
}

TEST(CommandLine, HelpAndVersionHaveTheirUsualNames) {
    EXPECT_EQ(test::reljef({"help", "render"}).out, test::reljef({"render", "--help"}).out);
    EXPECT_EQ(test::reljef({"help"}).out, test::reljef({"--help"}).out);
    EXPECT_EQ(test::reljef({"-V"}).out, test::reljef({"--version"}).out);
    test::expect_refusal(test::reljef({"help", "rendr"}), 2, {"did you mean render?"});
}

TEST(CommandLine, AMisspelledOptionOfTheProgramIsNamed) {
    test::expect_refusal(test::reljef({"--verion"}), 2, {"--verion found", "--version?"});
}

TEST(CommandLine, AMisspelledWordIsRefusedWithTheOneThatIsMeant) {
    test::expect_refusal(test::reljef({"rendr", "natural"}), 2,
                         {"verb 'rendr' found", "did you mean render?"});
    test::expect_refusal(test::reljef({"render", "natural", "--max-eror", "1", "-o", "a.png"}), 2,
                         {"render: --max-eror found", "did you mean --max-error?"});
}

} // namespace
} // namespace reljef::cli
