#include "engine/scene/graph/facing.h"

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace reljef::scene {
namespace {

// Horizontal to the right, across an upright axis.
glm::dvec3 right_across(const ViewAxes& view, glm::dvec3 up) {
    const glm::dvec3 right = view.right - glm::dot(view.right, up) * up;
    constexpr double min_length = 1e-6;
    return glm::length(right) > min_length
               ? glm::normalize(right)
               : glm::normalize(glm::cross(view.forward, up)); // a camera that lies on its side
}

} // namespace

glm::dmat4 faced(Facing facing, const glm::dmat4& world_from_local, const Camera& camera) {
    glm::dvec3 scale;
    for (int i = 0; i < 3; ++i) {
        scale[i] = glm::length(glm::dvec3(world_from_local[i]));
    }
    if (facing == Facing::node || !(scale.x > 0.0 && scale.y > 0.0 && scale.z > 0.0)) {
        return world_from_local;
    }
    ViewAxes axes = view_axes(camera);
    if (facing == Facing::upright) {
        axes.up = glm::dvec3(world_from_local[2]) / scale.z;
        axes.right = right_across(axes, axes.up);
        axes.forward = glm::cross(axes.up, axes.right);
    }
    return {glm::dvec4(scale.x * axes.right, 0.0), glm::dvec4(scale.y * axes.forward, 0.0),
            glm::dvec4(scale.z * axes.up, 0.0), world_from_local[3]};
}

Box turned_bounds(const Box& bounds) {
    if (bounds.empty()) {
        return bounds;
    }
    const double reach = glm::length(glm::max(glm::abs(bounds.low), glm::abs(bounds.high)));
    return {glm::dvec3(-reach), glm::dvec3(reach)};
}

} // namespace reljef::scene
