#pragma once

#include <functional>

#include "engine/core/geometry.h"
#include "engine/scene/graph/camera.h"

namespace reljef::bench {

/// A camera that moves sideways, there and back around its place: in each frame as far as a flight
/// over `bounds` (metres) in 20 s at 25 frames a second, up to a fiftieth of their width to each
/// side. Where the ground rises, the camera rises with it, so that it stays as far above at least.
class MovingView {
public:
    using GroundHeight = std::function<double(double x, double y)>; ///< metres
    MovingView(const scene::Camera& camera, const Box& bounds, GroundHeight ground);

    /// Frames from one end of the way to the other.
    static constexpr int half_period = 20;
    /// Of a frame, from 0 on. No two frames in a row have the same camera.
    [[nodiscard]] scene::Camera at(int frame) const;

private:
    scene::Camera camera_;
    glm::dvec3 step_{0.0}; // metres
    GroundHeight ground_;
    double clearance_ = 0.0; // metres
};

} // namespace reljef::bench
