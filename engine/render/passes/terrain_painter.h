#pragma once

#include "engine/render/passes/painting.h"

namespace reljef::render {

/// Draws the list's tiles of terrains, with the tiles of detail that are seen on them. Fails as
/// ShaderLibrary::program.
Result<void> paint_terrain_tiles(const Painting& painting);

/// The same for the tiles that are streamed.
Result<void> paint_streamed_tiles(const Painting& painting);

} // namespace reljef::render
