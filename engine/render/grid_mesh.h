#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/terrain/bisection_mesh.h"
#include "engine/terrain/heightfield.h"
#include "engine/terrain/placement.h"
#include "engine/terrain/tile_layout.h"

namespace reljef::render {

/// One vertex of a tile, as in terrain.vert.
struct GridVertex {
    glm::vec3 position; ///< local metres, the same for each tile that has the vertex
    float height;       ///< true metres
    glm::vec2 place;    ///< samples from the tile's first
    glm::vec3 rest;     ///< local metres: what the rounding to floats left of the position
};
static_assert(sizeof(GridVertex) == 36);

/// A vertex at a place in local metres; `place`: samples from the tile's first.
GridVertex grid_vertex(glm::dvec3 local, double height, glm::dvec2 place);

/// A tile as a regular grid of vertices, row after row.
struct GridMesh {
    int cols = 0;                     ///< quads
    int rows = 0;                     ///< quads
    std::vector<GridVertex> vertices; ///< (cols + 1) × (rows + 1)
};

/// Every sample of the tile a vertex.
GridMesh full_mesh(const terrain::Heightfield& heightfield, const terrain::Placement& placement,
                   const terrain::Tile& tile);

/// The vertices of a part of a tile.
std::vector<GridVertex> placed_vertices(const terrain::Heightfield& heightfield,
                                        const terrain::Placement& placement,
                                        const terrain::Tile& tile,
                                        const terrain::Triangulation& part);

/// Quads along a side of a tile of the flat reference surface: one on a plane, a few on an
/// ellipsoid.
int flat_quads(terrain::PlacementKind kind);

/// The tile's part of the flat reference surface at `height` metres, of flat_quads() quads a side.
GridMesh flat_mesh(const terrain::Placement& placement, const terrain::Tile& tile, double height);

} // namespace reljef::render
