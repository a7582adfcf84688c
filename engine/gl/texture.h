#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/gl/unique_id.h"

namespace reljef::gl {

/// Of a texel, in the driver's memory and in every upload.
enum class Format {
    rgba8_srgb,   ///< 4 bytes; r, g, b are decoded to linear when sampled, encoded when drawn to
    rgba8,        ///< 4 bytes, [0,1]
    r8,           ///< 1 byte, [0,1]
    r32f,         ///< 1 float
    rg16f,        ///< 2 half floats (glm::packHalf)
    rg32f,        ///< 2 floats
    rg16_snorm,   ///< 2 int16, -32767..32767 for [-1,1]
    rgba16_snorm, ///< 4 int16, -32767..32767 for [-1,1]
    rgba32f,      ///< 4 floats
    depth32f      ///< 1 float, [0,1]
};

/// "rgba8_srgb", …
std::string_view to_string(Format format);
std::size_t bytes_per_texel(Format format);

/// How the mip levels, where there are several, join in: nearest and bilinear take the nearest
/// level, trilinear blends two.
enum class Filter { nearest, bilinear, trilinear };
enum class Wrap { clamp, repeat };

/// For TextureOptions::levels: down to 1 by 1.
inline constexpr int full_chain = 0;

struct TextureOptions {
    glm::ivec2 size{1, 1}; ///< columns, rows of level 0
    Format format = Format::rgba8;
    int levels = 1; ///< mip levels, or full_chain
    Filter filter = Filter::bilinear;
    Wrap wrap = Wrap::clamp;
};

/// Levels of a full chain: 1 + floor(log2(the longer side)). Precondition: size > 0.
int full_chain_levels(glm::ivec2 size);

/// A 2D texture of fixed size and format. Row 0 of an upload is the row at v = 0 (so a map's north
/// row is at v = 0). Default-constructed and moved-from ones hold nothing (id 0).
class Texture2D {
public:
    Texture2D() = default;

    /// Undefined content. Fails when a side is not in 1..GL_MAX_TEXTURE_SIZE, when there are more
    /// levels than the size has, or when the driver has no memory.
    static Result<Texture2D> create(const TextureOptions& options);

    /// Replaces one level; texels row after row without padding. Precondition: the level exists and
    /// the byte count is exact.
    void upload(int level, std::span<const std::byte> texels);
    /// Replaces a rectangle of one level. Precondition: it lies inside, the byte count is exact.
    void upload(int level, glm::ivec2 offset, glm::ivec2 size, std::span<const std::byte> texels);
    /// Replaces one level by a grid of its size. Precondition: sizes and sizeof(T) match.
    template <class T> void upload(int level, const Grid<T>& texels) {
        check(glm::ivec2(texels.cols(), texels.rows()) == size(level), "grid of another size");
        check(sizeof(T) == bytes_per_texel(format_), "grid of another texel format");
        upload(level, std::as_bytes(texels.samples()));
    }
    /// Levels 1 and up from level 0 (a box filter; sRGB averages in linear light).
    void generate_mipmaps();

    void set_filter(Filter filter);
    void set_wrap(Wrap wrap);
    /// What texture units sample: GLSL `layout(binding = unit)`.
    void bind(unsigned int unit) const;

    [[nodiscard]] unsigned int id() const { return id_.get(); }
    [[nodiscard]] glm::ivec2 size() const { return size_; }
    /// Precondition: the level exists.
    [[nodiscard]] glm::ivec2 size(int level) const;
    [[nodiscard]] int levels() const { return levels_; }
    [[nodiscard]] Format format() const { return format_; }
    /// Of all levels, as uploaded.
    [[nodiscard]] std::size_t bytes() const;

private:
    UniqueId<delete_texture> id_;
    glm::ivec2 size_{0, 0};
    int levels_ = 0;
    Format format_ = Format::rgba8;
};

} // namespace reljef::gl
