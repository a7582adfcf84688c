#pragma once

#include <memory>

#include "engine/core/result.h"
#include "engine/material/relief_material.h"
#include "engine/scene/technique/technique.h"

namespace reljef::scene {

/// A tile of surface detail that repeats over a terrain drawn as polygons: its colour over the
/// terrain's, its heights sunk below the triangles and met in the plane that touches them. It fades
/// with the distance, and counts in no hit: that is the terrain's own.
struct TerrainDetail {
    std::shared_ptr<const material::ReliefMaterial> set; ///< as completed() gave it
    double width = 4.0;  ///< metres that a tile covers, [terrain::min_tile_width, max_tile_width]
    float scale = 0.05F; ///< height of 1, in tile widths; (0, terrain::max_tile_scale]
    Technique technique{Relief{}}; ///< as check_ground_technique allows
};

/// Whether a technique shows a tile on a terrain. Fails, with the reason and the name of what
/// works, on one that moves vertices, warps, or looks for layers, and on options beside steps and
/// shadow.
Result<void> check_terrain_detail_technique(const Technique& technique);

} // namespace reljef::scene
