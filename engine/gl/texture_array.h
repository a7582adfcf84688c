#pragma once

#include <cstddef>
#include <span>

#include "engine/gl/texture.h"

namespace reljef::gl {

/// Layers that every OpenGL 4.5 has.
inline constexpr int max_layers = 2048;

/// Textures of one size and format, the layers of one texture. Row 0 of an upload is at v = 0.
class TextureArray {
public:
    TextureArray() = default;

    /// Undefined content. Fails as Texture2D::create(), and when `layers` is not in 1..max_layers.
    static Result<TextureArray> create(const TextureOptions& options, int layers);

    /// Replaces one level of a layer; rows without padding. Precondition: both exist; the byte
    /// count is exact.
    void upload(int layer, int level, std::span<const std::byte> texels);
    /// Precondition: the sizes and sizeof(T) match.
    template <class T> void upload(int layer, int level, const Grid<T>& texels) {
        check(glm::ivec2(texels.cols(), texels.rows()) == size(level), "grid of another size");
        check(sizeof(T) == traits(format_).bytes, "grid of another texel format");
        upload(layer, level, std::as_bytes(texels.samples()));
    }
    /// Copies all levels. Precondition: a texture of the same size, format and levels.
    void copy(int layer, const Texture2D& from);

    /// GLSL `layout(binding = unit)`.
    void bind(unsigned int unit) const;

    [[nodiscard]] glm::ivec2 size() const { return size_; }
    /// Precondition: the level exists.
    [[nodiscard]] glm::ivec2 size(int level) const;
    [[nodiscard]] int layers() const { return layers_; }
    [[nodiscard]] int levels() const { return levels_; }
    /// Bytes of all levels of a layer, as uploaded.
    [[nodiscard]] std::size_t bytes_per_layer() const;

private:
    UniqueId<delete_texture> id_;
    glm::ivec2 size_{0, 0};
    int layers_ = 0;
    int levels_ = 0;
    Format format_ = Format::rgba8;
};

} // namespace reljef::gl
