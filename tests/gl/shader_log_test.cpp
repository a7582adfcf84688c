#include "engine/gl/shader_log.h"

#include <gtest/gtest.h>

namespace reljef::gl {
namespace {

const StageSource surface{.stage = Stage::fragment,
                          .name = "surface.frag",
                          .text = "",
                          .included = {"light.glsl", "fog.glsl"}};

TEST(ShaderLogTest, mesa_notation) {
    EXPECT_EQ(readable_log(surface, "0:12(5): error: `x' undeclared\n"),
              "surface.frag:12: error: `x' undeclared");
}

TEST(ShaderLogTest, nvidia_notation) {
    EXPECT_EQ(readable_log(surface, "0(12) : error C1503: undefined variable \"x\"\n"),
              "surface.frag:12: error C1503: undefined variable \"x\"");
}

TEST(ShaderLogTest, khronos_notation) {
    EXPECT_EQ(readable_log(surface, "ERROR: 0:12: 'x' : undeclared identifier"),
              "surface.frag:12: 'x' : undeclared identifier");
}

TEST(ShaderLogTest, included_files_by_their_number) {
    EXPECT_EQ(readable_log(surface, "1:3(1): error: a\n2:4(1): error: b\n3:5(1): error: c\n"),
              "light.glsl:3: error: a; fog.glsl:4: error: b; surface.frag:5: error: c");
}

TEST(ShaderLogTest, other_lines_stay) {
    EXPECT_EQ(readable_log(surface, "\n  2 compilation errors.  \r\nNo code generated\n\n"),
              "2 compilation errors.; No code generated");
    EXPECT_EQ(readable_log(surface, "10 of 12: too many"), "10 of 12: too many");
}

TEST(ShaderLogTest, zero_byte_at_the_end_is_dropped) {
    EXPECT_EQ(readable_log(surface, std::string_view("done\n\0", 6)), "done");
    EXPECT_EQ(readable_log(surface, ""), "");
}

TEST(ShaderLogTest, numbers_that_fit_nothing_are_no_crash) {
    EXPECT_EQ(readable_log(surface, "0:99999999999999999999(1): error: a"),
              "0:99999999999999999999(1): error: a");
    EXPECT_EQ(readable_log(surface, "99999999999999999999:1(1): error: a"),
              "99999999999999999999:1(1): error: a");
}

} // namespace
} // namespace reljef::gl
