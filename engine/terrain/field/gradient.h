#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/placement.h"

namespace reljef::terrain {

/// Slope of the placed surface at every sample in the scene frame: (∂z/∂x, ∂z/∂y), rise over run,
/// so that the surface normal is along (−∂z/∂x, −∂z/∂y, 1). From central differences inside and
/// one-sided ones at the border, times the exaggeration; an ellipsoid's own curvature is in it.
/// Precondition: at least 2×2 samples.
Grid<glm::vec2> scene_gradients(const Heightfield& heightfield, const Placement& placement);

/// The grid's own directions at a sample, in the scene frame, as unit columns: east along the
/// columns, north against the rows, up. They are the frame's own only where the rows run east.
glm::dmat3 grid_axes(const Heightfield& heightfield, const Placement& placement, glm::dvec2 sample);

} // namespace reljef::terrain
