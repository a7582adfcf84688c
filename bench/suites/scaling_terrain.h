#pragma once

#include <filesystem>
#include <stop_token>

#include <glm/vec2.hpp>

#include "bench/runner/suite_options.h"
#include "engine/core/atomic_file.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// Height of the test terrain, metres, at a sample of a raster with `side` samples a side: a sum of
/// waves over a 40 km square. The rasters hold it as float.
double scaling_height(glm::ivec2 sample, int side);

/// Writes the terrain as a tiled GeoTIFF with overviews.
Result<void> write_scaling_terrain(const std::filesystem::path& path, int side,
                                   const SuiteOptions& suite, const std::stop_token& stop);

/// A folder in `parent` (empty: the system's temporary folder). Fails if a raster of `max_side`
/// samples a side does not fit.
Result<ScratchFolder> make_scaling_folder(const std::filesystem::path& parent, int max_side);

} // namespace reljef::bench
