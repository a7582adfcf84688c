#include "engine/gl/texture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <glad/gl.h>
#include <glm/common.hpp>
#include <gmock/gmock.h>

#include "engine/core/color.h"
#include "engine/gl/read_pixels.h"
#include "engine/gl/state.h"
#include "tests/gl/gl_fixture.h"

namespace reljef::gl {
namespace {

using test::must;
using TextureGlTest = test::GlTest;

class TextureFormatGlTest : public test::GlTest, public ::testing::WithParamInterface<Format> {};

std::size_t area(glm::ivec2 size) {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

/// Random bits for byte and integer formats, random values in [0,1] for floats (not every bit
/// pattern of a float survives, e.g. a signalling NaN).
std::vector<std::byte> random_texels(Format format, std::size_t count, unsigned int seed) {
    std::mt19937 generator(seed);
    std::vector<std::byte> bytes(count * traits(format).bytes);
    if (traits(format).type == GL_FLOAT) {
        std::uniform_real_distribution<float> unit(0.0F, 1.0F);
        std::vector<float> values(bytes.size() / sizeof(float));
        std::ranges::generate(values, [&] { return unit(generator); });
        std::ranges::copy(std::as_bytes(std::span(values)), bytes.begin());
    } else if (traits(format).type == GL_SHORT) {
        std::uniform_int_distribution<int> steps(-32767, 32767);
        std::vector<std::int16_t> values(bytes.size() / 2);
        std::ranges::generate(values, [&] { return static_cast<std::int16_t>(steps(generator)); });
        std::ranges::copy(std::as_bytes(std::span(values)), bytes.begin());
    } else {
        std::ranges::generate(bytes, [&] { return static_cast<std::byte>(generator() & 0xffU); });
    }
    return bytes;
}

std::vector<std::byte> texels(const Texture2D& texture, int level = 0) {
    const glm::ivec2 size = texture.size(level);
    std::vector<std::byte> bytes(area(size) * traits(texture.format()).bytes);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(texture.id(), level, traits(texture.format()).layout,
                      traits(texture.format()).type, static_cast<GLsizei>(bytes.size()),
                      bytes.data());
    return bytes;
}

TEST_P(TextureFormatGlTest, texels_come_back_bit_for_bit_whatever_the_row_length) {
    for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(5, 3), glm::ivec2(7, 1),
                                  glm::ivec2(64, 33), glm::ivec2(127, 65)}) {
        Texture2D texture = must(Texture2D::create({.size = size, .format = GetParam()}));
        const auto content = random_texels(GetParam(), area(size), 11);
        texture.upload(0, content);
        EXPECT_EQ(texels(texture), content) << size.x << " x " << size.y;
        EXPECT_EQ(texture.bytes(), content.size());
    }
}

TEST_P(TextureFormatGlTest, every_level_holds_its_own_texels) {
    Texture2D texture =
        must(Texture2D::create({.size = {20, 9}, .format = GetParam(), .levels = full_chain}));
    ASSERT_EQ(texture.levels(), 5);
    std::vector<std::vector<std::byte>> contents;
    for (int level = 0; level < texture.levels(); ++level) {
        const glm::ivec2 size = texture.size(level);
        contents.push_back(random_texels(GetParam(), area(size), static_cast<unsigned int>(level)));
        texture.upload(level, contents.back());
    }
    for (int level = 0; level < texture.levels(); ++level) {
        EXPECT_EQ(texels(texture, level), contents[static_cast<std::size_t>(level)]);
    }
}

INSTANTIATE_TEST_SUITE_P(all, TextureFormatGlTest,
                         ::testing::Values(Format::rgba8_srgb, Format::rgba8, Format::r32f,
                                           Format::rg32f, Format::rg16_snorm, Format::rgba32f,
                                           Format::depth32f),
                         [](const auto& format) { return std::string(traits(format.param).name); });

TEST_F(TextureGlTest, mipmaps_are_the_mean_of_four) {
    Texture2D texture =
        must(Texture2D::create({.size = {8, 8}, .format = Format::r32f, .levels = full_chain}));
    Grid<float> base(8, 8);
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> height(-100.0F, 100.0F);
    std::ranges::generate(base.samples(), [&] { return height(generator); });
    texture.upload(0, base);
    texture.generate_mipmaps();
    Grid<float> half(4, 4);
    const auto bytes = texels(texture, 1);
    std::ranges::copy(bytes, std::as_writable_bytes(half.samples()).begin());
    for (int row = 0; row < 4; ++row) {
        for (int col = 0; col < 4; ++col) {
            const float mean = (base(2 * col, 2 * row) + base(2 * col + 1, 2 * row) +
                                base(2 * col, 2 * row + 1) + base(2 * col + 1, 2 * row + 1)) /
                               4.0F;
            EXPECT_NEAR(half(col, row), mean, 1e-3F);
        }
    }
}

TEST_F(TextureGlTest, srgb_mipmaps_average_light_not_bytes) {
    Texture2D texture = must(
        Texture2D::create({.size = {2, 2}, .format = Format::rgba8_srgb, .levels = full_chain}));
    Image checker(2, 2, Rgba8{0, 0, 0, 255});
    checker(0, 0) = {255, 255, 255, 255};
    checker(1, 1) = {255, 255, 255, 255};
    texture.upload(0, checker);
    texture.generate_mipmaps();
    const auto mean = std::to_integer<int>(texels(texture, 1).front());
    EXPECT_NEAR(mean, rgba8_from_linear(glm::vec3(0.5F)).r, 1); // 188, where bytes would give 128
}

float at(const Grid<float>& grid, int col, int row, Wrap wrap) {
    if (wrap == Wrap::clamp) {
        return grid.clamped(col, row);
    }
    return grid((col + 4 * grid.cols()) % grid.cols(), (row + 4 * grid.rows()) % grid.rows());
}

/// The specification's bilinear filter, chapter 8.14.2.
float bilinear(const Grid<float>& grid, glm::vec2 uv, Wrap wrap) {
    const glm::vec2 place = uv * glm::vec2(grid.cols(), grid.rows()) - 0.5F;
    const glm::ivec2 cell(glm::floor(place));
    const glm::vec2 part = place - glm::floor(place);
    const float upper =
        glm::mix(at(grid, cell.x, cell.y, wrap), at(grid, cell.x + 1, cell.y, wrap), part.x);
    const float lower = glm::mix(at(grid, cell.x, cell.y + 1, wrap),
                                 at(grid, cell.x + 1, cell.y + 1, wrap), part.x);
    return glm::mix(upper, lower, part.y);
}

float nearest(const Grid<float>& grid, glm::vec2 uv, Wrap wrap) {
    const glm::ivec2 cell(glm::floor(uv * glm::vec2(grid.cols(), grid.rows())));
    return at(grid, cell.x, cell.y, wrap);
}

TEST_F(TextureGlTest, sampling_follows_filter_and_wrap) {
    Grid<float> grid(8, 4);
    std::mt19937 generator(9);
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    std::ranges::generate(grid.samples(), [&] { return unit(generator); });
    const Framebuffer target = test::float_target({61, 47});
    Program program = test::cover_program(
        "layout(binding = 3) uniform sampler2D map;\nuniform vec2 size;\n"
        "void main() { color.xy = gl_FragCoord.xy / size * 3.0 - 1.0;\n"
        "              color.z = textureLod(map, color.xy, 0.0).r; color.w = 1.0; }");
    program.set(Uniform<glm::vec2>("size"), glm::vec2(target.size()));
    for (const Filter filter : {Filter::nearest, Filter::bilinear, Filter::trilinear}) {
        for (const Wrap wrap : {Wrap::clamp, Wrap::repeat}) {
            Texture2D texture = must(Texture2D::create(
                {.size = {8, 4}, .format = Format::r32f, .filter = filter, .wrap = wrap}));
            texture.upload(0, grid);
            texture.bind(3);
            target.bind();
            test::cover(program);
            const Grid<glm::vec4> pixels = read_float_color(target);
            for (const glm::vec4& pixel : pixels.samples()) {
                const glm::vec2 uv(pixel);
                const float expected =
                    filter == Filter::nearest ? nearest(grid, uv, wrap) : bilinear(grid, uv, wrap);
                // GPUs may keep the weights to 8 bits only; two of them act on values in [0,1].
                ASSERT_NEAR(pixel.z, expected, 2.0F / 256.0F) << uv.x << ", " << uv.y;
            }
        }
    }
}

TEST_F(TextureGlTest, trilinear_blends_levels_where_bilinear_takes_one) {
    const Framebuffer target = test::float_target({1, 1});
    const Program program = test::cover_program(
        "uniform sampler2D map;\nvoid main() { color = textureLod(map, vec2(0.5), 0.25); }");
    target.bind();
    for (const auto& [filter, expected] :
         {std::pair(Filter::bilinear, 0.0F), std::pair(Filter::trilinear, 0.25F)}) {
        Texture2D texture = must(Texture2D::create(
            {.size = {4, 4}, .format = Format::r32f, .levels = 2, .filter = filter}));
        texture.upload(0, Grid<float>(4, 4, 0.0F));
        texture.upload(1, Grid<float>(2, 2, 1.0F));
        texture.bind(0);
        test::cover(program);
        EXPECT_NEAR(read_float_color(target)(0, 0).r, expected, 1.0F / 256.0F);
    }
}

TEST_F(TextureGlTest, impossible_options_say_what_is_possible) {
    const auto message = [](const TextureOptions& options) {
        const auto texture = Texture2D::create(options);
        return texture ? std::string("no error") : texture.error().message;
    };
    EXPECT_THAT(message({.size = {0, 5}}),
                ::testing::StartsWith("GL texture of 0 x 5 texels: expected sides of 1 to "));
    EXPECT_THAT(message({.size = {100000, 100000}}),
                ::testing::StartsWith("GL texture of 100000 x 100000 texels: expected sides"));
    EXPECT_THAT(message({.size = {4, -1}}), ::testing::HasSubstr("4 x -1"));
    EXPECT_EQ(message({.size = {8, 2}, .levels = 5}),
              "GL texture of 8 x 2 texels with 5 mip levels: expected 1 to 4");
    EXPECT_THAT(message({.size = {8, 2}, .levels = -1}), ::testing::HasSubstr("-1 mip levels"));
}

TEST_F(TextureGlTest, moved_from_is_harmless) {
    Texture2D first = must(Texture2D::create({.size = {2, 2}}));
    const unsigned int id = first.id();
    Texture2D second = std::move(first);
    // NOLINTBEGIN(bugprone-use-after-move,clang-analyzer-cplusplus.Move)
    EXPECT_EQ(first.id(), 0U);
    EXPECT_EQ(first.bytes(), 0U);
    first.bind(0);
    second = Texture2D();
    EXPECT_EQ(glIsTexture(id), GL_FALSE);
    // NOLINTEND(bugprone-use-after-move,clang-analyzer-cplusplus.Move)
}

TEST_F(TextureGlTest, full_chain_ends_at_one_by_one) {
    const auto levels = [](glm::ivec2 size) {
        return must(Texture2D::create({.size = size, .levels = full_chain})).levels();
    };
    EXPECT_EQ(levels({1, 1}), 1);
    EXPECT_EQ(levels({2, 1}), 2);
    EXPECT_EQ(levels({255, 3}), 8);
    EXPECT_EQ(levels({3, 256}), 9);
}

} // namespace
} // namespace reljef::gl
