#pragma once

#include <glm/mat4x4.hpp>

#include "engine/core/geometry.h"
#include "engine/scene/graph/camera.h"

namespace reljef::scene {

/// Which way a mesh faces. A mesh that faces the camera is a billboard: its x goes right on the
/// picture, its y away from the viewer, and its z up.
enum class Facing {
    node,   ///< that of its node
    camera, ///< the camera
    upright ///< the camera, but z stays that of its node: it turns about it only
};

/// The node's transform, turned towards the camera: it keeps the place and the scale along each
/// axis. A transform that makes a point or a plane of the mesh stays as it is.
glm::dmat4 faced(Facing facing, const glm::dmat4& world_from_local, const Camera& camera);

/// Bounds of what has these bounds, however it is turned about the origin.
Box turned_bounds(const Box& bounds);

} // namespace reljef::scene
