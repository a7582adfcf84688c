#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/command_line.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_program.h"

namespace reljef {
namespace {

using testing::HasSubstr;

// With temporary files in `folder`.
test::ProgramResult in_shell(const std::string& command, const test::TemporaryFolder& folder) {
    test::ProgramOptions options;
    options.environment = {{"TMPDIR", (folder.path() / "temporary").string()}};
    return test::run_program("/bin/sh", {"-c", command}, options);
}

class StandardInput : public testing::Test {
protected:
    void SetUp() override {
        std::filesystem::create_directory(folder_.path() / "temporary");
        dem_ = folder_
                   .write("dem.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2 "
                                     "3\n4 5 6\n7 8 9\n")
                   .string();
    }
    void TearDown() override {
        EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "temporary"));
    }

    const std::string reljef_ = "'" RELJEF_BINARY "' ";
    test::TemporaryFolder folder_;
    std::string dem_;
};

TEST_F(StandardInput, IsATerrain) {
    const auto piped = in_shell("cat '" + dem_ + "' | " + reljef_ + "info - --json", folder_);
    ASSERT_EQ(piped.exit_code, 0) << piped.err;
    EXPECT_THAT(piped.out, HasSubstr("\"standard input\""));
    const auto file = in_shell(reljef_ + "info - --json < '" + dem_ + "'", folder_);
    EXPECT_EQ(file.out, piped.out);
}

TEST_F(StandardInput, ThatIsNoRasterIsOneSentence) {
    for (const std::string command :
         {"echo hello |", "cat /dev/null |", "head -c 5000 /dev/zero |"}) {
        const auto result = in_shell(command + reljef_ + "info -", folder_);
        EXPECT_EQ(result.exit_code, 1) << command;
        EXPECT_THAT(result.err, HasSubstr("reljef: standard input: ")) << command;
        EXPECT_THAT(result.err, testing::Not(HasSubstr("/temporary/"))) << command;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_EQ(result.out, "");
    }
}

TEST_F(StandardInput, ThatNeedsAFileNameSaysSo) {
    const std::string zip("PK\3\4\0\0\0\0", 8);
    const std::string hgt(std::size_t{2} * 1201 * 1201, '\1');
    for (const auto& [bytes, name] : {std::pair(zip, ".zip"), std::pair(hgt, ".hgt")}) {
        const auto file = folder_.write("bytes", bytes).string();
        const auto result = in_shell(reljef_ + "info - < '" + file + "'", folder_);
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_THAT(result.err, HasSubstr("reljef: standard input: "));
        EXPECT_THAT(result.err, HasSubstr(name));
        EXPECT_THAT(result.err, HasSubstr("give it as a file, not as -"));
    }
}

// The second signal ends a run without cleanup; SIGKILL does it, too.
TEST_F(StandardInput, WhatAKilledRunLeftIsRemovedByTheNext) {
    const std::string temporary = (folder_.path() / "temporary").string();
    const auto killed = in_shell("(cat '" + dem_ + "'; sleep 20) 2>&- | " + reljef_ +
                                     "info - & n=0; until [ -n \"$(ls -A '" + temporary +
                                     "')\" ] || [ $n -ge 400 ]; do sleep 0.05; n=$((n + 1)); "
                                     "done; kill -KILL $!",
                                 folder_);
    EXPECT_FALSE(std::filesystem::is_empty(folder_.path() / "temporary")) << killed.err;
    const auto next = in_shell(reljef_ + "info - < '" + dem_ + "'", folder_);
    EXPECT_EQ(next.exit_code, 0) << next.err;
    // TearDown() finds nothing left.
}

TEST_F(StandardInput, CannotBeTheTerrainAndThePlaces) {
    test::expect_refusal(test::reljef({"height", "-", "--points", "-"}), 2, {"--points: - found"});
}

// Bytes that never end are no reason not to stop.
TEST_F(StandardInput, ThatNeverEndsIsInterrupted) {
    const auto result =
        in_shell("ulimit -f 8000000; timeout -s INT 1 " + reljef_ + "info - < /dev/zero", folder_);
    EXPECT_THAT(result.err, HasSubstr("interrupted"));
}

// Removing the temporary file must not replace the reason.
TEST_F(StandardInput, ThatIsDrawnToAFullDiskIsNamedRightly) {
    const auto result =
        in_shell(reljef_ + "render - --quiet --size 32x24 --context osmesa -o - < '" + dem_ +
                     "' > /dev/full",
                 folder_);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("No space left on device"));
}

TEST_F(StandardInput, ThatIsInterruptedLeavesNothing) {
    const auto result =
        in_shell("(cat '" + dem_ + "'; sleep 5) | timeout -s INT 1 " + reljef_ + "info -", folder_);
    EXPECT_THAT(result.err, HasSubstr("interrupted"));
}

} // namespace
} // namespace reljef
