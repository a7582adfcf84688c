#pragma once

#include <glm/vec2.hpp>

#include "engine/scene/graph/camera.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::view {

/// How much of the detail tile over a terrain is visible.
enum class DetailLevel {
    none,  ///< too far: the terrain alone
    light, ///< its colour and its light
    relief ///< its heights, if the technique searches for them
};

/// Widths of a detail tile on the picture between which it fades in, pixels.
inline constexpr glm::vec2 seen_tile_pixels{8.0F, 32.0F};

/// Heights of a detail tile on the picture between which its relief fades in, pixels: the error
/// bound of the polygons, or one pixel, and twice that.
glm::vec2 seen_height_pixels(const scene::TerrainNode& terrain);

/// Width of a pixel, metres: x at the eye, plus y per metre of distance.
glm::vec2 metres_a_pixel(const scene::Camera& camera, glm::ivec2 size);

/// The level at a distance of at least `distance` metres.
DetailLevel seen_detail(const scene::TerrainNode& terrain, const scene::Camera& camera,
                        glm::ivec2 size, double distance);

} // namespace reljef::view
