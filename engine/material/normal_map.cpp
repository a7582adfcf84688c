#include "engine/material/normal_map.h"

#include <glm/geometric.hpp>

#include "engine/core/parallel_for.h"

namespace reljef::material {
namespace {

// Rise per sample to the east and to the south: the central difference, or for sobel its weighted
// mean over three lines.
glm::dvec2 rise_by(GridView<const float> heights, int col, int row, const NormalOptions& options) {
    const auto at = [&](int east, int south) -> double {
        return heights(index_beyond(col + east, heights.cols(), options.border),
                       index_beyond(row + south, heights.rows(), options.border));
    };
    const double beside = options.filter == NormalFilter::sobel ? 0.25 : 0.0;
    glm::dvec2 rise(0.0);
    for (int line = -1; line <= 1; ++line) {
        const double weight = 0.5 * (line == 0 ? 1.0 - 2.0 * beside : beside);
        rise.x += weight * (at(1, line) - at(-1, line));
        rise.y += weight * (at(line, 1) - at(line, -1));
    }
    return rise;
}

// Rows run south, y runs north.
glm::dvec3 normal_of(glm::dvec2 rise, glm::dvec2 spacing) {
    return glm::normalize(glm::dvec3(-rise.x / spacing.x, rise.y / spacing.y, 1.0));
}

} // namespace

Grid<glm::vec3> normals_from_heights(GridView<const float> heights, const NormalOptions& options) {
    check(!heights.empty(), "normals of no heights");
    Grid<glm::vec3> normals(heights.cols(), heights.rows());
    parallel_for(heights.rows(), [&](int row) {
        for (int col = 0; col < heights.cols(); ++col) {
            normals(col, row) =
                glm::vec3(normal_of(rise_by(heights, col, row, options), options.spacing));
        }
    });
    return normals;
}

} // namespace reljef::material
