#pragma once

#include "engine/render/passes/frame_context.h"

namespace reljef::render {

/// Draws the list's meshes: of one colour, with a tile of detail on it, or with each pixel looking
/// for the tile's surface. Fails as ShaderLibrary::program.
Result<void> paint_meshes(const FrameContext& frame_context);

} // namespace reljef::render
