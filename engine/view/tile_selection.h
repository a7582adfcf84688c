#pragma once

#include <memory>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/scene/graph/scene.h"
#include "engine/scene/tile_stream.h"

namespace reljef::view {

/// The tiles of a streamed terrain that a view shows.
struct TileSelection {
    struct Drawn {
        std::shared_ptr<const scene::StreamedTile> tile;
        double distance = 0.0; ///< from the eye to its bounds' nearest point, metres
        double error = 0.0;    ///< of its vertices as it is seen, an estimate, pixels
    };
    std::vector<Drawn> drawn;                 ///< from the eye outwards
    std::vector<Drawn> hidden;                ///< behind what is drawn, of what is there
    std::vector<terrain::TreeTile> requested; ///< and not there, the most urgent first
    /// In memory, and drawn, above a drawn one, or needed to find out what is hidden: to keep.
    std::vector<terrain::TreeTile> used;
    bool has_root = true; ///< false: nothing is in memory yet, and the root is wanted
    int outside_frustum = 0;
    int hidden_unread = 0; ///< tiles that are not there and need not be
};

/// The error on the picture that streamed tiles are chosen for where the technique names none,
/// pixels.
inline constexpr double default_tile_error = 1.0;
/// Largest distance of samples on screen, in error bounds, if the error allows it.
inline constexpr double samples_apart_in_errors = 4.0;

struct TileSelectionOptions {
    /// What nearer ground hides is wanted and chosen as finely as all else, to be `hidden`: for
    /// looking at what it takes from the picture to leave it out.
    bool keeps_hidden = false;
};

/// A tile gives way to those below it where its estimated error is seen larger than half of the
/// technique's error; where more would be drawn than memory holds, those of the largest errors do,
/// tiles that went being judged by what is remembered of them. Where one below is not there yet, it
/// is wanted, and the coarser one drawn meanwhile. What lies behind nearer ground
/// (terrain/horizon.h, of polygons on a plane) is not drawn where all that is drawn is as fine as
/// it should be, as nothing is hidden by what only stands in for finer tiles; and is not wanted,
/// but where that cannot be. How high the ground of tiles rises that are not read is an estimate
/// out of the coarser ones' range and error: what sticks out of these by more, as a tower of a few
/// samples may, is missed behind nearer ground as beyond the picture's border. The same view of the
/// same tiles gives the same choice. Nothing at all while the root is not there.
TileSelection select_tiles(const scene::TerrainNode& terrain, const scene::Camera& camera,
                           glm::ivec2 size, const glm::dmat4& world_from_local,
                           const TileSelectionOptions& options = {});

} // namespace reljef::view
