#include "engine/gl/draw.h"

#include <array>
#include <cstdint>
#include <utility>

#include <glad/gl.h>

#include "engine/gl/fence.h"
#include "engine/gl/read_pixels.h"
#include "engine/gl/state.h"
#include "tests/gl/gl_fixture.h"

namespace reljef::gl {
namespace {

using test::must;
using DrawGlTest = test::GlTest;

/// Whether indices 0, 1, 2 of that type give the triangle that covers the target.
template <class Index> bool covers(IndexType type) {
    constexpr std::array<Index, 3> corners{0, 1, 2};
    const Buffer indices = must(Buffer::create(std::as_bytes(std::span(corners))));
    VertexArray array = VertexArray::create();
    array.set_indices(indices);
    const Framebuffer target = test::float_target({2, 2});
    Program program = test::cover_program("void main() { color = vec4(1.0); }");
    set_depth_test(DepthTest::off);
    target.bind();
    target.clear_color(glm::vec4(0.0F));
    array.bind();
    program.use();
    draw_elements(type, 3);
    return read_float_color(target)(1, 1).r == 1.0F;
}

TEST_F(DrawGlTest, indices_have_16_or_32_bits) {
    EXPECT_TRUE(covers<std::uint16_t>(IndexType::uint16));
    EXPECT_TRUE(covers<std::uint32_t>(IndexType::uint32));
}

TEST_F(DrawGlTest, instances_step_the_divided_attribute) {
    const std::array stages{
        StageSource{.stage = Stage::vertex,
                    .name = "rows.vert",
                    .text = "#version 450 core\nlayout(location = 0) in float row;\n"
                            "void main() {\n"
                            "    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                            "    gl_Position = vec4(2.0 * corner.x - 1.0, corner.y + row - 1.0,\n"
                            "                       0.5, 1.0); }"},
        StageSource{.stage = Stage::fragment,
                    .name = "rows.frag",
                    .text = "#version 450 core\nlayout(location = 0) out vec4 color;\n"
                            "void main() { color = vec4(1.0); }"}};
    const Program program = must(Program::create(stages));
    const Framebuffer target = test::float_target({2, 2});
    constexpr std::array rows{0.0F, 1.0F};
    const Buffer instances = must(Buffer::create(std::as_bytes(std::span(rows))));
    VertexArray array = VertexArray::create();
    const VertexAttribute row{};
    array.set_vertices(instances, {.stride = 4, .divisor = 1}, std::span(&row, 1));
    set_depth_test(DepthTest::off);
    set_culling(Culling::none);
    program.use();
    array.bind();
    for (const int count : {1, 2}) {
        target.bind();
        target.clear_color(glm::vec4(0.0F));
        draw_arrays(Primitive::triangle_strip, 4, count);
        const Grid<glm::vec4> pixels = read_float_color(target);
        EXPECT_EQ(pixels(0, 1).r, 1.0F);
        EXPECT_EQ(pixels(1, 0).r, count == 2 ? 1.0F : 0.0F);
    }
}

using FenceGlTest = test::GlTest;

TEST_F(FenceGlTest, work_before_it_is_done_after_waiting) {
    const Framebuffer target = test::float_target({512, 512});
    const Program program =
        test::cover_program("void main() { color = sin(gl_FragCoord.xyxy) * 0.5; }");
    target.bind();
    GLuint query = 0;
    glCreateQueries(GL_SAMPLES_PASSED, 1, &query);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    test::cover(program);
    glEndQuery(GL_SAMPLES_PASSED);
    Fence::after_commands().wait();
    GLint is_done = GL_FALSE;
    glGetQueryObjectiv(query, GL_QUERY_RESULT_AVAILABLE, &is_done);
    EXPECT_EQ(is_done, GL_TRUE);
    glDeleteQueries(1, &query);
}

TEST_F(FenceGlTest, default_and_moved_ones_are_passed) {
    Fence().wait();
    Fence fence = Fence::after_commands();
    const Fence other = std::move(fence);
    other.wait();
    fence = Fence();
    fence.wait();
}

} // namespace
} // namespace reljef::gl
