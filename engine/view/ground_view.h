#pragma once

#include <glm/vec2.hpp>

#include "engine/scene/graph/camera.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::view {

/// How much is seen of the tile of detail that lies over a terrain.
enum class DetailLevel {
    none,  ///< too far: the terrain alone
    light, ///< its colour and its light
    relief ///< its heights, where the technique looks for them
};

/// A tile begins to be seen where it is so wide on the picture, pixels, and is wholly seen there.
inline constexpr glm::vec2 seen_tile_pixels{8.0F, 32.0F};

/// Its heights begin to be looked for where they are so high on the picture, pixels, and are wholly
/// there: the error that the polygons may show, else a pixel, and twice as much.
glm::vec2 seen_height_pixels(const scene::TerrainNode& terrain);

/// Metres that a pixel shows across: at the eye (x), and more for each metre away (y).
glm::vec2 metres_a_pixel(const scene::Camera& camera, glm::ivec2 size);

/// What is seen at no less than that distance, metres.
DetailLevel seen_detail(const scene::TerrainNode& terrain, const scene::Camera& camera,
                        glm::ivec2 size, double distance);

} // namespace reljef::view
