#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/gl/texture.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// A texture with all mip levels, of texels row after row. Fails when the driver has no memory.
Result<gl::Texture2D> mipmapped(glm::ivec2 size, gl::Format format,
                                std::span<const std::byte> texels, view::FrameStats& stats,
                                gl::Wrap wrap = gl::Wrap::clamp);

/// Heights as 32-bit floats, bilinear, of one level.
Result<gl::Texture2D> height_texture(const Grid<float>& heights, view::FrameStats& stats);

/// The same of a tile that may repeat, with coarser levels for what is seen from afar.
Result<gl::Texture2D> tile_height_texture(const Grid<float>& heights, gl::Wrap wrap,
                                          view::FrameStats& stats);

/// One level after the other, as max_mipmap() gives them.
Result<gl::Texture2D> pyramid_texture(const std::vector<Grid<float>>& levels,
                                      view::FrameStats& stats);

/// For places that change each frame, four floats each: the last frame's texture where it fits.
Result<gl::Texture2D> place_texture(glm::ivec2 size, gl::Texture2D& before);

/// Puts a texture that could be made into its place.
Result<void> keep(Result<gl::Texture2D> made, std::optional<gl::Texture2D>& place);

} // namespace reljef::render
