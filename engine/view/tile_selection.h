#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/scene/graph/scene.h"
#include "engine/scene/streaming/tile_stream.h"

namespace reljef::view {

/// The tiles of a streamed terrain in a view.
struct TileSelection {
    struct Drawn {
        std::shared_ptr<const scene::TerrainTile> tile;
        double distance = 0.0; ///< from the eye to the nearest point of its bounds, metres
        /// How far its vertices are off at most if it is proven, otherwise an estimate; pixels.
        double error = 0.0;
        /// The same with the parts that nearer ground hides, if its triangles are off by no more
        /// than the error bound.
        double error_with_hidden = 0.0;
    };
    std::vector<Drawn> drawn;                 ///< from the eye outwards
    std::vector<Drawn> hidden;                ///< loaded tiles behind the drawn ones
    std::vector<terrain::TreeTile> requested; ///< not loaded, the most urgent first
    /// Loaded tiles to keep: drawn, above a drawn one, or needed to find hidden ones.
    std::vector<terrain::TreeTile> used;
    bool has_root = true; ///< false: no tile is loaded, the root is requested
    int outside_frustum = 0;
    int hidden_unread = 0; ///< hidden tiles that are not loaded
};

/// Whether the technique searches the cones of the terrain's tiles.
bool needs_cones(const scene::TerrainNode& terrain);
/// Whether a loaded tile has what the technique needs.
bool is_ready(const scene::TerrainNode& terrain, const scene::TerrainTile& tile);

struct TileSelectionOptions {
    /// Requests and refines hidden tiles like all others and returns them as `hidden`: to measure
    /// the effect of occlusion on the picture.
    bool keeps_hidden = false;
};

/// Refines each tile whose error on the picture exceeds half of the technique's error bound. If
/// memory does not hold all drawn tiles, only those with the largest errors are refined; tiles that
/// are not loaded count with their summaries. Requests missing children and draws their parent
/// meanwhile.
///
/// Tiles behind nearer ground (terrain/field; with polygons only) are neither drawn nor
/// requested, but only while no tile is missing: tiles that stand in for finer ones hide nothing.
/// The heights of unread tiles without a proof are estimated from the range and error of coarser
/// ones, so a tower of a few samples may be missed behind nearer ground or at the picture's border.
///
/// The same view of the same tiles gives the same selection. Selects nothing before the root is
/// loaded.
TileSelection select_tiles(const scene::TerrainNode& terrain, const scene::Camera& camera,
                           glm::ivec2 size, const glm::dmat4& world_from_local,
                           const TileSelectionOptions& options = {});

/// How far rays over tiles of a stream are off because of these, at most.
struct RayTilesError {
    std::optional<double> proven; ///< of proven tiles, pixels; empty: none is shown
    int unproven = 0;             ///< shown tiles whose errors are estimates
};

/// Of a view's drawn tiles, and of what shows of the coarser ones in `tiles` (SurfaceSearch::tiles)
/// beside them.
RayTilesError error_of_ray_tiles(const scene::TerrainNode& terrain, const scene::Camera& camera,
                                 glm::ivec2 size, const glm::dmat4& world_from_local,
                                 std::span<const TileSelection::Drawn> drawn,
                                 std::span<const std::shared_ptr<const scene::TerrainTile>> tiles);

/// tiles_for_bound() counts no more: they would take gigabytes.
inline constexpr std::size_t max_tiles_counted = 100'000;

/// Tiles that keep the error bound in a view, at most max_tiles_counted. Counts proven and known
/// ones that the tiles drawn now do not hide, and an eighth more: finer ground may hide less.
std::size_t tiles_for_bound(const scene::TerrainNode& terrain, const scene::Camera& camera,
                            glm::ivec2 size, const glm::dmat4& world_from_local);

} // namespace reljef::view
