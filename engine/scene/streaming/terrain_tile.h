#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/color.h"
#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/material/cone_map.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/min_max_pyramid.h"
#include "engine/terrain/field/placement.h"
#include "engine/terrain/tree/tile_error.h"
#include "engine/terrain/tree/tile_tree.h"

namespace reljef::scene {

/// Cells along a side of the blocks with a height range.
inline constexpr int cells_per_block = 8;

struct TileSummary {
    terrain::TreeTile id;       ///< if it borrows: of level 0, in tiles of terrain::tile_cells
    Box bounds;                 ///< local metres
    terrain::HeightRange range; ///< true metres
    /// Scene metres. If proven, no sample, and nothing that fills voids, is farther above or below
    /// the tile's surface, and range and bounds contain all of both. Otherwise an
    /// estimate against the next finer level: the largest distance of every second vertex from the
    /// middle between its neighbours.
    double error = 0.0;
    /// Metres between texels if there are finer ones, otherwise 0. Also 0 before a proven tile is
    /// read: only its images tell.
    double coarse_texel = 0.0;
    bool is_proven = false;
    bool is_finest = false; ///< finer tiles would show nothing more, because files cannot be read
    terrain::BlockShares block_shares = terrain::whole_shares; ///< of `error`, if proven
};

/// A tile of a terrain's quadtree, ready to be drawn.
struct TerrainTile : TileSummary {
    glm::ivec2 first{0}; ///< sample of its heightfield
    glm::ivec2 cells{0};
    /// The samples are those of the terrain's surface, as are their places and colours: the members
    /// below are empty.
    bool borrows = false;
    terrain::Heightfield heightfield; ///< of the vertices
    std::optional<terrain::Placement> placement;
    Grid<glm::vec3> normals; ///< unit, local frame
    glm::vec3 up{0.0F, 0.0F, 1.0F};
    Image albedo;                 ///< edge to edge, at least one texel per vertex, sRGB
    Grid<terrain::MinMax> blocks; ///< of cells_per_block cells a side; smaller at the far sides
    bool of_overview = false;     ///< the heights are TileBuilder::overview_heights
    /// Of `error`, if it is proven; absent: block_shares tell as much as is known.
    std::optional<terrain::PartShares> parts;
    /// Over its heights, from 0 to 1; null until a view needs them.
    std::shared_ptr<const material::ConeMaps> cones;

    /// A vertex in local metres.
    [[nodiscard]] glm::dvec3 place(glm::ivec2 vertex) const {
        return placement->world_from_sample({vertex, heightfield.heights(vertex.x, vertex.y)});
    }
    /// The place of an albedo texel, in vertices.
    [[nodiscard]] glm::dvec2 vertex_of(glm::ivec2 texel) const;
    [[nodiscard]] glm::vec3 normal_at(glm::dvec2 vertex) const;

    /// Memory of the drawn tile, bytes.
    [[nodiscard]] std::size_t bytes() const;
};

// Memory of a drawn tile of full size, on the CPU and on the GPU, bytes.
inline constexpr std::size_t bytes_of_bisection = 40; // per vertex
inline constexpr std::size_t bytes_per_vertex =
    sizeof(glm::vec3) + sizeof(float) + sizeof(Rgba8) + 36 + 6 + bytes_of_bisection;
inline constexpr std::size_t bytes_per_tile =
    bytes_per_vertex * (terrain::tree_tile_cells + 1) * (terrain::tree_tile_cells + 1);
/// Memory of a triangle with an error bound and its vertices, on the CPU and on the GPU, bytes:
/// half as many vertices as triangles, each with its place and twice with its attributes, and
/// indices.
inline constexpr std::size_t bytes_per_triangle = (16 + 2 * 36) / 2 + 2 * 6;
/// For texels beyond one per vertex; on the GPU with mipmaps.
inline constexpr double bytes_per_texel = 4.0 + 16.0 / 3.0;

} // namespace reljef::scene
