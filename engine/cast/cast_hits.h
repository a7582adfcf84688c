#pragma once

#include <optional>

#include "engine/cast/block_rays.h"
#include "engine/cast/picture_rays.h"
#include "engine/cast/ray_tile.h"
#include "engine/cast/simd_target.h"
#include "engine/core/hit.h"
#include "engine/core/parallel_for.h"
#include "engine/core/result.h"

namespace reljef::cast {

struct CastOptions {
    ParallelOptions parallel = {};         ///< no influence on the result
    RaySkips skips = {};                   ///< no influence on the result
    std::optional<SimdTarget> target = {}; ///< absent: the fastest of the machine
};

/// The first hit of each ray of a picture, exact for the bilinear surface: a crossing from above to
/// below. A ray that enters beneath the surface at the border continues to a front face. A ray that
/// is not finite has no hit. Fails when stopped. Precondition: `rays` was made for the tile.
Result<HitBuffer> cast_hits(const RayTile& tile, const PictureRays& rays,
                            const CastOptions& options = {});

/// The same for the tiles of a terrain: hits have its samples.
Result<HitBuffer> cast_hits(const PlacedTiles& placed, glm::ivec2 size,
                            const CastOptions& options = {});

} // namespace reljef::cast
