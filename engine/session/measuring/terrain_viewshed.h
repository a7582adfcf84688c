#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/placement.h"

namespace reljef::session {

struct ViewshedRequest {
    glm::dvec2 from{0.0};       ///< latitude and longitude of the eye, degrees
    double eye_height = 2.0;    ///< above the ground, metres
    double target_height = 0.0; ///< above the ground, metres
    double max_distance = std::numeric_limits<double>::infinity(); ///< metres
    terrain::PlacementKind placement = terrain::PlacementKind::ellipsoid;
};

/// Of each sample of a heightfield: 255 visible, 0 hidden, 128 a void.
struct TerrainViewshed {
    Grid<std::uint8_t> seen;
    double visible_share = 0.0; ///< of the samples that are no voids, [0, 1]
};

/// Fails for heights without a place on Earth, an eye beside them or on a void, and when stopped.
Result<TerrainViewshed> viewshed_of(const terrain::Terrain& terrain, const ViewshedRequest& request,
                                    const ParallelOptions& parallel = {});

/// Fails unless the extension is .tif or .tiff, or that of a picture.
Result<void> check_viewshed_name(const std::filesystem::path& path);

/// Writes a GeoTIFF of bytes on the samples of the heightfield (void: 128), or a grey picture.
/// Without the samples that close a globe.
Result<void> write_viewshed(const std::filesystem::path& path, const TerrainViewshed& viewshed,
                            const terrain::Heightfield& heightfield);

} // namespace reljef::session
