#pragma once

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/scene/graph/camera.h"
#include "engine/terrain/field/horizon.h"

namespace reljef::view {

/// A view, as a horizon of a terrain's local frame needs it, where all that is drawn of the terrain
/// may be seen `error` pixels off. Absent where there is no one eye, or angles are others there.
std::optional<terrain::HorizonView> horizon_view(const scene::Camera& camera, glm::ivec2 size,
                                                 const glm::dmat4& world_from_local, double error);

} // namespace reljef::view
