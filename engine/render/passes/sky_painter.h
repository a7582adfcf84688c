#pragma once

#include "engine/render/passes/painting.h"

namespace reljef::render {

/// Draws the list's sky where nothing else is; none where hits are drawn. Fails as
/// ShaderLibrary::program.
Result<void> paint_sky(const Painting& painting);

} // namespace reljef::render
