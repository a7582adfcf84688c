#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/placement.h"

namespace reljef::test {

/// Heights by formula: `height(col, row)`, metres.
template <class Height> Grid<float> made_heights(int cols, int rows, const Height& height) {
    Grid<float> heights(cols, rows);
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            heights(col, row) = static_cast<float>(height(col, row));
        }
    }
    return heights;
}

/// Each sample by chance, evenly in [low, high).
inline Grid<float> random_heights(int cols, int rows, float low, float high, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> height(low, high);
    return made_heights(cols, rows, [&](int, int) { return height(random); });
}

/// Without a place on the Earth.
inline terrain::Heightfield plane_heightfield(Grid<float> heights,
                                              glm::dvec2 spacing = {1.0, 1.0}) {
    terrain::Heightfield heightfield;
    heightfield.range = terrain::height_range(heights, {});
    heightfield.heights = std::move(heights);
    heightfield.spacing = spacing;
    return heightfield;
}

/// A geographic raster: (0,0) at a latitude and longitude, `step` degrees from sample to sample;
/// its columns run `turn` degrees north of east. Rows are `row_steps` steps apart.
inline terrain::Heightfield geographic_heightfield(Grid<float> heights, double latitude,
                                                   double longitude, double step, double turn = 0.0,
                                                   double row_steps = 1.0) {
    constexpr int controls = 9;
    const glm::dvec2 control_step{std::max(heights.cols() - 1, 1) / (controls - 1.0),
                                  std::max(heights.rows() - 1, 1) / (controls - 1.0)};
    const double sine = std::sin(glm::radians(turn));
    const double cosine = std::cos(glm::radians(turn));
    Grid<glm::dvec2> control(controls, controls);
    for (int j = 0; j < controls; ++j) {
        for (int i = 0; i < controls; ++i) {
            const double col = i * control_step.x * step;
            const double row = j * control_step.y * row_steps * step;
            control(i, j) = {latitude + col * sine - row * cosine,
                             longitude + col * cosine + row * sine};
        }
    }
    const double middle = latitude - 0.5 * (heights.rows() - 1) * row_steps * step;
    terrain::Heightfield heightfield = plane_heightfield(
        std::move(heights), geo::metres_per_degree(middle) * step * glm::dvec2(1.0, row_steps));
    heightfield.georeference.emplace();
    heightfield.georeference->geodetic = geo::GeodeticMap(control, glm::dvec2(0.0), control_step);
    return heightfield;
}

/// A globe of `cells` rows of square cells besides those at its poles, closed as a file is: its
/// last column is its first, and the outermost rows of its source are `north` and `south` of a row
/// from the poles. Precondition: their sum is a multiple of 0.5.
inline terrain::Heightfield closed_globe(int cells, double north, double south, unsigned seed) {
    const double step = 180.0 / (cells + north + south);
    const int rows = cells + 1;
    const int cols = static_cast<int>(std::lround(360.0 / step));
    terrain::Heightfield globe = geographic_heightfield(
        random_heights(cols, rows, -9000.0F, 9000.0F, seed), 90.0 - north * step, -180.0, step);
    const geo::GlobalWrap wrap{.around = true, .east = true, .north = north, .south = south};
    globe.georeference->geodetic = globe.georeference->geodetic.closed(wrap, cols, rows);
    const Grid<float> source = std::move(globe.heights);
    globe.heights = made_heights(cols + 1, rows + wrap.rows(), [&](int col, int row) {
        const int inner = std::clamp(row - wrap.north_rows(), 0, rows - 1);
        const bool is_pole = inner != row - wrap.north_rows();
        return is_pole ? 100.0F : source(col % cols, inner);
    });
    globe.range = terrain::height_range(globe.heights, {});
    return globe;
}

/// Along both sides.
inline glm::ivec2 cells_of(const terrain::Heightfield& heightfield) {
    return {heightfield.heights.cols() - 1, heightfield.heights.rows() - 1};
}

/// On the ellipsoid where it has a place there, else on a plane.
inline terrain::Placement placed(const terrain::Heightfield& heightfield,
                                 double exaggeration = 1.0) {
    const auto kind = heightfield.georeference ? terrain::PlacementKind::ellipsoid
                                               : terrain::PlacementKind::plane;
    return terrain::Placement::create(heightfield, kind, exaggeration).value();
}

} // namespace reljef::test
