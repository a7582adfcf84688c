#pragma once

#include <vector>

#include "engine/terrain/mesh/bisection_mesh.h"
#include "engine/terrain/mesh/skirt.h"
#include "engine/view/draw_list.h"
#include "engine/view/grid_mesh.h"

namespace reljef::view {

/// The samples that a tile shows, and their places.
struct TileSurface {
    const terrain::Heightfield& heightfield;
    const terrain::Placement& placement;
    terrain::Tile samples;
};
TileSurface surface_of(const TileDraw& draw);

/// A tile's triangles, in parts of 16-bit indices, and the vertices of each part.
struct CutMesh {
    std::vector<terrain::Triangulation> parts; ///< the skirt's last
    std::vector<std::vector<GridVertex>> vertices;
    /// Bound of what is drawn with all errors, pixels; 0 without an error bound.
    double error = 0.0;
};

/// The walls that close the gaps between a tile and its neighbours; a tile of a terrain in memory
/// needs none. That of whole tiles is rounded up, so that it seldom changes.
terrain::Skirt skirt_of(const DrawList& list, const TileDraw& draw);

/// How to draw a tile with fewer triangles.
struct CutOptions {
    const terrain::Bisection* bisection = nullptr; ///< of its heightfield; null for patches
    double error = 0.0;                            ///< of the tile, pixels
    double triangle_error = 0.0;                   ///< left for its triangles, pixels
    terrain::Skirt skirt;
};

/// The triangles of a tile and its skirt. `last`: the tile's triangles before, whose vertices are
/// used again. Without parts if the triangles are still those of `last`.
CutMesh cut_tile(const Coarseness& coarseness, const TileSurface& surface,
                 const CutOptions& options, const CutMesh& last);

/// The skirt of a tile with a vertex at every sample.
CutMesh whole_skirt(const TileSurface& surface, const terrain::Skirt& skirt);

} // namespace reljef::view
