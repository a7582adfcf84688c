#pragma once

#include <glm/vec2.hpp>

#include "engine/cast/picture_rays.h"
#include "engine/cast/ray_tile.h"

namespace reljef::cast {

/// A rectangle of a picture, pixels.
struct PixelBlock {
    glm::ivec2 first{0};
    glm::ivec2 size{0};
};

/// The size of the parts of a block whose rays bend too much together: its quarters, down to the
/// pixels of a beam; then parts of a row, down to a pixel.
glm::ivec2 part_size(glm::ivec2 size);

/// The t from which rays of a block may hit the tile; before it none does, also none whose floats
/// are rounded. Not before `begin`, which such a t of a larger block is. Infinity: no ray of the
/// block hits (Laine and Karras 2010, "Efficient Sparse Voxel Octrees": beam optimization; here
/// with a maximum mipmap).
double clear_until(const RayTile& tile, const PictureRays& rays, const PixelBlock& block,
                   double begin);

} // namespace reljef::cast
