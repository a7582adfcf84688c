#pragma once

#include <glm/vec2.hpp>

#include "engine/geo/georeference.h"

namespace reljef::io {

/// Sample positions: first + step·(col, row) in the set's CRS.
struct TileGrid {
    glm::dvec2 first{0.0};
    glm::dvec2 step{1.0, -1.0};
    int cols = 0;
    int rows = 0;
    glm::dvec2 to_middle{0.0}; ///< see SampleGrid
};

/// Affine of a grid whose (0,0) is the centre of the first sample.
inline geo::PixelAffine affine_of(const TileGrid& grid) {
    return {grid.first.x, grid.step.x, 0.0, grid.first.y, 0.0, grid.step.y};
}

/// Affine of a grid's pixels around its samples; (0,0) is the outer corner.
inline geo::PixelAffine outer_affine_of(const TileGrid& grid) {
    const glm::dvec2 corner = grid.first - 0.5 * grid.step;
    return {corner.x, grid.step.x, 0.0, corner.y, 0.0, grid.step.y};
}

/// Logarithmic resolution class in steps of 1 %; smaller is finer.
double resolution(glm::dvec2 spacing);

/// Geodesic distance in metres between two (longitude, latitude) in degrees.
double metres_between(glm::dvec2 a, glm::dvec2 b);

} // namespace reljef::io
