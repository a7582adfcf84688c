#include "engine/gl/texture_array.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include "engine/gl/limits.h"

namespace reljef::gl {

Result<TextureArray> TextureArray::create(const TextureOptions& options, int layers) {
    if (auto sized = check_texture(options); !sized) {
        return sized.error();
    }
    if (layers < 1 || layers > max_layers) {
        return Error{
            fmt::format("GL texture array of {} layers: expected 1 to {}", layers, max_layers)};
    }
    TextureArray texture;
    texture.size_ = options.size;
    texture.layers_ = layers;
    texture.format_ = options.format;
    texture.levels_ =
        options.levels == full_chain ? full_chain_levels(options.size) : options.levels;
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &name);
    texture.id_ = UniqueId<delete_texture>(name);
    glTextureStorage3D(name, texture.levels_, traits(options.format).internal, options.size.x,
                       options.size.y, layers);
    if (ran_out_of_memory()) {
        return Error{fmt::format("GL texture array of {} x {} x {} {} texels: the driver has no "
                                 "memory for it",
                                 options.size.x, options.size.y, layers,
                                 traits(options.format).name)};
    }
    set_sampling(name, options, texture.levels_);
    return texture;
}

void TextureArray::upload(int layer, int level, std::span<const std::byte> texels) {
    const glm::ivec2 area = size(level);
    const FormatTraits format = traits(format_);
    check(layer >= 0 && layer < layers_, "texture array has no such layer");
    check(texels.size() ==
              static_cast<std::size_t>(area.x) * static_cast<std::size_t>(area.y) * format.bytes,
          "upload of another byte count");
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage3D(id_.get(), level, 0, 0, layer, area.x, area.y, 1, format.layout,
                        format.type, texels.data());
}

void TextureArray::copy(int layer, const Texture2D& from) {
    check(layer >= 0 && layer < layers_, "texture array has no such layer");
    check(from.size() == size_ && from.levels() == levels_ && from.format() == format_,
          "copy of another kind of texture");
    for (int level = 0; level < levels_; ++level) {
        const glm::ivec2 area = size(level);
        glCopyImageSubData(from.id(), GL_TEXTURE_2D, level, 0, 0, 0, id_.get(), GL_TEXTURE_2D_ARRAY,
                           level, 0, 0, layer, area.x, area.y, 1);
    }
}

void TextureArray::bind(unsigned int unit) const {
    glBindTextureUnit(unit, id_.get());
}

glm::ivec2 TextureArray::size(int level) const {
    check(id_.get() != 0U && level >= 0 && level < levels_, "texture has no such level");
    return level_size(size_, level);
}

std::size_t TextureArray::bytes_per_layer() const {
    std::size_t sum = 0;
    for (int level = 0; level < levels_; ++level) {
        const glm::ivec2 area = level_size(size_, level);
        sum += static_cast<std::size_t>(area.x) * static_cast<std::size_t>(area.y);
    }
    return sum * traits(format_).bytes;
}

} // namespace reljef::gl
