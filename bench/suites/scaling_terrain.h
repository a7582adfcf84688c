#pragma once

#include <filesystem>
#include <memory>
#include <stop_token>

#include <glm/vec2.hpp>

#include "bench/runner/suite_options.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// Height of the test terrain, a 40 km square that is a sum of waves, at a sample of a raster of
/// `side` samples a side; metres. The rasters hold it rounded to float.
double scaling_height(glm::ivec2 sample, int side);

/// Writes the terrain as a tiled GeoTIFF with overviews.
Result<void> write_scaling_terrain(const std::filesystem::path& path, int side,
                                   const SuiteOptions& suite, const std::stop_token& stop);

/// Creates a folder for rasters of up to `max_side` samples a side in `parent` (empty: the system's
/// folder for temporary files). It is removed with the last copy of the result. Fails if the disk
/// has too little space.
Result<std::shared_ptr<const std::filesystem::path>>
make_scaling_folder(const std::filesystem::path& parent, int max_side);

} // namespace reljef::bench
