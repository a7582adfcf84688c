#include "terrains/urban/urban_shapes.h"

#include <algorithm>

namespace reljef::terrains::urban {

glm::vec2 normalized(glm::vec2 v) {
    const float size = length(v);
    return size > 0.0F ? v * (1.0F / size) : glm::vec2{1.0F, 0.0F};
}

HalfPlane edge_plane(const Convex& shape, std::size_t i) {
    const glm::vec2 normal = turned(normalized(shape.corner(i + 1) - shape.corner(i)));
    return {normal, dot(normal, shape.corner(i))};
}

float area(const Convex& shape) {
    float twice = 0.0F;
    for (std::size_t i = 2; i < shape.size(); ++i) {
        const glm::vec2 a = shape.corners[i - 1] - shape.corners[0];
        const glm::vec2 b = shape.corners[i] - shape.corners[0];
        twice += a.x * b.y - a.y * b.x;
    }
    return 0.5F * twice;
}

glm::vec2 centroid(const Convex& shape) {
    glm::vec2 sum{0.0F, 0.0F};
    float weight = 0.0F;
    for (std::size_t i = 2; i < shape.size(); ++i) {
        const glm::vec2 a = shape.corners[i - 1] - shape.corners[0];
        const glm::vec2 b = shape.corners[i] - shape.corners[0];
        const float twice = a.x * b.y - a.y * b.x;
        sum += (a + b) * (twice / 3.0F);
        weight += twice;
    }
    return shape.corners[0] + (weight > 0.0F ? sum * (1.0F / weight) : glm::vec2{0.0F, 0.0F});
}

float inner_distance(const Convex& shape, glm::vec2 point) {
    float nearest = edge_plane(shape, 0).distance(point);
    for (std::size_t i = 1; i < shape.size(); ++i) {
        nearest = std::min(nearest, edge_plane(shape, i).distance(point));
    }
    return nearest;
}

Convex clipped(const Convex& shape, const HalfPlane& keep) {
    Convex kept;
    for (std::size_t i = 0; i < shape.size(); ++i) {
        const glm::vec2 a = shape.corners[i];
        const glm::vec2 b = shape.corner(i + 1);
        const float from = keep.distance(a);
        const float to = keep.distance(b);
        if (from >= 0.0F) {
            kept.corners.push_back(a);
        }
        if ((from >= 0.0F) != (to >= 0.0F)) {
            kept.corners.push_back(a + (b - a) * (from / (from - to)));
        }
    }
    return kept.empty() || area(kept) < 0.01F ? Convex{} : kept;
}

Convex inset(const Convex& shape, float distance) {
    Convex inner = shape;
    for (std::size_t i = 0; i < shape.size(); ++i) {
        HalfPlane plane = edge_plane(shape, i);
        plane.offset += distance;
        inner = clipped(inner, plane);
    }
    return inner;
}

Frame frame_along(const Convex& shape, glm::vec2 axis) {
    Box local;
    for (const glm::vec2 corner : shape.corners) {
        local.add({dot(axis, corner), dot(turned(axis), corner)});
    }
    const glm::vec2 middle = (local.low + local.high) * 0.5F;
    return {axis * middle.x + turned(axis) * middle.y, axis, (local.high - local.low) * 0.5F};
}

Frame frame_of(const Convex& shape) {
    glm::vec2 longest{0.0F, 0.0F};
    for (std::size_t i = 0; i < shape.size(); ++i) {
        const glm::vec2 edge = shape.corner(i + 1) - shape.corner(i);
        longest = dot(edge, edge) > dot(longest, longest) ? edge : longest;
    }
    return frame_along(shape, normalized(longest));
}

Convex rectangle(const Frame& frame) {
    const glm::vec2 h = frame.half;
    return {{frame.at(-h.x, -h.y), frame.at(h.x, -h.y), frame.at(h.x, h.y), frame.at(-h.x, h.y)}};
}

Convex octagon(glm::vec2 center, glm::vec2 half) {
    constexpr float c = 0.41421356F;
    constexpr glm::vec2 unit[8] = {{1.0F, -c}, {1.0F, c},   {c, 1.0F},   {-c, 1.0F},
                                   {-1.0F, c}, {-1.0F, -c}, {-c, -1.0F}, {c, -1.0F}};
    Convex shape;
    for (const glm::vec2 corner : unit) {
        shape.corners.emplace_back(center.x + half.x * corner.x, center.y + half.y * corner.y);
    }
    return shape;
}

std::vector<Convex> lots_of(const Convex& shape, const LotOptions& options, Random& random) {
    std::vector<Convex> lots;
    std::vector<Convex> open{shape};
    while (!open.empty()) {
        const Convex piece = std::move(open.back());
        open.pop_back();
        if (piece.empty()) {
            continue;
        }
        const Frame frame = frame_of(piece).lengthwise();
        if (area(piece) <= options.area || frame.half.x < options.min_width) {
            lots.push_back(piece);
            continue;
        }
        const float place = frame.half.x * 2.0F * options.jitter * (2.0F * random.unit() - 1.0F);
        const HalfPlane side{frame.axis, dot(frame.axis, frame.center) + place};
        open.push_back(clipped(piece, side));
        open.push_back(clipped(piece, side.flipped()));
    }
    return lots;
}

Footprint::Footprint(const Convex& shape) {
    for (std::size_t i = 0; i < shape.size(); ++i) {
        planes.push_back(edge_plane(shape, i));
        bounds.add(shape.corners[i]);
    }
}

float Footprint::distance(glm::vec2 point) const {
    float nearest = 1e30F;
    for (const HalfPlane& plane : planes) {
        nearest = std::min(nearest, plane.distance(point));
    }
    return nearest;
}

float Footprint::share(glm::vec2 center, float side) const {
    float inside = 1.0F;
    for (const HalfPlane& plane : planes) {
        inside *= share_inside(plane.normal, plane.distance(center), side);
    }
    return inside;
}

} // namespace reljef::terrains::urban
