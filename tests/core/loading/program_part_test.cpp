#include "engine/core/loading/program_part.h"

#include <filesystem>

#include <gtest/gtest.h>

namespace reljef {
namespace {

namespace fs = std::filesystem;

TEST(ProgramPart, lies_beside_the_program) {
    const fs::path program = fs::read_symlink("/proc/self/exe");
    EXPECT_EQ(program_part(program.filename().c_str()), program);
}

TEST(ProgramPart, is_expected_there_if_it_is_missing) {
    const fs::path program = fs::read_symlink("/proc/self/exe");
    EXPECT_EQ(program_part("no-such-part"), program.parent_path() / "no-such-part");
}

} // namespace
} // namespace reljef
