#pragma once

#include <vector>

#include "engine/terrain/mesh/bisection_mesh.h"
#include "engine/view/draw_list.h"
#include "engine/view/grid_mesh.h"

namespace reljef::view {

/// The samples that a tile shows, and their places.
struct TileSurface {
    const terrain::Heightfield& heightfield;
    const terrain::Placement& placement;
    terrain::TileCells samples;
};
TileSurface surface_of(const TileDraw& draw);

/// A tile's triangles, in parts of 16-bit indices, and the vertices of each part.
struct CutMesh {
    std::vector<terrain::Triangulation> parts;
    std::vector<std::vector<GridVertex>> vertices;
    /// Bound of what is drawn with all errors, pixels; 0 without an error bound.
    double error = 0.0;
};

/// How much coarser tiles are than their errors ask for, so that all have few enough triangles.
struct Coarsening {
    double min_error = 0.0; ///< of triangles, pixels
    int min_size = 0;       ///< of squares that are split, terrain::Steps

    friend bool operator==(const Coarsening&, const Coarsening&) = default;
};

/// Whether coarser triangles would not be fewer.
bool is_coarsest(const Coarsening& coarsening);
/// The next coarsening in a view.
Coarsening coarser(const terrain::ErrorView& view, const Coarsening& coarsening);

/// How to draw a tile with fewer triangles.
struct CutOptions {
    const terrain::Bisection* bisection = nullptr; ///< of its heightfield; null for patches
    double error = 0.0;                            ///< of the tile, pixels
    double triangle_error = 0.0;                   ///< left for its triangles, pixels
    Coarsening coarsening;
    terrain::TriangleBudget* budget = nullptr; ///< of the tiles that are cut; null: none
};

/// The bound of a tile's triangles.
terrain::ErrorView triangle_view(const terrain::ErrorView& bound, const CutOptions& options);

/// The triangles of a tile. `last`: the tile's triangles before, whose vertices are used again.
/// Without parts if the triangles are still those of `last`.
CutMesh cut_tile(const Coarseness& coarseness, const TileSurface& surface,
                 const CutOptions& options, const CutMesh& last);

} // namespace reljef::view
