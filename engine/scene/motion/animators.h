#pragma once

#include "engine/scene/graph/scene.h"
#include "engine/scene/motion/camera_path.h"

namespace reljef::scene {

/// The camera at a keyframe, upright.
Camera at_key(Camera camera, const Keyframe& key);

/// Moves a camera node along a path, in a loop.
Animator camera_path_animator(CameraPath path);

/// Rotates a node about its own z axis, counter-clockwise from above, in addition to the rotation
/// and scale at the first call. One animator per node.
Animator rotation_animator(double degrees_per_second);

} // namespace reljef::scene
