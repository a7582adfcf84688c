#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/gtc/type_precision.hpp>
#include <glm/vec4.hpp>

#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/gl/texture.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

// All of these count the upload and fail when GL has no memory.

/// A texture with level 0 from `texels`; the other levels are generated.
Result<gl::Texture2D> upload_texture(const gl::TextureOptions& options,
                                     std::span<const std::byte> texels, view::FrameStats& stats);

/// The same from a grid, which sets options.size.
template <class T>
Result<gl::Texture2D> upload_grid(const Grid<T>& texels, gl::TextureOptions options,
                                  view::FrameStats& stats) {
    options.size = {texels.cols(), texels.rows()};
    return upload_texture(options, std::as_bytes(texels.samples()), stats);
}

/// The same with all mip levels and trilinear filtering.
template <class T>
Result<gl::Texture2D> upload_mipmapped(const Grid<T>& texels, gl::Format format,
                                       view::FrameStats& stats, gl::Wrap wrap = gl::Wrap::clamp) {
    return upload_grid(
        texels,
        {.format = format, .levels = gl::full_chain, .filter = gl::Filter::trilinear, .wrap = wrap},
        stats);
}

/// One level after the other, as from max_mipmap().
Result<gl::Texture2D> upload_levels(const std::vector<Grid<float>>& levels,
                                    view::FrameStats& stats);

/// Four floats per texel that change every frame; reuses the last frame's texture if it fits.
Result<gl::Texture2D> upload_places(const Grid<glm::vec4>& places, gl::Texture2D& last,
                                    view::FrameStats& stats);

Result<void> keep(Result<gl::Texture2D> made, std::optional<gl::Texture2D>& place);

/// Values in [-1,1] as rgba16_snorm.
Grid<glm::i16vec4> snorm16(const Grid<glm::vec4>& values);

} // namespace reljef::render
