#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/terrain/mesh/bisection_mesh.h"
#include "engine/terrain/tree/stitching.h"
#include "engine/view/draw_list.h"
#include "engine/view/grid_mesh.h"

namespace reljef::view {

/// A tile's triangles, in parts of 16-bit indices, and the vertices of each part.
struct CutMesh {
    std::vector<terrain::Triangulation> parts;
    std::vector<std::vector<GridVertex>> vertices; ///< empty if the parts are those of `last`
};

/// The triangles of a tile of a terrain in memory. Such tiles meet vertex on vertex, because the
/// coarseness alone decides each split. `bisection` is that of the terrain; null for levels of
/// patches. `last`: the tile's triangles before, whose vertices are used again.
CutMesh cut_alone(const terrain::Bisection* bisection, const Coarseness& coarseness,
                  const scene::TerrainSurface& surface, const terrain::Tile& tile,
                  const CutMesh& last);

struct TileShape;

/// The state from which the triangles of a loaded tile were found.
struct TileCut {
    std::shared_ptr<const TileShape> shape; ///< null until triangles are needed
    std::optional<terrain::ErrorView> view; ///< empty until the triangles are drawn
    Grid<std::uint8_t> splits;              ///< required by the tiles around it
};

/// A loaded tile and its lasting state.
struct TileToCut {
    const TileDraw* draw = nullptr;
    TileCut* cut = nullptr;
    std::optional<terrain::Triangulation> triangles = {}; ///< empty if unchanged
    terrain::ErrorView view = {};                         ///< of these triangles
};

/// Finds the triangles of all loaded tiles of a cover: as few as the view allows if the tiles still
/// meet vertex on vertex. The triangles get at least half of the error bound, and what the
/// estimated errors of the vertices leave of it, including those of the tiles around (the two
/// errors seldom add up). Does nothing if neither the cover nor a tile's view is new. After drawing
/// new triangles the caller sets TileCut::view. Precondition: one tile for each of the cover, or
/// none.
void cut_together(const DrawList& list, const terrain::DrawnTiles& cover, bool is_new_cover,
                  std::span<TileToCut> tiles);

} // namespace reljef::view
