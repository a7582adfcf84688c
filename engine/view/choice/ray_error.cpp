#include "engine/view/choice/ray_error.h"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/terrain/mesh/tile_layout.h"

namespace reljef::view {
RayError::RayError(const scene::Camera& camera, glm::ivec2 size,
                   const scene::TerrainSurface& surface, double steepness, glm::dvec3 offset)
    : surface_(surface), eye_(camera.eye - offset),
      rounding_(camera, size, surface.bounds(), eye_, RayFloats::opengl) {
    const glm::dvec2 spacing = surface.placement().spacing();
    part_ = {0.0, {steepness, 0.0}, std::max(spacing.x, spacing.y)};
}

double RayError::at(double distance) const {
    return rounding_.at({distance, part_.slopes, part_.cell});
}

bool RayError::keeps(double error) const {
    const auto distance = rounding_.distance_for(error, part_);
    return distance && !is_nearer(*distance, surface_.pyramid().last_level(), {0, 0});
}

bool RayError::is_nearer(double distance, int level, glm::ivec2 block) const {
    const Grid<float>& heights = surface_.heightfield().heights;
    const glm::ivec2 cells(heights.cols() - 1, heights.rows() - 1);
    const glm::ivec2 first = block << level;
    if (first.x >= cells.x || first.y >= cells.y) {
        return false;
    }
    const glm::ivec2 last = glm::min((block + 1) << level, cells);
    const terrain::MinMax range = surface_.pyramid().bounds(first, last - 1);
    const Box box = terrain::placed_bounds(surface_.placement(), glm::dvec2(first),
                                           glm::dvec2(last), {range.low, range.high});
    if (glm::distance(eye_, glm::clamp(eye_, box.low, box.high)) >= distance) {
        return false;
    }
    if (level == 0) {
        return true;
    }
    for (const glm::ivec2 child : {glm::ivec2(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
        if (is_nearer(distance, level - 1, 2 * block + child)) {
            return true;
        }
    }
    return false;
}

} // namespace reljef::view
