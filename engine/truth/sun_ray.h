#pragma once

#include <glm/vec3.hpp>

#include "engine/truth/scene_caster.h"

namespace reljef::truth {

/// Whether a ray from a hit to the sun meets nothing of the hit's own terrain: exact, no penumbra.
/// A place that is turned away from the sun sees none of it; what lies within a thousandth of a
/// sample of the place is not asked. `to_sun`: unit vector in the world.
bool sees_sun(const SceneCaster& caster, const SceneHit& hit, glm::dvec3 to_sun);

} // namespace reljef::truth
