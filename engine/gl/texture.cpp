#include "engine/gl/texture.h"

#include <algorithm>
#include <bit>

#include <fmt/format.h>
#include <glad/gl.h>

#include "engine/gl/limits.h"

namespace reljef::gl {

namespace {

GLint minification(Filter filter, int levels) {
    if (levels == 1) {
        return filter == Filter::nearest ? GL_NEAREST : GL_LINEAR;
    }
    return filter == Filter::nearest    ? GL_NEAREST_MIPMAP_NEAREST
           : filter == Filter::bilinear ? GL_LINEAR_MIPMAP_NEAREST
                                        : GL_LINEAR_MIPMAP_LINEAR;
}

// GL has no sized format in that order. Mesa chooses it for texels that are given so.
void allocate_in_order_of_windows(unsigned int texture, glm::ivec2 size) {
    GLint bound = 0;
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, size.x, size.y, 0, GL_BGRA, GL_UNSIGNED_BYTE, nullptr);
    glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(bound));
}

} // namespace

glm::ivec2 level_size(glm::ivec2 size, int level) {
    return {std::max(size.x >> level, 1), std::max(size.y >> level, 1)};
}

int full_chain_levels(glm::ivec2 size) {
    return static_cast<int>(std::bit_width(static_cast<unsigned int>(std::max(size.x, size.y))));
}

Result<void> check_texture(const TextureOptions& options) {
    const glm::ivec2 size = options.size;
    const int levels = options.levels;
    GLint max = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &max);
    if (size.x < 1 || size.y < 1 || size.x > max || size.y > max) {
        return Error{fmt::format("GL texture of {} x {} texels: expected sides of 1 to {}", size.x,
                                 size.y, max)};
    }
    if (levels < 0 || levels > full_chain_levels(size)) {
        return Error{
            fmt::format("GL texture of {} x {} texels with {} mip levels: expected 1 to {}", size.x,
                        size.y, levels, full_chain_levels(size))};
    }
    return {};
}

void set_sampling(unsigned int texture, const TextureOptions& options, int levels) {
    glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, minification(options.filter, levels));
    glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER,
                        options.filter == Filter::nearest ? GL_NEAREST : GL_LINEAR);
    const GLint mode = options.wrap == Wrap::repeat ? GL_REPEAT : GL_CLAMP_TO_EDGE;
    glTextureParameteri(texture, GL_TEXTURE_WRAP_S, mode);
    glTextureParameteri(texture, GL_TEXTURE_WRAP_T, mode);
}

FormatTraits traits(Format format) {
    switch (format) {
    case Format::rgba8_srgb:
        return {"rgba8_srgb", GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
    case Format::rgba8:
        return {"rgba8", GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
    case Format::window8:
        return {"window8", GL_RGBA, GL_RGBA, GL_UNSIGNED_BYTE, 4};
    case Format::r32f:
        return {"r32f", GL_R32F, GL_RED, GL_FLOAT, 4};
    case Format::rg32f:
        return {"rg32f", GL_RG32F, GL_RG, GL_FLOAT, 8};
    case Format::rg16_snorm:
        return {"rg16_snorm", GL_RG16_SNORM, GL_RG, GL_SHORT, 4};
    case Format::rgba16_snorm:
        return {"rgba16_snorm", GL_RGBA16_SNORM, GL_RGBA, GL_SHORT, 8};
    case Format::rgba32f:
        return {"rgba32f", GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
    case Format::depth32f:
        return {"depth32f", GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4};
    }
    abort_with("unknown texture format");
}

Result<Texture2D> Texture2D::create(const TextureOptions& options) {
    if (const auto sized = check_texture(options); !sized) {
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
    if (options.format == Format::window8) {
        check(texture.levels_ == 1, "a picture for windows has one level");
        allocate_in_order_of_windows(name, options.size);
    } else {
        glTextureStorage2D(name, texture.levels_, traits(options.format).internal, options.size.x,
                           options.size.y);
    }
    if (ran_out_of_memory()) {
        return Error{fmt::format("GL texture of {} x {} {} texels: the driver has no memory for it",
                                 options.size.x, options.size.y, traits(options.format).name)};
    }
    set_sampling(name, options, texture.levels_);
    return texture;
}

void Texture2D::upload(int level, std::span<const std::byte> texels) {
    const glm::ivec2 area = size(level);
    const FormatTraits format = traits(format_);
    check(texels.size() ==
              static_cast<std::size_t>(area.x) * static_cast<std::size_t>(area.y) * format.bytes,
          "upload of another byte count");
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(id(), level, 0, 0, area.x, area.y, format.layout, format.type,
                        texels.data());
}

void Texture2D::upload_area(glm::ivec2 low, glm::ivec2 size, const void* texels,
                            std::ptrdiff_t stride) {
    check(low.x >= 0 && low.y >= 0 && size.x <= size_.x - low.x && size.y <= size_.y - low.y,
          "upload outside of a texture");
    const FormatTraits format = traits(format_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, static_cast<GLint>(stride));
    glTextureSubImage2D(id(), 0, low.x, low.y, size.x, size.y, format.layout, format.type, texels);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

void Texture2D::generate_mipmaps() {
    if (levels_ > 1) {
        glGenerateTextureMipmap(id());
    }
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
    return sum * traits(format_).bytes;
}

} // namespace reljef::gl
