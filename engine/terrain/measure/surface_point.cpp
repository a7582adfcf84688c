#include "engine/terrain/measure/surface_point.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::terrain {
namespace {

// Rise of the bilinear surface per column and per row, metres.
glm::dvec2 rise_per_sample(GridView<const float> heights, glm::dvec2 sample) {
    const int col = std::min(static_cast<int>(sample.x), heights.cols() - 2);
    const int row = std::min(static_cast<int>(sample.y), heights.rows() - 2);
    const double u = sample.x - col;
    const double v = sample.y - row;
    const double h00 = heights(col, row);
    const double h10 = heights(col + 1, row);
    const double h01 = heights(col, row + 1);
    const double h11 = heights(col + 1, row + 1);
    return {std::lerp(h10 - h00, h11 - h01, v), std::lerp(h01 - h00, h11 - h10, u)};
}

// East and north, metres, per column and per row, as rows of a matrix.
glm::dmat2 metres_per_sample(const Placement& placement, glm::dvec3 at) {
    const glm::dvec3 world = placement.world_from_sample(at);
    const glm::dvec3 north = placement.north(world);
    const glm::dvec3 east = glm::cross(north, placement.up(world));
    const auto way = [&](glm::dvec3 half) {
        const glm::dvec3 moved =
            placement.world_from_sample(at + half) - placement.world_from_sample(at - half);
        return glm::dvec2(glm::dot(moved, east), glm::dot(moved, north));
    };
    return glm::transpose(glm::dmat2(way({0.5, 0.0, 0.0}), way({0.0, 0.5, 0.0})));
}

} // namespace

std::optional<SurfacePoint> surface_point(const Heightfield& heightfield,
                                          const Placement& placement, glm::dvec2 sample) {
    const GridView<const float> heights = heightfield.heights.view();
    const bool is_inside = sample.x >= 0.0 && sample.y >= 0.0 && sample.x <= heights.cols() - 1 &&
                           sample.y <= heights.rows() - 1;
    if (!is_inside) {
        return std::nullopt;
    }
    SurfacePoint point;
    point.height = bilinear_height(heights, sample);
    point.is_void = uses_void(heightfield, sample);
    const glm::dvec2 gradient = glm::inverse(metres_per_sample(placement, {sample, point.height})) *
                                rise_per_sample(heights, sample);
    const double steepness = glm::length(gradient);
    point.slope = glm::degrees(std::atan(steepness));
    if (steepness > 0.0) {
        const double downhill = glm::degrees(std::atan2(-gradient.x, -gradient.y));
        point.aspect = std::fmod(downhill + 360.0, 360.0);
    }
    return point;
}

} // namespace reljef::terrain
