#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/cast/beam.h"
#include "engine/cast/curved_rays.h"
#include "engine/cast/packet/block_kernel.h"
#include "engine/cast/picture_rays.h"
#include "engine/cast/ray_tile.h"
#include "engine/cast/sun_course.h"
#include "engine/cast/tile_nodes.h"
#include "engine/core/parallel_for.h"
#include "engine/geo/georeference.h"

namespace reljef::cast {

/// A tile to cast rays at.
struct PlacedTile {
    const RayTile* tile = nullptr;
    PictureRays rays; ///< in samples of the tile; on the ellipsoid only their range and anchor
    TilePaint paint = {};
    TilePaint sun = {};                             ///< BlockJob::sun, if there are `sun_tiles`
    std::optional<TilePaint> albedo = {};           ///< BlockJob::albedo
    TilePaint normals = {};                         ///< BlockJob::normals, if there is an albedo
    std::optional<TilePaint> sun_share = {};        ///< BlockJob::sun_share
    std::vector<SunTile> sun_tiles = {};            ///< those that may hide the sun from it
    std::span<const std::int32_t> certain_sun = {}; ///< BlockJob::certain_sun; may be empty
    int certain_stride = 0;
    unsigned walls = 0; ///< BlockJob::walls
    /// Sample of the terrain with even rows (PlacedTiles::rows) = first + step · sample of the
    /// tile.
    glm::dvec2 first{0.0};
    glm::dvec2 step{1.0};
    PixelBlock seen; ///< no other pixel shows it
    /// On the ellipsoid: sample of the tile = scale · sample of the curved rays + by.
    glm::dvec2 scale{1.0};
    glm::dvec2 by{0.0};
};

/// What rays skip; all of it by default. Nothing of it changes a hit: to measure what each saves.
struct RaySkips {
    bool free_space = true; ///< before the first place that the beam of a block may hit
    bool beams = true;      ///< the same for the beams of 8 by 2 pixels
    bool blocks = true;     ///< blocks of the maximum mipmap that are below the ray
    bool cells = true;      ///< cells that are below the ray
    bool certain = true;    ///< sun rays from where it is certain whether the sun is seen
};

/// The tiles of a picture, front to back on a plane. All rays have the same anchor.
struct PlacedTiles {
    std::vector<PlacedTile> tiles;
    bool has_walls = false;
    /// The lowest height of a streamed terrain's tiles, true metres: no wall is below.
    double wall_floor = -std::numeric_limits<double>::infinity();
    /// Not null: the tiles are on the ellipsoid.
    std::shared_ptr<const CurvedRays> curve;
    TileNodes nodes;       ///< on the ellipsoid, of several tiles or a globe
    Interval turn;         ///< of a globe: columns of the curved rays after which it begins anew
    geo::WrappedRows rows; ///< of the terrain
    /// Of rays to the sun on the ellipsoid; null: these are straight, or there are none.
    std::shared_ptr<const SunCourse> sun_course;
};

/// The tile as one that may hide the sun from its own hits. `to_sun`: in its samples; it rises.
SunTile sun_tile(const RayTile& tile, glm::dvec3 to_sun);

/// The tiles that rays of a block may hit. They point to the paints of `placed`. BlockHits::job
/// counts them; `indices`: their tiles.
std::vector<BlockJob> block_jobs(const PlacedTiles& placed, const PixelBlock& block,
                                 const RaySkips& skips,
                                 std::vector<std::size_t>* indices = nullptr);

/// The blocks of a picture.
int block_count(glm::ivec2 size);

/// Calls `body` for all blocks of a picture and their indices, from several threads. False if it
/// was stopped early.
bool for_each_block(glm::ivec2 size, const ParallelOptions& parallel,
                    const std::function<void(const PixelBlock& block, std::size_t index)>& body);

} // namespace reljef::cast
