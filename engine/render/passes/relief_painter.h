#pragma once

#include "engine/render/passes/painting.h"

namespace reljef::render {

/// Draws the list's reliefs: of each the box that holds it, after the beams of those that have
/// them. Fails as ShaderLibrary::program.
Result<void> paint_reliefs(const Painting& painting);

} // namespace reljef::render
