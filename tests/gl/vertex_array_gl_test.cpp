#include "engine/gl/vertex_array.h"

#include <array>

#include <glad/gl.h>

#include "engine/gl/read_pixels.h"
#include "engine/gl/state.h"
#include "tests/gl/gl_fixture.h"

namespace reljef::gl {
namespace {

using test::must;
using VertexArrayGlTest = test::GlTest;

/// Draws one vertex as a point and gives what its attribute 0 held.
glm::vec4 attribute_of(const VertexArray& array) {
    const std::array stages{
        StageSource{.stage = Stage::vertex,
                    .name = "point.vert",
                    .text = "#version 450 core\nlayout(location = 0) in vec4 value;\n"
                            "flat out vec4 seen;\n"
                            "void main() { seen = value; gl_Position = vec4(0, 0, 0.5, 1); }"},
        StageSource{.stage = Stage::fragment,
                    .name = "point.frag",
                    .text = "#version 450 core\nflat in vec4 seen;\n"
                            "layout(location = 0) out vec4 color;\nvoid main() { color = seen; }"}};
    const Program program = must(Program::create(stages));
    const Framebuffer target = test::float_target({1, 1});
    target.bind();
    target.clear_color(glm::vec4(-99.0F));
    program.use();
    array.bind();
    glDrawArrays(GL_POINTS, 0, 1);
    return read_float_color(target)(0, 0);
}

TEST_F(VertexArrayGlTest, an_offset_skips_the_start_of_the_vertex) {
    constexpr std::array<float, 3> values{9.0F, 1.5F, -2.5F};
    const Buffer buffer = must(Buffer::create(std::as_bytes(std::span(values))));
    VertexArray array = VertexArray::create();
    const VertexAttribute attribute{.components = 2, .offset = sizeof(float)};
    array.set_vertices(buffer, {.stride = sizeof(values)}, std::span(&attribute, 1));
    EXPECT_EQ(attribute_of(array), glm::vec4(1.5F, -2.5F, 0.0F, 1.0F));
}

TEST_F(VertexArrayGlTest, moved_from_is_harmless) {
    VertexArray first = VertexArray::create();
    const unsigned int id = first.id();
    VertexArray second = std::move(first);
    // NOLINTBEGIN(bugprone-use-after-move,clang-analyzer-cplusplus.Move)
    EXPECT_EQ(first.id(), 0U);
    first.bind();
    second = VertexArray();
    EXPECT_EQ(glIsVertexArray(id), GL_FALSE);
    // NOLINTEND(bugprone-use-after-move,clang-analyzer-cplusplus.Move)
}

} // namespace
} // namespace reljef::gl
