#include "engine/gl/vertex_array.h"

#include <array>
#include <cstdint>

#include <glad/gl.h>

#include "engine/gl/draw.h"
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
    draw_arrays(Primitive::points, 0, 1);
    return read_float_color(target)(0, 0);
}

template <class T> glm::vec4 read_as(ComponentType type, const std::array<T, 3>& values) {
    const Buffer buffer = must(Buffer::create(std::as_bytes(std::span(values))));
    VertexArray array = VertexArray::create();
    // The first component is skipped by the attribute's offset.
    const VertexAttribute attribute{.components = 2, .type = type, .offset = sizeof(T)};
    array.set_vertices(0, buffer, {.stride = sizeof(values)}, std::span(&attribute, 1));
    return attribute_of(array);
}

TEST_F(VertexArrayGlTest, every_component_type_arrives_as_its_value) {
    EXPECT_EQ(read_as<float>(ComponentType::float32, {9.0F, 1.5F, -2.5F}),
              glm::vec4(1.5F, -2.5F, 0.0F, 1.0F));
    EXPECT_EQ(read_as<std::uint16_t>(ComponentType::float16, {0, 0x3c00, 0xc000}),
              glm::vec4(1.0F, -2.0F, 0.0F, 1.0F));
    EXPECT_EQ(read_as<std::uint8_t>(ComponentType::uint8, {9, 7, 255}),
              glm::vec4(7.0F, 255.0F, 0.0F, 1.0F));
    EXPECT_EQ(read_as<std::uint8_t>(ComponentType::uint8_normalized, {9, 0, 255}),
              glm::vec4(0.0F, 1.0F, 0.0F, 1.0F));
    EXPECT_EQ(read_as<std::int16_t>(ComponentType::int16, {9, -32768, 32767}),
              glm::vec4(-32768.0F, 32767.0F, 0.0F, 1.0F));
    EXPECT_EQ(read_as<std::int16_t>(ComponentType::int16_normalized, {9, -32767, 32767}),
              glm::vec4(-1.0F, 1.0F, 0.0F, 1.0F));
    EXPECT_EQ(read_as<std::uint16_t>(ComponentType::uint16, {9, 1, 65535}),
              glm::vec4(1.0F, 65535.0F, 0.0F, 1.0F));
    EXPECT_EQ(read_as<std::uint16_t>(ComponentType::uint16_normalized, {9, 0, 65535}),
              glm::vec4(0.0F, 1.0F, 0.0F, 1.0F));
}

TEST_F(VertexArrayGlTest, layout_offset_skips_the_start_of_the_buffer) {
    const std::array<float, 4> values{1.0F, 2.0F, 3.0F, 4.0F};
    const Buffer buffer = must(Buffer::create(std::as_bytes(std::span(values))));
    VertexArray array = VertexArray::create();
    const VertexAttribute attribute{.components = 1};
    array.set_vertices(2, buffer, {.stride = 4, .offset = 8}, std::span(&attribute, 1));
    EXPECT_EQ(attribute_of(array).x, 3.0F);
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
