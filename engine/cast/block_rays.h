#pragma once

#include <functional>
#include <optional>

#include <glm/vec2.hpp>

#include "engine/cast/beam.h"
#include "engine/cast/block_kernel.h"
#include "engine/cast/picture_rays.h"
#include "engine/cast/ray_tile.h"
#include "engine/core/parallel_for.h"

namespace reljef::cast {

/// The work of a block of pixels; empty: no ray of it hits the tile. `beams`: rays begin where
/// their beams may hit.
std::optional<BlockJob> block_job(const RayTile& tile, const PictureRays& rays,
                                  const PixelBlock& block, bool beams);

/// The work of a block whose rays hit nothing.
BlockJob empty_job();

/// Calls `body` for all blocks of a picture, from several threads. False if it was stopped early.
bool for_each_block(glm::ivec2 size, const ParallelOptions& parallel,
                    const std::function<void(const PixelBlock& block)>& body);

} // namespace reljef::cast
