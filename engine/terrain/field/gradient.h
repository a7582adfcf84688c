#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/placement.h"

namespace reljef::terrain {

/// Gradient (∂z/∂x, ∂z/∂y) of the placed surface at every sample in the scene frame, rise over run:
/// central differences inside, one-sided at the border. It includes the exaggeration and the
/// ellipsoid's curvature. Precondition: at least 2×2 samples.
Grid<glm::vec2> surface_gradients(const Heightfield& heightfield, const Placement& placement);

/// The grid's axes at a sample in the scene frame, as unit columns: along the columns (east),
/// against the rows (north), up.
glm::dmat3 grid_axes(const Heightfield& heightfield, const Placement& placement, glm::dvec2 sample);

/// World metres of a step of each coordinate of a sample: column, row, true metre of height.
glm::dvec3 metres_at(const Placement& placement, glm::dvec3 sample);

/// How wrong a georeferenced terrain is on a plane, over a lattice of samples: the largest relative
/// error of lengths along columns and rows, and 1 - cosine of the verticals' tilts. 0 where it
/// cannot lie on the ellipsoid.
double plane_distortion(const Heightfield& heightfield);

} // namespace reljef::terrain
