#pragma once

#include "engine/scene/motion/camera_gestures.h"

namespace reljef::scene {

struct TransitionOptions {
    double seconds = 1.0;
    double arc =
        0.0; ///< height of the middle over the straight way, in level distances of the ends
};

/// A smooth flight between two upright cameras. It starts and ends at rest.
class CameraTransition {
public:
    CameraTransition(const Camera& from, const Camera& to, const TransitionOptions& options)
        : from_(from), to_(to), options_(options) {}

    /// At a time since the start, seconds; clamped. At the end it is the last camera, bit by bit.
    [[nodiscard]] Camera at(double time, const GestureWorld& world) const;
    [[nodiscard]] double seconds() const { return options_.seconds; }
    [[nodiscard]] const Camera& end() const { return to_; }

private:
    Camera from_;
    Camera to_;
    TransitionOptions options_;
};

/// The camera that looks at a point from a quarter of its distance, with the angles of `camera` and
/// the point in the middle of the picture. No nearer than GestureWorld::min_distance.
Camera closer_to(const Camera& camera, glm::dvec3 point, const GestureWorld& world);

} // namespace reljef::scene
