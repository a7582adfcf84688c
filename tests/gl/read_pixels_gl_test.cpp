#include "engine/gl/read_pixels.h"

#include <glad/gl.h>

#include "engine/gl/state.h"
#include "tests/gl/gl_fixture.h"

namespace reljef::gl {
namespace {

using test::must;
using ReadPixelsGlTest = test::GlTest;

TEST_F(ReadPixelsGlTest, row_0_is_the_top_and_col_0_the_left) {
    const Framebuffer framebuffer = test::float_target({7, 5});
    const Program program =
        test::cover_program("void main() { color = vec4(gl_FragCoord.xy, 0.25, 1.0); }");
    framebuffer.bind();
    test::cover(program);
    const Grid<glm::vec4> pixels = read_float_color(framebuffer);
    ASSERT_EQ(pixels.cols(), 7);
    ASSERT_EQ(pixels.rows(), 5);
    for (int row = 0; row < 5; ++row) {
        for (int col = 0; col < 7; ++col) {
            const auto x = static_cast<float>(col) + 0.5F;
            const auto y_up = 4.5F - static_cast<float>(row);
            EXPECT_EQ(pixels(col, row), glm::vec4(x, y_up, 0.25F, 1.0F));
        }
    }
}

TEST_F(ReadPixelsGlTest, color_keeps_channels_in_order) {
    const Framebuffer framebuffer =
        must(Framebuffer::create({.size = {3, 2}, .color = Format::rgba8}));
    const Program program = test::cover_program(
        "void main() { color = vec4(10.0, 20.0, 30.0, 40.0) / 255.0;\n"
        "              if (gl_FragCoord.y > 1.0) { color = vec4(1.0, 0.0, 0.0, 1.0); } }");
    framebuffer.bind();
    test::cover(program);
    const Image image = read_color(framebuffer);
    EXPECT_EQ(image(0, 0), (Rgba8{255, 0, 0, 255}));
    EXPECT_EQ(image(2, 1), (Rgba8{10, 20, 30, 40}));
}

TEST_F(ReadPixelsGlTest, depth_of_a_slope_has_row_0_at_the_top) {
    const Framebuffer framebuffer = test::float_target({2, 4});
    const Program program = test::cover_program(
        "void main() { color = vec4(0.0); gl_FragDepth = gl_FragCoord.y / 8.0; }");
    set_reversed_depth();
    framebuffer.bind();
    framebuffer.clear_depth();
    test::cover(program);
    const Grid<float> depth = test::read_depth(framebuffer);
    EXPECT_EQ(depth(0, 0), 3.5F / 8.0F);
    EXPECT_EQ(depth(1, 3), 0.5F / 8.0F);
}

TEST_F(ReadPixelsGlTest, missing_channels_read_as_0_and_alpha_1) {
    const Framebuffer framebuffer =
        must(Framebuffer::create({.size = {1, 1}, .color = Format::r32f}));
    framebuffer.clear_color(glm::vec4(-1234.5F, 7.0F, 7.0F, 7.0F));
    EXPECT_EQ(read_float_color(framebuffer)(0, 0), glm::vec4(-1234.5F, 0.0F, 0.0F, 1.0F));
}

TEST_F(ReadPixelsGlTest, rows_are_packed_whatever_alignment_was_set) {
    const Framebuffer framebuffer =
        must(Framebuffer::create({.size = {7, 5}, .color = Format::rgba8}));
    framebuffer.clear_color(glm::vec4(1.0F));
    glPixelStorei(GL_PACK_ALIGNMENT, 8);
    EXPECT_EQ(read_color(framebuffer), Image(7, 5, Rgba8{255, 255, 255, 255}));
}

TEST_F(ReadPixelsGlTest, pictures_are_read_from_bytes_only) {
    const Framebuffer framebuffer = test::float_target({1, 1});
    EXPECT_DEATH(read_color(framebuffer), "8-bit colour only");
}

} // namespace
} // namespace reljef::gl
