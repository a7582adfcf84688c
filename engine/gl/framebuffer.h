#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "engine/core/result.h"
#include "engine/gl/texture.h"
#include "engine/gl/unique_id.h"

namespace reljef::gl {

struct FramebufferOptions {
    glm::ivec2 size{1, 1};
    std::vector<Format> colors{
        Format::rgba8_srgb}; ///< GLSL `layout(location = index)`; may be empty
    bool depth = true;       ///< a depth32f texture
    int samples = 1; ///< of a pixel; with more than one there are no textures, see resolve_to()
};

/// How many samples a pixel may have with these formats, rising; 1 is always among them.
std::vector<int> sample_counts(const FramebufferOptions& options);

/// Colour textures and a 32-bit float depth texture to draw to. Row 0 of a texture is the bottom of
/// the picture. With several samples a pixel it has no textures: resolve_to() copies the picture to
/// one that has. Default-constructed and moved-from ones hold nothing (id 0).
class Framebuffer {
public:
    Framebuffer() = default;

    /// Undefined content. Fails when the size is outside 1..the driver's maximum, when the driver
    /// has not that many samples, refuses the combination, or has no memory.
    static Result<Framebuffer> create(const FramebufferOptions& options);

    /// The target of what is drawn from now on; sets the viewport to all of it, and encodes what is
    /// written to rgba8_srgb.
    void bind() const;
    /// All of the colour; `linear` is encoded for rgba8_srgb. Precondition: the colour exists.
    void clear_color(glm::vec4 linear, std::size_t index = 0) const;
    /// 0 is the far end of a reversed depth. Needs depth writing on. Precondition: it has a depth.
    void clear_depth(float depth = 0.0F) const;
    /// Copies the colour's encoded bytes onto the window's back buffer, scaled when sizes differ.
    void blit_to_window(glm::ivec2 window_size, std::size_t index = 0) const;

    /// Copies the colour to another framebuffer's: the mean of a pixel's samples, in linear light
    /// for rgba8_srgb. Precondition: sizes and formats are the same, and the other has one sample.
    void resolve_to(const Framebuffer& target, std::size_t index = 0) const;

    [[nodiscard]] unsigned int id() const { return id_.get(); }
    [[nodiscard]] glm::ivec2 size() const { return size_; }
    [[nodiscard]] int samples() const { return samples_; }
    [[nodiscard]] std::size_t color_count() const { return colors_.size() + sample_colors_.size(); }
    /// Precondition: the colour, or the depth, exists, and a pixel has one sample.
    [[nodiscard]] const Texture2D& color(std::size_t index = 0) const;
    [[nodiscard]] const Texture2D& depth() const;
    [[nodiscard]] bool has_depth() const { return depth_.id() != 0U || sample_depth_.get() != 0U; }

private:
    using Renderbuffer = UniqueId<delete_renderbuffer>;

    Result<void> attach_textures(const FramebufferOptions& options);
    Result<void> attach_samples(const FramebufferOptions& options);

    UniqueId<delete_framebuffer> id_;
    std::vector<Texture2D> colors_;
    Texture2D depth_;
    std::vector<Renderbuffer> sample_colors_; // instead of the textures, with several samples
    Renderbuffer sample_depth_;
    glm::ivec2 size_{0, 0};
    int samples_ = 1;
};

/// The window's own back buffer becomes the target; sets the viewport.
void bind_window_framebuffer(glm::ivec2 window_size);

} // namespace reljef::gl
