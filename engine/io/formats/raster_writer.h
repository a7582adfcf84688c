#pragma once

#include <filesystem>
#include <functional>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"
#include "engine/core/result.h"

namespace reljef::io {

/// Heights on a lattice of UTM zone 32 north (EPSG 32632).
struct HeightRaster {
    int cols = 0;
    int rows = 0;
    double spacing = 1.0;    ///< metres from sample to sample
    glm::dvec2 first{0.0};   ///< easting and northing of the first sample, metres
    int finest_overview = 4; ///< the overviews hold averages of 4 x 4, 16 x 16, … samples
};

/// Fills a band of rows with metres; `first_row` is that of the band's first.
using FillHeights = std::function<void(int first_row, GridView<float> heights)>;

/// Writes a GeoTIFF of floats, tiled, with overviews, a band of rows at a time: of a raster of any
/// size only some of it is in memory. It appears whole or not at all. Fails where it cannot be
/// written, and with "stopped" where a stop is asked for.
Result<void> write_heights(const std::filesystem::path& path, const HeightRaster& raster,
                           const FillHeights& fill, const ParallelOptions& parallel = {});

} // namespace reljef::io
