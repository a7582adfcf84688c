#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/gl/unique_id.h"

namespace reljef::gl {

enum class Format {
    rgba8_srgb, ///< 4 bytes; r, g, b are decoded when sampled and encoded when drawn to
    rgba8,      ///< 4 bytes, [0,1]
    /// The same in the order of a window's bytes, where the driver has it: software renderers copy
    /// such pictures to windows as they are. One level only.
    window8,
    r32f,
    rg32f,
    rg16_snorm,   ///< 2 int16, -32767..32767 for [-1,1]
    rgba16_snorm, ///< 4 int16, -32767..32767 for [-1,1]
    rgba32f,
    depth32f ///< 1 float, [0,1]
};

struct FormatTraits {
    std::string_view name;
    unsigned int internal = 0; ///< GL's sized internal format
    unsigned int layout = 0;   ///< client texels: GL_RGBA, …
    unsigned int type = 0;     ///< client components: GL_UNSIGNED_BYTE, …
    std::size_t bytes = 0;     ///< per client texel
};
FormatTraits traits(Format format);

/// nearest and bilinear use the nearest mip level, trilinear blends two.
enum class Filter { nearest, bilinear, trilinear };
enum class Wrap { clamp, repeat };

/// TextureOptions::levels: all levels down to 1 by 1.
inline constexpr int full_chain = 0;

struct TextureOptions {
    glm::ivec2 size{1, 1}; ///< columns, rows of level 0
    Format format = Format::rgba8;
    int levels = 1; ///< mip levels, or full_chain
    Filter filter = Filter::bilinear;
    Wrap wrap = Wrap::clamp;
};

/// Size of a mip level.
glm::ivec2 level_size(glm::ivec2 size, int level);
/// 1 + floor(log2(longer side)). Precondition: size > 0.
int full_chain_levels(glm::ivec2 size);
/// Fails unless the sides are in 1..GL_MAX_TEXTURE_SIZE and the size has the levels.
Result<void> check_texture(const TextureOptions& options);
/// Sets filters and wrap mode of a texture with `levels` levels.
void set_sampling(unsigned int texture, const TextureOptions& options, int levels);

/// A 2D texture of fixed size and format. Row 0 of an upload is at v = 0.
class Texture2D {
public:
    Texture2D() = default;

    /// Undefined content. Fails when a side is not in 1..GL_MAX_TEXTURE_SIZE, the size has fewer
    /// levels, or the driver has no memory.
    static Result<Texture2D> create(const TextureOptions& options);

    /// Replaces one level; rows without padding. Precondition: the level exists; the byte count is
    /// exact.
    void upload(int level, std::span<const std::byte> texels);
    /// Precondition: the sizes and sizeof(T) match.
    template <class T> void upload(int level, const Grid<T>& texels) {
        check(glm::ivec2(texels.cols(), texels.rows()) == size(level), "grid of another size");
        check(sizeof(T) == traits(format_).bytes, "grid of another texel format");
        upload(level, std::as_bytes(texels.samples()));
    }
    /// Replaces a rectangle of level 0 from column and row `low`. Preconditions: it lies in the
    /// level; sizeof(T) matches.
    template <class T> void upload_area(glm::ivec2 low, const GridView<T>& texels) {
        check(sizeof(T) == traits(format_).bytes, "grid of another texel format");
        if (!texels.empty()) {
            const auto stride =
                texels.rows() > 1 ? &texels(0, 1) - &texels(0, 0) : std::ptrdiff_t{texels.cols()};
            upload_area(low, {texels.cols(), texels.rows()}, &texels(0, 0), stride);
        }
    }
    /// Makes levels 1 and up from level 0 (box filter; sRGB averages in linear light).
    void generate_mipmaps();

    /// GLSL `layout(binding = unit)`.
    void bind(unsigned int unit) const;

    [[nodiscard]] unsigned int id() const { return id_.get(); }
    [[nodiscard]] glm::ivec2 size() const { return size_; }
    /// Precondition: the level exists.
    [[nodiscard]] glm::ivec2 size(int level) const;
    [[nodiscard]] int levels() const { return levels_; }
    [[nodiscard]] Format format() const { return format_; }
    /// Bytes of all levels, as uploaded.
    [[nodiscard]] std::size_t bytes() const;

private:
    // `stride`: texels from a row to the next.
    void upload_area(glm::ivec2 low, glm::ivec2 size, const void* texels, std::ptrdiff_t stride);

    UniqueId<delete_texture> id_;
    glm::ivec2 size_{0, 0};
    int levels_ = 0;
    Format format_ = Format::rgba8;
};

} // namespace reljef::gl
