#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/scene/graph/camera.h"

namespace reljef::view {

/// The projection of a picture, for many places.
class LabelView {
public:
    LabelView(const scene::Camera& camera, glm::ivec2 size);

    [[nodiscard]] glm::dvec2 size() const { return size_; }
    /// As scene::project().
    [[nodiscard]] scene::Projected project(glm::dvec3 world) const;
    [[nodiscard]] bool is_before_eye(const scene::Projected& place) const {
        return !is_perspective_ || place.depth > 0.0;
    }
    /// Metres across a pixel at a depth.
    [[nodiscard]] double pixel_width(double depth) const;

    /// The way from a place to the eye, and its range of t.
    struct Sight {
        Ray ray;
        Interval range;
    };
    [[nodiscard]] Sight sight_from(glm::dvec3 world) const;

private:
    scene::Camera camera_;
    scene::ViewAxes axes_;
    glm::dvec2 size_;
    bool is_perspective_;
    double half_height_; // metres at depth 1, or everywhere
};

} // namespace reljef::view
