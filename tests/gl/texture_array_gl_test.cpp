#include "engine/gl/texture_array.h"

#include <cstdint>
#include <vector>

#include <glad/gl.h>

#include "engine/core/grid.h"
#include "tests/gl/gl_fixture.h"

namespace reljef::gl {
namespace {

using test::must;
using TextureArrayGlTest = test::GlTest;

// Of the layer at unit 0.
std::vector<float> layer_texels(const TextureArray& array, int layer, int level) {
    array.bind(0);
    GLint name = 0;
    glActiveTexture(GL_TEXTURE0);
    glGetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &name);
    const glm::ivec2 size = array.size(level);
    std::vector<float> values(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureSubImage(static_cast<GLuint>(name), level, 0, 0, layer, size.x, size.y, 1, GL_RED,
                         GL_FLOAT, static_cast<GLsizei>(values.size() * sizeof(float)),
                         values.data());
    return values;
}

TEST_F(TextureArrayGlTest, LayersKeepTheirTexels) {
    auto array = must(TextureArray::create({.size = {5, 3},
                                            .format = Format::r32f,
                                            .levels = full_chain,
                                            .filter = Filter::nearest,
                                            .wrap = Wrap::clamp},
                                           3));
    EXPECT_EQ(array.levels(), 3);
    for (int layer = 0; layer < 3; ++layer) {
        for (int level = 0; level < array.levels(); ++level) {
            const glm::ivec2 size = array.size(level);
            array.upload(layer, level,
                         Grid<float>(size.x, size.y, static_cast<float>(10 * layer + level)));
        }
    }
    for (int layer = 0; layer < 3; ++layer) {
        for (int level = 0; level < array.levels(); ++level) {
            for (const float value : layer_texels(array, layer, level)) {
                ASSERT_EQ(value, static_cast<float>(10 * layer + level));
            }
        }
    }
    EXPECT_EQ(array.bytes_per_layer(), 4U * (15U + 2U + 1U));
}

TEST_F(TextureArrayGlTest, ACopyHasAllLevels) {
    auto texture =
        must(Texture2D::create({.size = {4, 4}, .format = Format::r32f, .levels = full_chain}));
    Grid<float> texels(4, 4);
    for (int row = 0; row < 4; ++row) {
        for (int col = 0; col < 4; ++col) {
            texels(col, row) = static_cast<float>(col + 4 * row);
        }
    }
    texture.upload(0, texels);
    texture.generate_mipmaps();
    auto array = must(
        TextureArray::create({.size = {4, 4}, .format = Format::r32f, .levels = full_chain}, 2));
    array.copy(1, texture);
    EXPECT_EQ(layer_texels(array, 1, 0),
              std::vector<float>(texels.samples().begin(), texels.samples().end()));
    EXPECT_EQ(layer_texels(array, 1, 2), std::vector<float>{7.5F});
}

TEST_F(TextureArrayGlTest, TooManyLayersAreAnError) {
    EXPECT_FALSE(TextureArray::create({.size = {4, 4}}, max_layers + 1));
    EXPECT_FALSE(TextureArray::create({.size = {4, 4}}, 0));
    EXPECT_FALSE(TextureArray::create({.size = {0, 4}}, 1));
}

} // namespace
} // namespace reljef::gl
