#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace reljef::building {

/// Corners of a closed line on a plane, metres; the last one is joined to the first.
using Ring = std::vector<glm::dvec2>;

/// The outline of a building from above.
struct Footprint {
    std::vector<Ring> rings; ///< the outer one counter-clockwise, then its holes clockwise
    /// They fill the outline, counter-clockwise. Indices of the corners of all rings in order.
    std::vector<glm::uvec3> triangles;
};

/// Square metres; negative for a clockwise ring.
double signed_area(const Ring& ring);

/// The mean of the corners. Precondition: not empty.
glm::dvec2 middle_of(const Ring& ring);

/// Finer details of an outline are no shape, metres.
inline constexpr double outline_precision = 0.01;

/// Without corners that lie within outline_precision of the line between their neighbours; fewer
/// than three corners are none.
Ring without_straight_corners(const Ring& ring);

/// Whether a ring without straight corners turns left at each corner, and once in all.
bool is_convex(const Ring& ring);

} // namespace reljef::building
