#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/geo/georeference.h"

namespace reljef::terrain {

/// Lowest and highest height, metres.
struct HeightRange {
    double low = 0.0;
    double high = 0.0;
};

/// Between samples, metres: from less than any scanner's pixel to a planet in a hundred samples.
inline constexpr double min_spacing = 1e-6;
inline constexpr double max_spacing = 1e6;

/// A grid of heights and where it lies. `col` grows east, `row` grows south; (0,0) is the centre of
/// the north-west sample; between samples the surface is the bilinear interpolation of the four
/// around (the surface a bilinear texture fetch sees).
struct Heightfield {
    Grid<float> heights;          ///< metres above the DEM's own zero, all finite, voids filled
    Grid<std::uint8_t> void_mask; ///< 1 where the source has no height; empty when it has none
    std::size_t void_count = 0;   ///< samples that are 1 in void_mask
    HeightRange range;            ///< over the samples that are no voids
    glm::dvec2 spacing{1.0,
                       1.0}; ///< metres between samples, > 0 (degrees: at the centre's latitude)
    std::optional<geo::Georeference> georeference; ///< absent where the source names no place
};

/// A heightfield and what lies on it.
struct Terrain {
    std::string name; ///< file or built-in name, for messages and titles
    Heightfield heightfield;
    Image color; ///< covers the heightfield edge sample to edge sample; may be empty
    std::vector<std::string> notes; ///< for the user: undeclared voids, a reduced read
    std::vector<std::string> errors =
        {}; ///< files that were to be read and failed, a sentence each; the rest is there
};

/// Lowest and highest of the samples that are no voids; {0,0} when there is none.
HeightRange height_range(const Grid<float>& heights, const Grid<std::uint8_t>& void_mask);

/// Heights from 0, the lowest of all samples, to 1, the highest; all 0 where they are level.
Grid<float> unit_heights(GridView<const float> heights);

/// Bilinear height at (col, row), metres; both are clamped to the grid. Precondition: not empty.
double bilinear_height(GridView<const float> heights, glm::dvec2 sample);

/// Whether any of the samples that the bilinear height at (col, row) rests on is a void.
bool touches_void(const Heightfield& heightfield, glm::dvec2 sample);

/// Gives every void the average of what surrounds it, found level by level in a pyramid of averages
/// (pull-push, Gortler et al. 1996): smooth, and without spikes. Precondition: `void_mask` is empty
/// or of the heights' size. Heights that are no voids are untouched; all void gives 0 everywhere.
void fill_voids(Grid<float>& heights, const Grid<std::uint8_t>& void_mask);

} // namespace reljef::terrain
