#pragma once

#include "engine/core/geometry.h"
#include "engine/scene/graph/camera.h"

namespace reljef::bench {

/// A camera that moves sideways, there and back around its place: in each frame as far as a flight
/// over `bounds` (metres) in 20 s at 25 frames a second, up to a fiftieth of their width to each
/// side.
class MovingView {
public:
    MovingView(const scene::Camera& camera, const Box& bounds);

    /// Of a frame, from 0 on. No two frames in a row have the same camera.
    [[nodiscard]] scene::Camera at(int frame) const;

private:
    scene::Camera camera_;
    glm::dvec3 step_{0.0}; // metres
};

} // namespace reljef::bench
