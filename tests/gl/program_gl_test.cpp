#include "engine/gl/program.h"

#include <array>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <gmock/gmock.h>

#include "engine/gl/buffer.h"
#include "engine/gl/read_pixels.h"
#include "tests/gl/gl_fixture.h"

namespace reljef::gl {
namespace {

using test::must;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ProgramGlTest = test::GlTest;

template <class T, class Value>
concept CanSet = requires(Program program, Uniform<T> uniform, Value value) {
    program.set(uniform, value);
};
static_assert(CanSet<float, float> && CanSet<glm::mat3, glm::mat3>);
static_assert(!CanSet<float, int> && !CanSet<int, float> && !CanSet<float, double>);
static_assert(!CanSet<glm::vec3, glm::vec4> && !CanSet<glm::ivec2, glm::vec2>);
static_assert(!CanSet<glm::vec3, glm::dvec3> && !CanSet<glm::mat3, glm::mat4>);

const std::string good_vertex = "#version 450 core\nvoid main() { gl_Position = vec4(0.0); }\n";
const std::string good_fragment =
    "#version 450 core\nout vec4 color;\nvoid main() { color = vec4(0.0); }\n";

std::string error_of(const StageSource& vertex, const StageSource& fragment) {
    const std::array stages{vertex, fragment};
    const auto program = Program::create(stages);
    return program ? "no error" : program.error().message;
}

/// What the fragment program writes.
glm::vec4 result_of(const Program& program) {
    const Framebuffer target = test::float_target({1, 1});
    target.bind();
    test::cover(program);
    return read_float_color(target)(0, 0);
}

TEST_F(ProgramGlTest, compile_error_names_file_and_line) {
    const std::string text =
        "#version 450 core\nout vec4 color;\nvoid main() {\n    color = vec4(missing);\n}\n";
    EXPECT_THAT(
        error_of({Stage::vertex, "good.vert", good_vertex}, {Stage::fragment, "broken.frag", text}),
        AllOf(StartsWith("shader broken.frag does not compile: broken.frag:4: "),
              HasSubstr("missing")));
    take_problems();
}

TEST_F(ProgramGlTest, compile_error_in_an_included_part_names_that_file) {
    const std::string text = "#version 450 core\n#line 1 1\nfloat f() {\n    return nothing;\n}\n"
                             "#line 2 0\nout vec4 color;\nvoid main() { color = vec4(f()); }\n";
    EXPECT_THAT(error_of({Stage::vertex, "good.vert", good_vertex},
                         {Stage::fragment, "whole.frag", text, {"part.glsl"}}),
                HasSubstr("part.glsl:2: "));
    take_problems();
}

TEST_F(ProgramGlTest, link_error_names_every_file) {
    const std::string text = "#version 450 core\nin vec3 never_written;\nout vec4 color;\n"
                             "void main() { color = vec4(never_written, 1.0); }\n";
    EXPECT_THAT(
        error_of({Stage::vertex, "good.vert", good_vertex}, {Stage::fragment, "lonely.frag", text}),
        AllOf(StartsWith("shaders good.vert + lonely.frag do not link: "),
              HasSubstr("never_written")));
    take_problems();
}

TEST_F(ProgramGlTest, an_error_is_one_line) {
    const std::string text = "#version 450 core\nvoid main() { a = 1; b = 2; c = 3; }\n";
    EXPECT_THAT(error_of({Stage::vertex, "broken.vert", text},
                         {Stage::fragment, "good.frag", good_fragment}),
                ::testing::Not(HasSubstr("\n")));
    take_problems();
}

TEST_F(ProgramGlTest, empty_text_is_an_error) {
    EXPECT_THAT(
        error_of({Stage::vertex, "empty.vert", ""}, {Stage::fragment, "good.frag", good_fragment}),
        HasSubstr("empty.vert"));
    take_problems();
}

TEST_F(ProgramGlTest, scalars_and_vectors_arrive) {
    Program program = test::cover_program(
        "uniform int i; uniform float f;\n"
        "uniform ivec2 iv; uniform vec2 v2; uniform vec3 v3; uniform vec4 v4;\n"
        "void main() { color = vec4(10.0 * float(i), f,\n"
        "                           dot(v2, vec2(1.0, 100.0)) + float(iv.y - iv.x),\n"
        "                           dot(v3, vec3(1.0)) + v4.w); }");
    EXPECT_TRUE(program.set(Uniform<int>("i"), -3));
    EXPECT_TRUE(program.set(Uniform<float>("f"), 0.5F));
    EXPECT_TRUE(program.set(Uniform<glm::ivec2>("iv"), glm::ivec2(-1, 1)));
    EXPECT_TRUE(program.set(Uniform<glm::vec2>("v2"), glm::vec2(1.0F, 2.0F)));
    EXPECT_TRUE(program.set(Uniform<glm::vec3>("v3"), glm::vec3(1.0F, 2.0F, 3.0F)));
    EXPECT_TRUE(program.set(Uniform<glm::vec4>("v4"), glm::vec4(0.0F, 0.0F, 0.0F, 8.0F)));
    EXPECT_EQ(result_of(program), glm::vec4(-30.0F, 0.5F, 203.0F, 14.0F));
}

TEST_F(ProgramGlTest, matrices_are_column_major) {
    Program program = test::cover_program(
        "uniform mat3 m3; uniform mat4 m4;\n"
        "void main() { color = vec4(m3[1][2], m4[3][1], m3[2][1], m4[1][3]); }");
    glm::mat3 m3(0.0F);
    m3[1][2] = 12.0F;
    glm::mat4 m4(0.0F);
    m4[3][1] = 31.0F;
    EXPECT_TRUE(program.set(Uniform<glm::mat3>("m3"), m3));
    EXPECT_TRUE(program.set(Uniform<glm::mat4>("m4"), m4));
    EXPECT_EQ(result_of(program), glm::vec4(12.0F, 31.0F, 0.0F, 0.0F));
}

TEST_F(ProgramGlTest, unused_uniforms_are_told_and_ignored) {
    Program program =
        test::cover_program("uniform float dropped;\nvoid main() { color = vec4(1.0); }");
    EXPECT_FALSE(program.set(Uniform<float>("dropped"), 1.0F));
    EXPECT_FALSE(program.set(Uniform<glm::mat4>("never_declared"), glm::mat4(1.0F)));
    EXPECT_EQ(program.block_size("never_declared"), 0);
}

TEST_F(ProgramGlTest, a_wrong_type_is_reported_by_the_driver) {
    Program program = test::cover_program("uniform vec3 v;\nvoid main() { color = v.xyzz; }");
    program.set(Uniform<float>("v"), 1.0F);
    EXPECT_FALSE(take_problems().empty());
}

TEST_F(ProgramGlTest, blocks_read_the_buffer_at_their_binding) {
    Program program = test::cover_program(
        "layout(std140, binding = 5) uniform Frame { vec4 first; vec4 second; };\n"
        "void main() { color = first + second; }");
    const std::array values{glm::vec4(1.0F), glm::vec4(1.0F, 2.0F, 3.0F, 4.0F)};
    Buffer buffer = must(Buffer::create_writable(sizeof(values)));
    buffer.write(0, std::as_bytes(std::span(values)));
    EXPECT_EQ(program.block_size("Frame"), 32);
    buffer.bind_uniform_block(5);
    EXPECT_EQ(result_of(program), glm::vec4(2.0F, 3.0F, 4.0F, 5.0F));
}

TEST_F(ProgramGlTest, samplers_read_the_texture_at_their_binding) {
    Program program = test::cover_program(
        "layout(binding = 4) uniform sampler2D a; layout(binding = 7) uniform sampler2D b;\n"
        "void main() { color = vec4(texture(a, vec2(0.5)).r, texture(b, vec2(0.5)).r, 0, 0); }");
    Texture2D one = must(Texture2D::create({.format = Format::r32f}));
    Texture2D two = must(Texture2D::create({.format = Format::r32f}));
    one.upload(0, Grid<float>(1, 1, 1.0F));
    two.upload(0, Grid<float>(1, 1, 2.0F));
    one.bind(7);
    two.bind(4);
    EXPECT_EQ(result_of(program), glm::vec4(2.0F, 1.0F, 0.0F, 0.0F));
}

TEST_F(ProgramGlTest, moved_from_is_harmless) {
    Program first = test::cover_program("void main() { color = vec4(3.0); }");
    const Program second = std::move(first);
    // NOLINTBEGIN(bugprone-use-after-move,clang-analyzer-cplusplus.Move)
    EXPECT_EQ(first.id(), 0U);
    EXPECT_FALSE(first.set(Uniform<float>("depth"), 1.0F));
    EXPECT_EQ(first.block_size("Frame"), 0);
    first.use();
    EXPECT_EQ(result_of(second), glm::vec4(3.0F));
    // NOLINTEND(bugprone-use-after-move,clang-analyzer-cplusplus.Move)
}

} // namespace
} // namespace reljef::gl
