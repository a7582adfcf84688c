#pragma once

#include <array>
#include <limits>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace reljef {

/// How far from the origin anything may be placed, metres: there doubles still tell a
/// ten-thousandth of a millimetre apart, and the whole Earth is well inside.
inline constexpr double world_reach = 1e9;

/// A point as the nearest floats and what those leave of it, in floats: together twice the digits.
struct SplitPoint {
    glm::vec3 rounded{0.0F};
    glm::vec3 rest{0.0F};
};
SplitPoint split_into_floats(glm::dvec3 point);

/// An axis-aligned box; the default one is empty.
struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};

    [[nodiscard]] bool empty() const { return !(low.x <= high.x); }
    [[nodiscard]] glm::dvec3 center() const { return 0.5 * (low + high); }
    [[nodiscard]] glm::dvec3 size() const { return high - low; }
    /// Grows to hold the point.
    void add(glm::dvec3 point);
    /// Grows to hold the box; an empty one changes nothing.
    void add(const Box& box);
};

/// The box around a box moved by an affine transform.
Box transformed(const glm::dmat4& to_from_local, const Box& box);

/// Points origin + t·direction, t >= 0; the direction need not be of unit length.
struct Ray {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0, 0.0, -1.0};

    [[nodiscard]] glm::dvec3 at(double t) const { return origin + t * direction; }
};
bool is_finite(const Ray& ray);

/// A range of t.
struct Interval {
    double begin = 0.0;
    double end = 0.0;
};

/// The part of `range` (all t >= 0) in which a ray is inside a box, if any (slab method; a
/// direction of 0 along an axis is allowed).
std::optional<Interval> intersect(const Ray& ray, const Box& box,
                                  Interval range = {0.0, std::numeric_limits<double>::infinity()});

/// The half-spaces a camera sees, each dot(normal, p) + offset >= 0. With an infinite far plane one
/// of them always holds.
class Frustum {
public:
    /// From a matrix with clip z in [0, w] (Gribb & Hartmann 2001).
    explicit Frustum(const glm::dmat4& clip_from_world);

    /// False only for an empty box or one wholly outside one of the planes: conservative, never
    /// drops a visible one.
    [[nodiscard]] bool may_see(const Box& box) const;

    /// The same half-spaces in local coordinates: boxes there need not be transformed, and stay as
    /// tight as they are.
    [[nodiscard]] Frustum in_local(const glm::dmat4& world_from_local) const;

private:
    std::array<glm::dvec4, 6> planes_;
};

} // namespace reljef
