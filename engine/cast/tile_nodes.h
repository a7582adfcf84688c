#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/cast/beam.h"
#include "engine/cast/picture_rays.h"
#include "engine/core/geometry.h"

namespace reljef::cast {

/// A part of a terrain, in the tree that orders its tiles for rays. Places are in the samples of
/// the rays.
struct TileNode {
    Box box;         ///< samples and metres of height
    PixelBlock seen; ///< no other pixel shows it
    glm::dvec2 lines{0.0};
    /// Nodes on the four sides of the lines: 1 is added in the east, 2 in the south. Negative:
    /// nothing is drawn there.
    std::array<int, 4> parts{-1, -1, -1, -1};
    int tile = -1; ///< index of a tile, which has no parts
};

/// The first node is the root.
using TileNodes = std::vector<TileNode>;

/// Parts of a block along each side between which bent rays are as good as linear.
inline constexpr int course_parts = 8;

/// A tile on the way of rays.
struct TileAlong {
    std::size_t tile = 0; ///< index
    double by = 0.0;      ///< columns: added to the rays', those of the tile's turn of a globe

    friend bool operator==(const TileAlong&, const TileAlong&) = default;
};

struct TilesAlong {
    std::vector<TileAlong> tiles; ///< no ray passes one before those in front of it
    /// Rays cross a line between tiles in both directions, so no order is that of all rays.
    glm::bvec2 turns{false};
};

/// The tiles that the rays of a block may hit in their range. `turn`: columns between which the
/// nodes of a globe lie, and after which it begins anew; empty: it is none.
TilesAlong tiles_along(const TileNodes& nodes, const PictureRays& rays, const PixelBlock& block,
                       Interval turn = {});

/// Rays of a block that turn along these axes, in parts in which none does: along an axis, the rays
/// of a part pass one point, so each line is crossed in one direction. This moves no ray by more
/// than `tolerance(t)` samples, unless a part would have less than a 256th of the range.
std::vector<PictureRays> without_turns(const PictureRays& rays, const PixelBlock& block,
                                       glm::bvec2 axes,
                                       const std::function<glm::dvec2(double t)>& tolerance);

} // namespace reljef::cast
