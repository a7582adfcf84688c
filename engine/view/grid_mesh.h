#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/placement.h"
#include "engine/terrain/mesh/bisection_mesh.h"
#include "engine/terrain/mesh/tile_layout.h"

namespace reljef::view {

/// One vertex of a tile, as in terrain.vert.
struct GridVertex {
    glm::vec3 position; ///< local metres, the same bits in each tile that shares the vertex
    float height;       ///< true metres
    glm::vec2 place;    ///< samples of the terrain from the tile's first
    glm::vec3 rest;     ///< local metres: the rounding error of the position
};
static_assert(sizeof(GridVertex) == 36);

GridVertex grid_vertex(glm::dvec3 local, double height, glm::dvec2 place);

/// A tile as a regular grid of vertices, row after row.
struct GridMesh {
    int cols = 0;                     ///< quads
    int rows = 0;                     ///< quads
    std::vector<GridVertex> vertices; ///< (cols + 1) × (rows + 1)
};

/// The tile with a vertex at every sample.
GridMesh full_mesh(const terrain::Heightfield& heightfield, const terrain::Placement& placement,
                   const terrain::TileCells& tile);

/// Finds the vertices of parts of a tile. Looks up vertices at known samples, because placing them
/// on an ellipsoid is slow. Its arguments outlive it.
class VertexPlacer {
public:
    VertexPlacer(const terrain::Heightfield& heightfield, const terrain::Placement& placement,
                 const terrain::TileCells& tile)
        : heightfield_(heightfield), placement_(placement), tile_(tile) {}

    /// Remembers the vertices at samples. Precondition: `vertices` are place(part) of the same
    /// tile.
    void know(const terrain::Triangulation& part, std::span<const GridVertex> vertices);

    [[nodiscard]] std::vector<GridVertex> place(const terrain::Triangulation& part) const;

private:
    [[nodiscard]] const GridVertex* known(terrain::Steps steps) const;
    [[nodiscard]] GridVertex placed(terrain::Steps steps, const terrain::VertexMove& move) const;

    const terrain::Heightfield& heightfield_;
    const terrain::Placement& placement_;
    const terrain::TileCells& tile_;
    Grid<const GridVertex*> at_samples_; // empty before know()
};

/// Quads along the sides of a tile of the flat reference surface.
glm::ivec2 flat_quads(const terrain::Placement& placement, glm::ivec2 cells);

/// The tile of the flat reference surface at `height` metres.
GridMesh flat_mesh(const terrain::Placement& placement, const terrain::TileCells& tile,
                   double height);

} // namespace reljef::view
