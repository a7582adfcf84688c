#pragma once

#include "engine/render/passes/frame_context.h"

namespace reljef::render {

/// Draws the list's tiles of terrains, with the tiles of detail that are seen on them. Fails as
/// ShaderLibrary::program.
Result<void> paint_terrain_tiles(const FrameContext& frame_context);

/// The same for the tiles that are streamed.
Result<void> paint_streamed_tiles(const FrameContext& frame_context);

} // namespace reljef::render
