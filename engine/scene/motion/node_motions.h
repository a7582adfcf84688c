#pragma once

#include <memory>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "engine/scene/graph/scene.h"

namespace reljef::scene {

// Motions of nodes as values: each is a function of the time alone, so times may come in any order.
// Places are metres in the frame of the node's parent. A time that is not a number is the
// beginning.

/// What follows the end of a motion. Before its beginning a motion stands still with `stay`, and
/// continues backwards with the others.
enum class AfterEnd { stay, repeat, turn_back };

/// Around a circle, counter-clockwise as seen from the tip of the axis.
struct FlyCircle {
    glm::dvec3 center{0.0};
    double radius = 100.0;          ///< metres
    double seconds = 20.0;          ///< once around; negative: clockwise; 0: stands still
    glm::dvec3 axis{0.0, 0.0, 1.0}; ///< any length but 0
    double turn = 0.0;              ///< degrees on the circle at time 0; around z from the east

    [[nodiscard]] glm::dvec3 at(double time) const;
};

/// From a place to another at constant speed.
struct FlyStraight {
    glm::dvec3 from{0.0};
    glm::dvec3 to{0.0};
    double seconds = 10.0; ///< of one way; not above 0: at the end at once
    AfterEnd after = AfterEnd::stay;

    [[nodiscard]] glm::dvec3 at(double time) const;
};

/// Through points, each the same time after the last: a cardinal spline. With `repeat` it is
/// closed: from the last point it returns to the first.
struct FollowSpline {
    std::vector<glm::dvec3> points; ///< at least one
    double seconds = 1.0;           ///< from point to point; not above 0: at the end at once
    double tightness = 0.5;         ///< tangents in secants; 0.5: Catmull-Rom, 0: straight lines
    AfterEnd after = AfterEnd::repeat;

    /// Precondition: there are points.
    [[nodiscard]] glm::dvec3 at(double time) const;
};

/// A constant rotation.
struct Rotation {
    glm::dvec3 axis{0.0, 0.0, 1.0};   ///< any length but 0
    double degrees_per_second = 90.0; ///< counter-clockwise as seen from the tip of the axis
    glm::dmat3 begin{1.0};            ///< rotation and scale at time 0

    [[nodiscard]] glm::dmat3 at(double time) const;
};

/// One relief material after the other.
struct TextureCycle {
    std::vector<std::shared_ptr<const material::ReliefMaterial>> sets; ///< as completed() returned
    double seconds = 0.1; ///< of each; not above 0: the last one at once
    AfterEnd after = AfterEnd::repeat;

    /// Precondition: there are sets.
    [[nodiscard]] std::shared_ptr<const material::ReliefMaterial> at(double time) const;
};

// Motions as animators. Those of places keep the node's rotation and scale; a rotation keeps its
// place. A texture cycle changes the detail of a mesh; other nodes have none.

Animator animator(const FlyCircle& motion);
Animator animator(const FlyStraight& motion);
Animator animator(FollowSpline motion);
Animator animator(const Rotation& motion);
Animator animator(TextureCycle motion);

} // namespace reljef::scene
