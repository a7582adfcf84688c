#include "engine/gl/framebuffer.h"

#include <algorithm>

#include <glad/gl.h>
#include <gmock/gmock.h>

#include "engine/core/color.h"
#include "engine/gl/read_pixels.h"
#include "engine/gl/state.h"
#include "tests/gl/gl_fixture.h"

namespace reljef::gl {
namespace {

using test::must;
using FramebufferGlTest = test::GlTest;

GLint depth_attribute(const Framebuffer& framebuffer, GLenum name) {
    GLint value = 0;
    glGetNamedFramebufferAttachmentParameteriv(framebuffer.id(), GL_DEPTH_ATTACHMENT, name, &value);
    return value;
}

TEST_F(FramebufferGlTest, depth_has_32_float_bits) {
    const Framebuffer framebuffer = must(Framebuffer::create({.size = {16, 16}}));
    EXPECT_EQ(depth_attribute(framebuffer, GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE), 32);
    EXPECT_EQ(depth_attribute(framebuffer, GL_FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE), GL_FLOAT);
}

TEST_F(FramebufferGlTest, tiny_depths_are_kept_exactly) {
    const Framebuffer framebuffer = test::float_target({8, 8});
    Program program = test::cover_program("void main() { color = vec4(1.0); }");
    set_reversed_depth();
    framebuffer.bind();
    // 1e-9 is a surface a thousand million near planes away; 24 bits would make it 0.
    for (const float depth : {1e-9F, 3e-5F, 0.25F, 1.0F}) {
        framebuffer.clear_depth();
        program.set(Uniform<float>("depth"), depth);
        test::cover(program);
        EXPECT_EQ(test::read_depth(framebuffer)(3, 4), depth);
    }
}

TEST_F(FramebufferGlTest, clearing_reaches_every_pixel_and_encodes_srgb) {
    const glm::vec4 linear(0.5F, 0.25F, 1.0F, 1.0F);
    const glm::ivec2 size(33, 17);
    const Framebuffer encoded = must(Framebuffer::create({.size = size}));
    encoded.clear_color(linear);
    const Rgba8 expected = rgba8_from_linear(glm::vec3(linear));
    const Image pixels = read_color(encoded);
    for (const Rgba8& pixel : pixels.samples()) {
        ASSERT_NEAR(pixel.r, expected.r, 1);
        ASSERT_NEAR(pixel.g, expected.g, 1);
        ASSERT_EQ(pixel.b, 255);
        ASSERT_EQ(pixel.a, 255);
    }
    const Framebuffer bytes = must(Framebuffer::create({.size = size, .color = Format::rgba8}));
    bytes.clear_color(linear);
    EXPECT_NEAR(read_color(bytes)(32, 16).r, 128, 1);
    const Framebuffer floats = test::float_target(size);
    floats.clear_color(linear);
    EXPECT_EQ(read_float_color(floats), Grid<glm::vec4>(33, 17, linear));
    floats.clear_depth(0.75F);
    EXPECT_EQ(test::read_depth(floats), Grid<float>(33, 17, 0.75F));
}

TEST_F(FramebufferGlTest, uploaded_bytes_are_kept_with_the_first_row_at_the_bottom) {
    Framebuffer framebuffer = must(Framebuffer::create({.size = {3, 2}, .depth = false}));
    Image texels(3, 2);
    for (int i = 0; i < 6; ++i) {
        texels(i % 3, i / 3) = {static_cast<std::uint8_t>(40 * i), 7, 255, 255};
    }
    framebuffer.upload(texels);
    const Image read = read_color(framebuffer);
    EXPECT_EQ(read(0, 1), texels(0, 0));
    EXPECT_EQ(read(2, 0), texels(2, 1));
}

TEST_F(FramebufferGlTest, drawing_encodes_srgb) {
    const Framebuffer framebuffer = must(Framebuffer::create({.size = {4, 4}}));
    const Program program = test::cover_program("void main() { color = vec4(vec3(0.5), 1.0); }");
    framebuffer.bind();
    test::cover(program);
    EXPECT_NEAR(read_color(framebuffer)(0, 0).r, 188, 1);
}

TEST_F(FramebufferGlTest, impossible_options_are_one_sentence) {
    const auto message = [](const FramebufferOptions& options) {
        const auto framebuffer = Framebuffer::create(options);
        return framebuffer ? std::string("no error") : framebuffer.error().message;
    };
    EXPECT_THAT(message({.size = {0, 768}}),
                ::testing::StartsWith("framebuffer of 0 x 768 pixels: expected 1 x 1 to "));
    EXPECT_THAT(message({.size = {100000, 100000}}),
                ::testing::StartsWith("framebuffer of 100000 x 100000 pixels: expected "));
    EXPECT_THAT(message({.size = {8, 8}, .color = Format::depth32f}),
                ::testing::HasSubstr("an attachment cannot be drawn to"));
    EXPECT_THAT(message({.size = {8, 8}, .samples = 3}),
                ::testing::StartsWith("framebuffer with 3 samples a pixel: expected one of 1, "));
    take_problems();
}

TEST_F(FramebufferGlTest, every_driver_has_one_and_four_samples) {
    const std::vector<int> counts = sample_counts({});
    EXPECT_TRUE(std::is_sorted(counts.begin(), counts.end()));
    EXPECT_THAT(counts, ::testing::IsSupersetOf({1, 4})); // OpenGL 4.5 core, table 23.66
    EXPECT_EQ(std::adjacent_find(counts.begin(), counts.end()), counts.end());
}

TEST_F(FramebufferGlTest, samples_are_averaged_in_linear_light) {
    const Framebuffer samples = must(Framebuffer::create({.size = {5, 3}, .samples = 4}));
    const Framebuffer picture = must(Framebuffer::create({.size = {5, 3}}));
    EXPECT_EQ(samples.samples(), 4);
    EXPECT_EQ(depth_attribute(samples, GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE), 32);
    EXPECT_EQ(depth_attribute(samples, GL_FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE), GL_FLOAT);
    const Program program = test::cover_program(
        "void main() { color = vec4(vec3(gl_SampleID < 2 ? 1.0 : 0.0), 1.0); }");
    samples.bind();
    samples.clear_color(glm::vec4(0.5F));
    test::cover(program);
    glDisable(GL_FRAMEBUFFER_SRGB); // whatever was set before
    samples.resolve_to(picture);
    const Image resolved = read_color(picture);
    for (const Rgba8& pixel : resolved.samples()) {
        ASSERT_NEAR(pixel.r, 188, 1) << "128 is the mean of the encoded bytes";
        ASSERT_EQ(pixel.a, 255);
    }
    picture.bind();
    test::cover(test::cover_program("void main() { color = vec4(0.0, 0.0, 0.0, 1.0); }"));
    EXPECT_EQ(read_color(picture)(4, 2), (Rgba8{0, 0, 0, 255})) << "it can be drawn to again";
}

TEST_F(FramebufferGlTest, each_sample_has_a_depth_of_its_own) {
    const Framebuffer samples = must(Framebuffer::create({.size = {4, 4}, .samples = 4}));
    const Framebuffer picture = must(Framebuffer::create({.size = {4, 4}}));
    set_reversed_depth();
    samples.bind();
    samples.clear_color(glm::vec4(0.0F, 0.0F, 0.0F, 1.0F));
    samples.clear_depth();
    Program near_left = test::cover_program("void main() { color = vec4(1.0);\n"
                                            "gl_FragDepth = gl_SampleID == 0 ? 0.75 : 0.25; }");
    test::cover(near_left);
    Program behind = test::cover_program("void main() { color = vec4(0.0, 0.0, 0.0, 1.0); }");
    behind.set(Uniform<float>{"depth"}, 0.5F);
    test::cover(behind);
    samples.resolve_to(picture);
    EXPECT_NEAR(read_color(picture)(1, 1).r, 137, 1) << "one of four is in front";
}

TEST_F(FramebufferGlTest, moved_from_is_harmless) {
    Framebuffer first = must(Framebuffer::create({.size = {4, 4}}));
    const unsigned int color = first.color().id();
    Framebuffer second = std::move(first);
    // NOLINTBEGIN(bugprone-use-after-move,clang-analyzer-cplusplus.Move)
    EXPECT_EQ(first.id(), 0U);
    EXPECT_EQ(second.color().id(), color);
    second = Framebuffer();
    EXPECT_EQ(glIsTexture(color), GL_FALSE);
    // NOLINTEND(bugprone-use-after-move,clang-analyzer-cplusplus.Move)
}

} // namespace
} // namespace reljef::gl
