#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "engine/core/color.h"
#include "engine/core/result.h"
#include "engine/gl/texture.h"
#include "engine/gl/unique_id.h"

namespace reljef::gl {

struct FramebufferOptions {
    glm::ivec2 size{1, 1};
    Format color = Format::rgba8_srgb;
    std::optional<Format> second_color = std::nullopt; ///< for fragment output 1; one sample only
    bool depth = true;                                 ///< 32-bit float
    int samples = 1;
};

/// The possible samples per pixel with these formats, ascending; 1 is always possible.
std::vector<int> sample_counts(const FramebufferOptions& options);

/// Makes the window's back buffer the draw target; what is drawn are its bytes.
void bind_window();

/// Where the first row of a picture's texels is shown.
enum class FirstRow { bottom, top };

/// A colour target and an optional 32-bit float depth. The colour is a texture whose row 0 is the
/// bottom of the picture. With several samples per pixel there is no texture: use resolve_to().
class Framebuffer {
public:
    Framebuffer() = default;

    /// Undefined content. Fails when the size or the number of samples is not possible, or when the
    /// driver refuses the combination or has no memory.
    static Result<Framebuffer> create(const FramebufferOptions& options);

    /// Makes it the draw target, sets the viewport to its size and turns sRGB encoding on.
    void bind() const;
    /// `linear` is encoded for rgba8_srgb. A second colour becomes 0.
    void clear_color(glm::vec4 linear) const;
    /// 0 is the far end of a reversed depth. Precondition: it has a depth; depth writing is on.
    void clear_depth(float depth = 0.0F) const;
    /// Copies the encoded bytes onto the window's back buffer; scales when the sizes differ.
    void blit_to_window(glm::ivec2 window_size, FirstRow first = FirstRow::bottom) const;
    /// The same of a rectangle of a picture whose first row is on top, to a window of its size:
    /// upper left corner and size, pixels.
    void blit_area_to_window(glm::ivec2 low, glm::ivec2 size) const;
    /// Replaces the colours. Preconditions: 8 bits a colour, one sample, equal sizes.
    void upload(const Grid<Rgba8>& texels) { color_.upload(0, texels); }
    /// Replaces the colours of a rectangle from column and row `low`. Preconditions: as above, and
    /// the rectangle lies in the picture.
    void upload_area(glm::ivec2 low, const GridView<const Rgba8>& texels) {
        color_.upload_area(low, texels);
    }

    /// Copies the colour to `target`: the mean of a pixel's samples, in linear light for
    /// rgba8_srgb. Precondition: equal sizes and formats; the target has one sample.
    void resolve_to(const Framebuffer& target) const;

    [[nodiscard]] unsigned int id() const { return id_.get(); }
    [[nodiscard]] glm::ivec2 size() const { return size_; }
    [[nodiscard]] int samples() const { return samples_; }
    /// Precondition: one sample per pixel.
    [[nodiscard]] const Texture2D& color() const;
    /// Precondition: created with a second colour.
    [[nodiscard]] const Texture2D& second_color() const;

private:
    Result<void> attach_color(const FramebufferOptions& options);
    Result<void> attach_second_color(const FramebufferOptions& options);
    Result<void> attach_depth(const FramebufferOptions& options);

    UniqueId<delete_framebuffer> id_;
    Texture2D color_;
    Texture2D second_color_;
    UniqueId<delete_renderbuffer> sample_color_; // instead of the texture, with several samples
    UniqueId<delete_renderbuffer> depth_;
    glm::ivec2 size_{0, 0};
    int samples_ = 1;
};

} // namespace reljef::gl
