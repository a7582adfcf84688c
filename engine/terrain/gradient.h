#pragma once

#include <glm/vec2.hpp>

#include "engine/terrain/heightfield.h"
#include "engine/terrain/placement.h"

namespace reljef::terrain {

/// Slope of the placed surface at every sample in the scene frame: (∂z/∂x, ∂z/∂y), rise over run,
/// so that the surface normal is along (−∂z/∂x, −∂z/∂y, 1). From central differences inside and
/// one-sided ones at the border, times the exaggeration; an ellipsoid's own curvature is in it.
/// Precondition: at least 2×2 samples.
Grid<glm::vec2> scene_gradients(const Heightfield& heightfield, const Placement& placement);

} // namespace reljef::terrain
