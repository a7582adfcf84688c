#pragma once

#include "engine/render/passes/frame_context.h"

namespace reljef::render {

/// Draws the list's reliefs: of each the box that holds it, after the beams of those that have
/// them. Fails as ShaderLibrary::program.
Result<void> paint_reliefs(const FrameContext& frame_context);

} // namespace reljef::render
