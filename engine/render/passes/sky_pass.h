#pragma once

#include "engine/render/passes/frame_context.h"

namespace reljef::render {

/// Draws the list's sky where nothing else is; none where hits are drawn. Fails as
/// ShaderLibrary::program.
Result<void> paint_sky(const FrameContext& frame_context);

} // namespace reljef::render
