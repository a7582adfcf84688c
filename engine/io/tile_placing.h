#pragma once

#include <vector>

#include "engine/io/tile_layer.h"

namespace reljef::io {

/// Places of the usable files of an index. `faults` names those without a place on Earth.
/// Across the antimeridian longitudes run on, so that the set is as narrow as it can be.
std::vector<PlacedFile> place_files(const TileIndex& index, const std::filesystem::path& folder,
                                    std::vector<FileError>& errors);

/// Along the ellipsoid between two places, longitude and latitude in degrees.
double metres_between(glm::dvec2 a, glm::dvec2 b);

} // namespace reljef::io
