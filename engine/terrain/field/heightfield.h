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
#include "engine/terrain/field/facades.h"

namespace reljef::terrain {

/// Lowest and highest height, metres.
struct HeightRange {
    double low = 0.0;
    double high = 0.0;
};

/// Limits of the distance between samples, metres.
inline constexpr double min_spacing = 1e-6;
inline constexpr double max_spacing = 1e6;

/// A grid of heights. `col` grows east, `row` grows south; (0,0) is the centre of the north-west
/// sample. The surface is bilinear between samples.
struct Heightfield {
    Grid<float> heights;          ///< metres above the DEM's zero, all finite, voids filled
    Grid<std::uint8_t> void_mask; ///< 1 in voids; empty if there are none
    std::size_t void_count = 0;   ///< number of void samples
    HeightRange range;            ///< of the samples that are no voids
    glm::dvec2 spacing{1.0};      ///< metres between samples, > 0 (at the centre's latitude)
    /// Samples of the source along each side of one of these. Above 1 they are averages, or some of
    /// the samples, and no error of the surface is known.
    double reduction = 1.0;
    std::optional<geo::Georeference> georeference; ///< absent if the source has none
    /// From the middle of these samples to that of the source, in samples: not 0 where a reduction
    /// leaves out the last samples of the source.
    glm::dvec2 to_middle{0.0};
};

/// A heightfield with its colours.
struct Terrain {
    std::string name; ///< file or built-in name, for messages and titles
    Heightfield heightfield;
    Image color;                          ///< from edge sample to edge sample; may be empty
    std::vector<std::string> notes;       ///< for the user
    std::vector<std::string> errors = {}; ///< one sentence per file that could not be read
    Facades facades = {};                 ///< on walls of buildings; as many samples as heights
};

/// Range of the samples that are no voids; {0,0} if there are none.
HeightRange height_range(const Grid<float>& heights, const Grid<std::uint8_t>& void_mask);

/// Heights scaled to [0,1]; 0 if all are equal.
Grid<float> unit_heights(GridView<const float> heights);

/// Bilinear height at (col, row), metres; clamped to the grid. Precondition: not empty.
double bilinear_height(GridView<const float> heights, glm::dvec2 sample);

/// The heights of the bilinear surface between two places, metres; clamped to the grid.
/// Preconditions: not empty; `first` is before `last` along both axes, or at it.
HeightRange surface_range(GridView<const float> heights, glm::dvec2 first, glm::dvec2 last);

/// Whether a sample that contributes to bilinear_height() is a void.
bool uses_void(const Heightfield& heightfield, glm::dvec2 sample);

/// Fills voids by a membrane over the heights around them: Laplace's equation on a pyramid of
/// averages, from coarse to fine. Fills stay between the lowest and the highest known height. Voids
/// everywhere give 0. Precondition: `void_mask` is empty or has the size of the heights.
void fill_voids(Grid<float>& heights, const Grid<std::uint8_t>& void_mask);

} // namespace reljef::terrain
