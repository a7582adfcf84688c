#include "engine/gl/texture.h"

#include <algorithm>
#include <bit>

#include <fmt/format.h>
#include <glad/gl.h>

#include "engine/gl/memory.h"
#include "engine/gl/texture_format.h"

namespace reljef::gl {

namespace {

glm::ivec2 level_size(glm::ivec2 size, int level) {
    return {std::max(size.x >> level, 1), std::max(size.y >> level, 1)};
}

GLint minification(Filter filter, int levels) {
    switch (filter) {
    case Filter::nearest:
        return levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST;
    case Filter::bilinear:
        return levels > 1 ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR;
    case Filter::trilinear:
        return levels > 1 ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR;
    }
    abort_with("unknown filter");
}

Result<void> check_size(glm::ivec2 size, int levels) {
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    if (size.x < 1 || size.y < 1 || size.x > most || size.y > most) {
        return Error{fmt::format("GL texture of {} x {} texels: expected sides of 1 to {}", size.x,
                                 size.y, most)};
    }
    if (levels < 0 || levels > full_chain_levels(size)) {
        return Error{
            fmt::format("GL texture of {} x {} texels with {} mip levels: expected 1 to {}", size.x,
                        size.y, levels, full_chain_levels(size))};
    }
    return {};
}

} // namespace

std::string_view to_string(Format format) {
    return traits(format).name;
}

std::size_t bytes_per_texel(Format format) {
    return traits(format).bytes;
}

int full_chain_levels(glm::ivec2 size) {
    check(size.x > 0 && size.y > 0, "mip levels of an empty texture");
    return static_cast<int>(std::bit_width(static_cast<unsigned int>(std::max(size.x, size.y))));
}

Result<Texture2D> Texture2D::create(const TextureOptions& options) {
    if (const auto sized = check_size(options.size, options.levels); !sized) {
        return sized.error();
    }
    Texture2D texture;
    texture.size_ = options.size;
    texture.format_ = options.format;
    texture.levels_ =
        options.levels == full_chain ? full_chain_levels(options.size) : options.levels;
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    texture.id_ = UniqueId<delete_texture>(name);
    glTextureStorage2D(name, texture.levels_, traits(options.format).internal, options.size.x,
                       options.size.y);
    if (ran_out_of_memory()) {
        return Error{fmt::format("GL texture of {} x {} {} texels: the driver has no memory for it",
                                 options.size.x, options.size.y, to_string(options.format))};
    }
    texture.set_filter(options.filter);
    texture.set_wrap(options.wrap);
    return texture;
}

void Texture2D::upload(int level, std::span<const std::byte> texels) {
    upload(level, {0, 0}, size(level), texels);
}

void Texture2D::upload(int level, glm::ivec2 offset, glm::ivec2 size,
                       std::span<const std::byte> texels) {
    const glm::ivec2 whole = this->size(level);
    check(offset.x >= 0 && offset.y >= 0 && size.x > 0 && size.y > 0 &&
              offset.x <= whole.x - size.x && offset.y <= whole.y - size.y,
          "upload outside its texture");
    check(texels.size() == static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                               bytes_per_texel(format_),
          "upload of another byte count");
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(id(), level, offset.x, offset.y, size.x, size.y, traits(format_).layout,
                        traits(format_).type, texels.data());
}

void Texture2D::generate_mipmaps() {
    if (levels_ > 1) {
        glGenerateTextureMipmap(id());
    }
}

void Texture2D::set_filter(Filter filter) {
    glTextureParameteri(id(), GL_TEXTURE_MIN_FILTER, minification(filter, levels_));
    glTextureParameteri(id(), GL_TEXTURE_MAG_FILTER,
                        filter == Filter::nearest ? GL_NEAREST : GL_LINEAR);
}

void Texture2D::set_wrap(Wrap wrap) {
    const GLint mode = wrap == Wrap::repeat ? GL_REPEAT : GL_CLAMP_TO_EDGE;
    glTextureParameteri(id(), GL_TEXTURE_WRAP_S, mode);
    glTextureParameteri(id(), GL_TEXTURE_WRAP_T, mode);
}

void Texture2D::bind(unsigned int unit) const {
    glBindTextureUnit(unit, id());
}

glm::ivec2 Texture2D::size(int level) const {
    check(id() != 0U && level >= 0 && level < levels_, "texture has no such level");
    return level_size(size_, level);
}

std::size_t Texture2D::bytes() const {
    std::size_t sum = 0;
    for (int level = 0; id() != 0U && level < levels_; ++level) {
        const glm::ivec2 size = level_size(size_, level);
        sum += static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
    }
    return sum * bytes_per_texel(format_);
}

} // namespace reljef::gl
