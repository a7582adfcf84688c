#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::session {

struct StraightHeights {
    std::size_t changed = 0; ///< samples
    double largest = 0.0;    ///< change, metres
};

/// Writes a terrain whose walls look straight (material/straight_walls.h) as a GeoTIFF, whole or
/// not at all. `wall_height`: absent: 2.5 m, or the spacing if that is more. Fails if the terrain
/// was read with fewer samples than it has, if it goes around the Earth, or if it was stopped.
Result<StraightHeights> write_straight_heights(const std::filesystem::path& path,
                                               const terrain::Terrain& terrain,
                                               std::optional<double> wall_height,
                                               const ParallelOptions& parallel = {});

} // namespace reljef::session
