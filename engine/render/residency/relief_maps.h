#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/material/cone_map.h"
#include "engine/scene/graph/terrain_node.h"
#include "engine/scene/streaming/tile_builder.h"
#include "engine/view/rays/ray_course.h"

namespace reljef::render {

/// The search space of a surface: x column, y row, z height from 0 (lowest) to 1 (highest).
struct ReliefSpace {
    // Over a plane, an affine image of the local frame.
    glm::dmat3 space_from_local{1.0}; ///< directions
    glm::dvec3 space_of_origin{0.0};  ///< the local origin in the space
    // On the ellipsoid, of the surface's samples (column, row, height in true metres).
    glm::dvec3 samples_per_unit{1.0};
    glm::dvec3 sample_of_origin{0.0};
    glm::vec3 metres_per_unit{1.0F}; ///< along each axis, exaggeration included
    double lowest = 0.0;             ///< metres
    double range = 1.0;              ///< metres, > 0
    Box box;                         ///< the samples and heights with a margin, in the space
    Box local_box;                   ///< the same in local metres, over a plane
};
ReliefSpace relief_space(const scene::TerrainSurface& surface);

/// Sets the axes and the boxes. `local`: local metres of a place in the space, affine. The columns
/// and rows of the box are those of the samples.
void place_space(ReliefSpace& space, const std::function<glm::dvec3(glm::dvec3)>& local);

/// The cell that a search space begins at, near the eye; `eye` and `last` count cells. At the last
/// row of a course over degrees, which may be a pole, it is the end of the last cell.
glm::dvec2 origin_near(glm::dvec2 eye, glm::dvec2 last,
                       const std::optional<view::RayCourse>& course);

/// The same space with its origin at a column and row.
ReliefSpace moved_to(const ReliefSpace& space, glm::dvec2 origin);

/// The same on the ellipsoid, from the samples of the space.
void place_curved_space(ReliefSpace& space, const terrain::Placement& placement);

/// The search space over the tiles of a stream: x and y count the cells of the finest tiles, from
/// an origin near the eye, where floats are precise.
struct StreamedSpace {
    ReliefSpace space;
    int level = 0;                 ///< of the finest tiles
    glm::ivec2 origin{0};          ///< cell at (0, 0)
    glm::ivec2 last_cell{0};       ///< of the terrain
    glm::dvec2 origin_sample{0.0}; ///< of the terrain
    double samples_a_cell = 1.0;
};
/// `eye`: local metres. `course`: of the view rays on the ellipsoid; empty over a plane.
StreamedSpace streamed_space(const scene::TileBuilder& builder,
                             std::span<const std::shared_ptr<const scene::TerrainTile>> tiles,
                             glm::dvec3 eye, const std::optional<view::RayCourse>& course);

/// A mip chain of maximum heights, in [0,1] of the range: level n covers 2^n × 2^n cells. The sides
/// of level 0 are powers of two; texels beyond the cells are 0.
std::vector<Grid<float>> max_mipmap(GridView<const float> relief_heights);

/// The plain (x) and the relaxed (y) cone of each cell; an extra column and row repeat the last
/// cells.
Grid<glm::vec2> cone_texels(const material::ConeMaps& cones);

} // namespace reljef::render
