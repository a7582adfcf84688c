#include "engine/scene/motion/camera_transition.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace reljef::scene {
namespace {

// The place between two eyes; over a ball on the great circle, with the height between theirs.
glm::dvec3 between(glm::dvec3 from, glm::dvec3 to, double share, const GestureWorld& world) {
    const glm::dvec3 straight = from + share * (to - from);
    if (!std::isfinite(world.radius) || !world.up) {
        return straight;
    }
    const glm::dvec3 center = from - world.radius * world.up(from);
    const double length = std::lerp(glm::distance(from, center), glm::distance(to, center), share);
    const glm::dvec3 direction = straight - center;
    const double straight_length = glm::length(direction);
    // Between opposite places every great circle is one.
    return straight_length > 0.0 ? center + length / straight_length * direction : straight;
}

} // namespace

Camera CameraTransition::at(double time, const GestureWorld& world) const {
    const double t = seconds() > 0.0 ? std::clamp(time / seconds(), 0.0, 1.0) : 1.0;
    if (!(t < 1.0)) {
        return to_;
    }
    const double share = t * t * t * (t * (6.0 * t - 15.0) + 10.0); // at rest at both ends
    const ViewAngles first = angles_of(from_, world);
    const ViewAngles last = angles_of(to_, world);
    const double turn = std::remainder(last.heading - first.heading, 360.0);
    glm::dvec3 eye = between(from_.eye, to_.eye, share, world);
    const glm::dvec3 up = world.up ? world.up(eye) : glm::dvec3(0.0, 0.0, 1.0);
    const glm::dvec3 way = to_.eye - from_.eye;
    const double level = glm::length(way - glm::dot(way, up) * up);
    eye += 4.0 * share * (1.0 - share) * options_.arc * level * up;
    return upright(to_, world.lifted ? world.lifted(eye) : eye,
                   {first.heading + share * turn, std::lerp(first.pitch, last.pitch, share)},
                   world);
}

Camera closer_to(const Camera& camera, glm::dvec3 point, const GestureWorld& world) {
    constexpr double share = 0.25;
    const Grip middle{point, 0.5 * glm::dvec2(world.size)};
    return zoomed(aimed(camera, middle, world), middle, share, world);
}

} // namespace reljef::scene
