#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/geo/georeference.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::io {

/// A lattice in UTM zone 32 north (EPSG:32632).
struct HeightRaster {
    int cols = 0;
    int rows = 0;
    double spacing = 1.0;    ///< metres
    glm::dvec2 first{0.0};   ///< easting and northing of the first sample, metres
    int finest_overview = 4; ///< overviews average 4×4, 16×16, … samples
};

/// Fills rows from `first_row` with metres.
using FillHeights = std::function<void(int first_row, GridView<float> heights)>;

/// Writes a tiled GeoTIFF of floats with overviews, whole or not at all. Keeps only some rows in
/// memory. Fails with "stopped" after a stop request.
Result<void> write_heights(const std::filesystem::path& path, const HeightRaster& raster,
                           const FillHeights& fill, const ParallelOptions& parallel = {});

/// Writes a GeoTIFF of bytes at a georeference's samples, whole or not at all; without one, at
/// pixel coordinates. `in_void`: the value that means no data.
Result<void> write_bytes(const std::filesystem::path& path, const Grid<std::uint8_t>& bytes,
                         const std::optional<geo::Georeference>& georeference,
                         std::uint8_t in_void);

/// The same of a heightfield's metres, whose voids stay voids. Without a georeference its spacing
/// is that of the pixels.
Result<void> write_heightfield(const std::filesystem::path& path,
                               const terrain::Heightfield& heightfield);

} // namespace reljef::io
