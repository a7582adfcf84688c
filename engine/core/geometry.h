#pragma once

#include <array>
#include <limits>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace reljef {

/// Maximum coordinate, metres. Doubles still resolve 1e-7 m there, and the whole Earth fits.
inline constexpr double max_world_coordinate = 1e9;

/// The nearest float. Volatile: vectorized code of g++ 12 skips the conversion.
inline double rounded_to_float(double value) {
    const volatile float rounded = static_cast<float>(value);
    return static_cast<double>(rounded);
}

/// A point as two floats per axis: the nearest float and the remainder, with twice the precision.
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
    /// Grows to contain the point or box.
    void add(glm::dvec3 point);
    void add(const Box& box);
};

/// Bounding box of a box under an affine transform.
Box transformed(const glm::dmat4& to_from_local, const Box& box);

/// Bounds the factor by which a linear map lengthens a vector; exact where it scales along
/// orthogonal axes.
double max_stretch(const glm::dmat3& map);

/// Points origin + t·direction, t >= 0; the direction may have any length.
struct Ray {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0, 0.0, -1.0};

    [[nodiscard]] glm::dvec3 at(double t) const { return origin + t * direction; }
};
bool is_finite(const Ray& ray);

struct Interval {
    double begin = 0.0;
    double end = 0.0;
};

/// The part of `range` in which a ray is inside a box (slab method). Direction components may be 0.
std::optional<Interval> intersect(const Ray& ray, const Box& box,
                                  Interval range = {0.0, std::numeric_limits<double>::infinity()});

/// The six half-spaces of a camera, each dot(normal, p) + offset >= 0.
class Frustum {
public:
    /// From a matrix with clip z in [0, w] (Gribb & Hartmann 2001).
    explicit Frustum(const glm::dmat4& clip_from_world);

    /// Conservative: false only if the box is empty or wholly outside one plane.
    [[nodiscard]] bool may_see(const Box& box) const;

    /// The same half-spaces in local coordinates.
    [[nodiscard]] Frustum in_local(const glm::dmat4& world_from_local) const;

private:
    std::array<glm::dvec4, 6> planes_;
};

} // namespace reljef
