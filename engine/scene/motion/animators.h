#pragma once

#include "engine/scene/graph/scene.h"
#include "engine/scene/motion/camera_path.h"

namespace reljef::scene {

/// The camera where a path has it: upright, whatever it was before.
Camera at_key(Camera camera, const Keyframe& key);

/// Moves a camera node along a path, again from its beginning where it ends.
Animator camera_path_animator(CameraPath path);

/// Turns a node about its own z axis, degrees a second, counter-clockwise from above; how it was
/// turned and scaled when first run is kept beneath. One animator for each node.
Animator rotation_animator(double degrees_per_second);

} // namespace reljef::scene
