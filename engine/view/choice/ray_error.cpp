#include "engine/view/choice/ray_error.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/terrain/mesh/tile_layout.h"

// The shader computes a hit as start + part * span, all in floats. A ray has the direction of
// its pixel, computed in a few steps. It starts at the eye, whose place is rounded to 2^-24 of a
// cell and of the heights: the origin of the search is the sample next to the eye. From outside
// of the box around the terrain it starts where it enters, which is computed from where it
// leaves: both are off by the rounding of the box's diagonal. The hit's height on the surface
// differs from that on the ray by the rounding of the heights, and of the hit's place along the
// ray, times the steepness of the ground. The place is rounded to 2^-24 of its distance from the
// start, and from the origin: from outside of the box, the diagonal. What is off by m metres at
// a distance d is seen under an angle of m / d, which is at most focal / cos^2 of the corner's
// angle times as many pixels.

namespace reljef::view {
namespace {

constexpr double operations = 16.0;      // that round, one after the other
constexpr double operations_along = 8.0; // of these for the place along the ray
constexpr double unit = 0x1p-24;

} // namespace

double steepest(const scene::TerrainSurface& surface) {
    const Grid<float>& heights = surface.heightfield().heights;
    const glm::dvec2 spacing = surface.placement().spacing();
    double along_row = 0.0; // metres between neighbours
    double along_col = 0.0;
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            const double here = heights(col, row);
            along_row = std::max(along_row, std::abs(here - heights.clamped(col + 1, row)));
            along_col = std::max(along_col, std::abs(here - heights.clamped(col, row + 1)));
        }
    }
    return surface.placement().exaggeration() *
           glm::length(glm::dvec2(along_row, along_col) / spacing);
}

RayError::RayError(const scene::Camera& camera, glm::ivec2 size,
                   const scene::TerrainSurface& surface, double steepness, glm::dvec3 offset)
    : surface_(surface), eye_(camera.eye - offset) {
    const double half_height = std::tan(0.5 * glm::radians(camera.vertical_fov));
    const double focal = 0.5 * size.y / half_height;
    const double to_corner =
        half_height * glm::length(glm::dvec2(scene::whole_picture(camera, size))) / size.y;
    rounding_ = operations * unit * focal * (1.0 + to_corner * to_corner);
    const Box& bounds = surface.bounds();
    const double below_eye = std::abs(eye_.z - bounds.low.z);
    const glm::dvec2 spacing = surface.placement().spacing();
    const bool is_outside = glm::clamp(eye_, bounds.low, bounds.high) != eye_;
    steepness_ = steepness * operations_along / operations * (is_outside ? 2.0 : 1.0);
    lengths_ = (1.0 + steepness_) * 2.0 * std::max(spacing.x, spacing.y) + bounds.size().z +
               below_eye + (is_outside ? 2.0 * glm::length(bounds.size()) : 0.0);
}

double RayError::at(double distance) const {
    return rounding_ * (1.0 + steepness_ + lengths_ / distance);
}

bool RayError::keeps(double error) const {
    const double left = error / rounding_ - 1.0 - steepness_;
    return left > 0.0 && !is_nearer(lengths_ / left, surface_.pyramid().last_level(), {0, 0});
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
