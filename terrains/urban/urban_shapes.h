#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "engine/material/noise.h"

namespace reljef::terrains::urban {

/// Random numbers that are the same on every machine.
class Random {
public:
    explicit Random(std::uint32_t seed) : seed_(seed) {}

    std::uint32_t bits() { return material::hash(seed_, ++count_, 7919); }
    /// In [0, 1).
    float unit() { return static_cast<float>(bits() >> 8U) * 0x1p-24F; }
    float range(float low, float high) { return low + (high - low) * unit(); }
    bool chance(float probability) { return unit() < probability; }
    /// In [0, count). Precondition: count > 0.
    int index(int count) { return static_cast<int>(bits() % static_cast<std::uint32_t>(count)); }
    template <class Items> const auto& pick(const Items& items) {
        return items[static_cast<std::size_t>(index(static_cast<int>(items.size())))];
    }
    /// About normal with mean 0 and deviation about 0.5, within [-1.5, 1.5].
    float bell() { return unit() + unit() + unit() - 1.5F; }

private:
    std::uint32_t seed_;
    std::int32_t count_ = 0;
};

using glm::dot;
using glm::fract;
using glm::length;

/// Unit vector; (1,0) for a vector of length 0.
glm::vec2 normalized(glm::vec2 v);
/// A quarter turn counter-clockwise: the inward normal of an edge of a Convex.
inline glm::vec2 turned(glm::vec2 v) {
    return {-v.y, v.x};
}

/// Points with distance(p) >= 0; `normal` is a unit vector.
struct HalfPlane {
    glm::vec2 normal{0.0F, 1.0F};
    float offset = 0.0F;

    [[nodiscard]] float distance(glm::vec2 point) const { return dot(normal, point) - offset; }
    [[nodiscard]] HalfPlane flipped() const { return {-normal, -offset}; }
};

/// Share of a square on the inner side of an edge that passes its middle at a distance.
inline float share_inside(glm::vec2 normal, float distance, float side) {
    const float width = side * (std::abs(normal.x) + std::abs(normal.y));
    return glm::clamp(distance / width + 0.5F, 0.0F, 1.0F);
}

struct Box {
    glm::vec2 low{1e30F, 1e30F};
    glm::vec2 high{-1e30F, -1e30F};

    void add(const Box& other) {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
    void add(glm::vec2 point, float margin = 0.0F) { add(Box{point - margin, point + margin}); }
    [[nodiscard]] Box moved(glm::vec2 shift) const { return {low + shift, high + shift}; }
};

/// A convex polygon, counter-clockwise, metres. Polygons with fewer than three corners are empty.
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
/// Moves every edge inward by `distance`. The result may have fewer edges or be empty.
Convex inset(const Convex& shape, float distance);

/// An oriented rectangle.
struct Frame {
    glm::vec2 center{0.0F, 0.0F};
    glm::vec2 axis{1.0F, 0.0F}; ///< unit vector
    glm::vec2 half{0.0F, 0.0F}; ///< half extents along axis and turned(axis)

    [[nodiscard]] glm::vec2 at(float along, float across) const {
        return center + axis * along + turned(axis) * across;
    }
    /// The same rectangle with its axis along the longer side.
    [[nodiscard]] Frame lengthwise() const {
        return half.x >= half.y ? *this : Frame{center, turned(axis), {half.y, half.x}};
    }
};
/// The bounding rectangle along the longest edge.
Frame frame_of(const Convex& shape);
/// The bounding rectangle along a given unit vector.
Frame frame_along(const Convex& shape, glm::vec2 axis);
Convex rectangle(const Frame& frame);
Convex octagon(glm::vec2 center, glm::vec2 half);

struct LotOptions {
    float area = 600.0F;    ///< largest piece, m²
    float jitter = 0.1F;    ///< offset of a cut from the middle, share of the length
    float min_width = 9.0F; ///< of a piece, metres
};
/// Cuts a shape across its longest side until its pieces are small.
std::vector<Convex> lots_of(const Convex& shape, const LotOptions& options, Random& random);

/// A convex shape with precomputed edges.
struct Footprint {
    std::vector<HalfPlane> planes;
    Box bounds;

    Footprint() = default;
    explicit Footprint(const Convex& shape);
    [[nodiscard]] float distance(glm::vec2 point) const;
    /// Share of a square around a point that lies inside, if at most one edge or corner does.
    [[nodiscard]] float share(glm::vec2 center, float side) const;
};

} // namespace reljef::terrains::urban
