#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "terrains/natural/noise.h"

namespace reljef::terrains::urban {

/// A stream of numbers of a seed: the same on every machine.
class Random {
public:
    explicit Random(std::uint32_t seed) : seed_(seed) {}

    std::uint32_t bits() { return hash(seed_, ++count_, 7919); }
    /// In [0, 1).
    float unit() { return static_cast<float>(bits() >> 8U) * 0x1p-24F; }
    float range(float low, float high) { return low + (high - low) * unit(); }
    bool chance(float probability) { return unit() < probability; }
    /// In [0, count). Precondition: count > 0.
    int index(int count) { return static_cast<int>(bits() % static_cast<std::uint32_t>(count)); }
    /// About normal with mean 0 and deviation about 0.5, within [-1.5, 1.5].
    float bell() { return unit() + unit() + unit() - 1.5F; }

private:
    std::uint32_t seed_;
    std::int32_t count_ = 0;
};

/// What is over the next lower whole number, in [0, 1).
inline float fraction(float value) {
    return value - std::floor(value);
}
float dot(glm::vec2 a, glm::vec2 b);
float length(glm::vec2 v);
glm::vec2 normalized(glm::vec2 v);
/// A quarter turn: the inward normal of an edge of a Convex.
glm::vec2 turned(glm::vec2 v);

/// Points with distance(p) >= 0; `normal` is a unit vector.
struct HalfPlane {
    glm::vec2 normal{0.0F, 1.0F};
    float offset = 0.0F;

    [[nodiscard]] float distance(glm::vec2 point) const {
        return normal.x * point.x + normal.y * point.y - offset;
    }
};

struct Box {
    glm::vec2 low{1e30F, 1e30F};
    glm::vec2 high{-1e30F, -1e30F};

    void add(const Box& other);
    void add(glm::vec2 point, float margin = 0.0F);
};

/// A convex polygon, metres; fewer than three corners mean that nothing is left. Inward is `turned`
/// of an edge's direction.
struct Convex {
    std::vector<glm::vec2> corners;

    [[nodiscard]] std::size_t size() const { return corners.size(); }
    [[nodiscard]] bool empty() const { return corners.size() < 3; }
    [[nodiscard]] glm::vec2 corner(std::size_t i) const { return corners[i % corners.size()]; }
};

/// The plane of edge i, from corner i to the next.
HalfPlane edge_plane(const Convex& shape, std::size_t i);
float area(const Convex& shape);
glm::vec2 centroid(const Convex& shape);
/// Least distance to an edge's line, negative outside. Precondition: not empty.
float inner_distance(const Convex& shape, glm::vec2 point);
Convex clipped(const Convex& shape, const HalfPlane& keep);
/// Every edge moved inward by `distance`; edges may vanish, and so may the whole.
Convex inset(const Convex& shape, float distance);

/// A box along the longest edge of a shape.
struct Frame {
    glm::vec2 center{0.0F, 0.0F};
    glm::vec2 axis{1.0F, 0.0F}; ///< unit, along the longest edge
    glm::vec2 half{0.0F, 0.0F}; ///< half extents along axis and turned(axis)

    [[nodiscard]] glm::vec2 at(float along, float across) const;
};
Frame frame_of(const Convex& shape);
/// The box around `shape` along a given unit vector.
Frame frame_along(const Convex& shape, glm::vec2 axis);
Convex rectangle(const Frame& frame);
/// A regular polygon of eight corners.
Convex octagon(glm::vec2 center, glm::vec2 half);

struct LotOptions {
    float area = 600.0F;    ///< pieces above this are cut, m^2
    float jitter = 0.1F;    ///< the cut's place about the middle, as a part of the length
    float min_width = 9.0F; ///< no piece gets narrower
};
/// A shape cut across its longest side until its pieces are small.
std::vector<Convex> lots_of(const Convex& shape, const LotOptions& options, Random& random);

/// What the painter needs of a convex shape.
struct Footprint {
    std::vector<HalfPlane> planes;
    Box bounds;

    Footprint() = default;
    explicit Footprint(const Convex& shape);
    [[nodiscard]] float distance(glm::vec2 point) const;
};

} // namespace reljef::terrains::urban
