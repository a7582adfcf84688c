#pragma once

#include <functional>
#include <limits>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/scene/graph/camera.h"

namespace reljef::scene {

/// A world point and the place of the picture that shows it, pixels.
struct Grip {
    glm::dvec3 point{0.0};
    glm::dvec2 pixel{0.0};
};

/// What gestures need to know of the picture and the world.
struct GestureWorld {
    glm::ivec2 size{1}; ///< of the picture, pixels
    /// Local vertical, a unit vector; absent: z.
    std::function<glm::dvec3(glm::dvec3 world)> up;
    /// Horizontal unit vector to the north; absent: y.
    std::function<glm::dvec3(glm::dvec3 world)> north;
    /// An eye, lifted above the ground along the vertical; absent: there is no ground.
    std::function<glm::dvec3(glm::dvec3 eye)> lifted;
    double radius = std::numeric_limits<double>::infinity(); ///< of level surfaces, metres
    double min_distance = 1.0; ///< of an eye that approaches a point, metres
    double max_distance = 1e9; ///< of an eye that leaves it, metres
};

inline constexpr double max_pitch = 89.9; ///< of upright cameras, degrees

ViewAngles angles_of(const Camera& camera, const GestureWorld& world);
/// The upright camera at an eye with these angles and the projection of `camera`. The pitch is
/// clamped to ±max_pitch.
Camera upright(Camera camera, glm::dvec3 eye, const ViewAngles& angles, const GestureWorld& world);

// Gestures return upright perspective cameras. If a number is not finite, or no such camera does
// what is asked, they return the camera as it is.

/// The camera at the same eye that shows the grip's point at its pixel. Of two possible pitches it
/// takes the one nearer to the camera's. An upright camera shows a point straight below in the
/// middle column only: so a steep point moves in its row as far as it must.
Camera aimed(const Camera& camera, const Grip& grip, const GestureWorld& world);

/// Turns at the same eye.
Camera turned(const Camera& camera, const ViewAngles& change, const GestureWorld& world);

/// Multiplies the distance from the grip's point, which keeps its pixel. The distance stays between
/// the limits of the world.
Camera zoomed(const Camera& camera, const Grip& grip, double factor, const GestureWorld& world);

/// Turns around the grip's point, which keeps its pixel and its distance. Where the ground lifts
/// the eye, the point still keeps its pixel.
Camera orbited(const Camera& camera, const Grip& grip, const ViewAngles& change,
               const GestureWorld& world);

/// Moves the eye over the level surface through it, with its angles to the ground, until the grip's
/// point is shown at its pixel. The heading is carried along the great circle. Where the ground
/// lifts the eye, and no place of it shows the point, the angles change.
Camera panned(const Camera& camera, const Grip& grip, const GestureWorld& world);

} // namespace reljef::scene
