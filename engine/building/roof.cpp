#include "engine/building/roof.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/core/check.h"

namespace reljef::building {
namespace {

using Edge = std::optional<std::size_t>; // of the outline

// Points with dot(normal, p) >= offset.
struct HalfPlane {
    glm::dvec2 normal{0.0};
    double offset = 0.0;

    [[nodiscard]] double distance(glm::dvec2 point) const {
        return glm::dot(normal, point) - offset;
    }
};

struct Part {
    Ring corners;
    std::vector<Edge> edges; // from each corner to the next
};

// Micrometres. Two parts compute a common corner by different sums, which differ by less than the
// 1e-10 m that doubles resolve within 100 km.
glm::dvec2 on_lattice(glm::dvec2 point) {
    constexpr double steps = 1048576.0; // per metre
    return glm::round(point * steps) / steps;
}

// Sutherland & Hodgman 1974; the new edge has no outline edge below.
Part clipped(const Part& part, const HalfPlane& keep) {
    Part kept;
    const std::size_t n = part.corners.size();
    const auto add = [&](glm::dvec2 corner, Edge edge) {
        kept.corners.push_back(corner);
        kept.edges.push_back(edge);
    };
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec2 a = part.corners[i];
        const glm::dvec2 b = part.corners[(i + 1) % n];
        const double from = keep.distance(a);
        const double to = keep.distance(b);
        if (from >= 0.0) {
            add(a, part.edges[i]);
        }
        if ((from >= 0.0) != (to >= 0.0)) {
            add(a + (b - a) * (from / (from - to)), from >= 0.0 ? Edge() : part.edges[i]);
        }
    }
    return kept;
}

// On the lattice, without edges that have no length.
Part cleaned(const Part& part) {
    Part kept;
    const std::size_t n = part.corners.size();
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec2 corner = on_lattice(part.corners[i]);
        if (corner != on_lattice(part.corners[(i + 1) % n])) {
            kept.corners.push_back(corner);
            kept.edges.push_back(part.edges[i]);
        }
    }
    return kept.corners.size() >= 3 && signed_area(kept.corners) > 0.0 ? kept : Part();
}

Part whole(const Ring& outline) {
    Part part{outline, {}};
    for (std::size_t i = 0; i < outline.size(); ++i) {
        part.edges.emplace_back(i);
    }
    return part;
}

// Distance from an edge's line into a counter-clockwise ring.
HalfPlane inside_of(const Ring& ring, std::size_t edge) {
    const glm::dvec2 along = glm::normalize(ring[(edge + 1) % ring.size()] - ring[edge]);
    const glm::dvec2 normal(-along.y, along.x);
    return {normal, glm::dot(normal, ring[edge])};
}

std::vector<std::pair<std::size_t, HalfPlane>> sloped_planes(const Ring& outline,
                                                             const SlopedRoof& roof) {
    std::vector<std::pair<std::size_t, HalfPlane>> planes;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        if (i >= roof.sloped.size() || roof.sloped[i]) {
            planes.emplace_back(i, inside_of(outline, i));
        }
    }
    check(!planes.empty(), "a sloped roof has a sloped edge");
    return planes;
}

// Where `low` is at most `high`; scaled, but no unit length is needed.
HalfPlane nearer_to(const HalfPlane& low, const HalfPlane& high) {
    return {high.normal - low.normal, high.offset - low.offset};
}

HalfPlane at_most(const HalfPlane& plane, double distance) {
    return {-plane.normal, -plane.offset - distance};
}

HalfPlane at_least(const HalfPlane& plane, double distance) {
    return {plane.normal, plane.offset + distance};
}

template <class Height>
void add_part(std::vector<RoofPart>& parts, const Part& part, const Height& height) {
    const Part clean = cleaned(part);
    if (clean.corners.empty()) {
        return;
    }
    RoofPart made;
    for (const glm::dvec2 corner : clean.corners) {
        made.corners.emplace_back(corner, height(corner));
    }
    made.outline_edges = clean.edges;
    parts.push_back(std::move(made));
}

// What is nearer to this edge than to the others.
Part share_of(const Ring& outline, const std::vector<std::pair<std::size_t, HalfPlane>>& planes,
              std::size_t which) {
    Part part = whole(outline);
    for (std::size_t other = 0; other < planes.size(); ++other) {
        if (other != which) {
            part = clipped(part, nearer_to(planes[which].second, planes[other].second));
        }
    }
    return part;
}

// Upright faces on the border of a part, which look into it.
void add_inner_walls(std::vector<RoofPart>& parts, const Part& deck, double height) {
    const Part clean = cleaned(deck);
    const std::size_t n = clean.corners.size();
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec2 a = clean.corners[i];
        const glm::dvec2 b = clean.corners[(i + 1) % n];
        RoofPart wall{{{b, 0.0}, {a, 0.0}, {a, height}, {b, height}}, std::vector<Edge>(4), true};
        parts.push_back(std::move(wall));
    }
}

// Corners of others that lie on an edge of a part become corners of the part, too: then the parts
// fit whatever bends the plane later.
void join_corners(std::vector<RoofPart>& parts) {
    constexpr double on_edge = 4e-6; // metres: the steps of on_lattice() at both ends
    std::vector<glm::dvec3> corners;
    for (const RoofPart& part : parts) {
        corners.insert(corners.end(), part.corners.begin(), part.corners.end());
    }
    const auto is_between = [&](glm::dvec3 a, glm::dvec3 b, glm::dvec3 corner) {
        const double length = glm::distance(a, b);
        const double along = glm::dot(corner - a, b - a) / length;
        return along > on_edge && along < length - on_edge &&
               glm::distance(corner, a + (b - a) * (along / length)) < on_edge;
    };
    for (RoofPart& part : parts) {
        for (std::size_t i = 0; i < part.corners.size(); ++i) {
            const glm::dvec3 next = part.corners[(i + 1) % part.corners.size()];
            const auto found = std::find_if(corners.begin(), corners.end(), [&](glm::dvec3 corner) {
                return is_between(part.corners[i], next, corner);
            });
            if (found != corners.end()) {
                const auto after = static_cast<std::ptrdiff_t>(i) + 1;
                part.corners.insert(part.corners.begin() + after, *found);
                part.outline_edges.insert(part.outline_edges.begin() + after,
                                          part.outline_edges[i]);
                --i; // the first half may hold more
            }
        }
    }
}

} // namespace

double rise_at(const Ring& outline, const SlopedRoof& roof, glm::dvec2 place) {
    double run = std::numeric_limits<double>::infinity();
    for (const auto& [edge, plane] : sloped_planes(outline, roof)) {
        run = std::min(run, plane.distance(place));
    }
    return std::min(roof.max_rise, roof.slope * std::max(0.0, run));
}

double largest_run(const Ring& outline, const SlopedRoof& roof) {
    SlopedRoof unit{1.0, std::numeric_limits<double>::infinity(), roof.sloped};
    double largest = 0.0;
    for (const RoofPart& part : sloped_roof(outline, unit)) {
        for (const glm::dvec3 corner : part.corners) {
            largest = std::max(largest, corner.z);
        }
    }
    return largest;
}

std::vector<RoofPart> sloped_roof(const Ring& outline, const SlopedRoof& roof) {
    check(is_convex(outline) && roof.slope > 0.0, "a sloped roof has a convex outline");
    const auto planes = sloped_planes(outline, roof);
    const double max_run = roof.max_rise / roof.slope;
    std::vector<RoofPart> parts;
    Part flat = whole(outline);
    for (std::size_t which = 0; which < planes.size(); ++which) {
        Part part = share_of(outline, planes, which);
        if (std::isfinite(max_run)) {
            part = clipped(part, at_most(planes[which].second, max_run));
            flat = clipped(flat, at_least(planes[which].second, max_run));
        }
        add_part(parts, part, [&](glm::dvec2 place) { return rise_at(outline, roof, place); });
    }
    if (std::isfinite(max_run)) {
        add_part(parts, flat, [&](glm::dvec2) { return roof.max_rise; });
    }
    return parts;
}

std::vector<RoofPart> roof_with_parapet(const Ring& outline, double width, double height) {
    check(is_convex(outline), "a roof with a parapet has a convex outline");
    const auto planes = sloped_planes(outline, {});
    std::vector<RoofPart> parts;
    Part deck = whole(outline);
    for (std::size_t which = 0; which < planes.size(); ++which) {
        deck = clipped(deck, at_least(planes[which].second, width));
        add_part(parts,
                 clipped(share_of(outline, planes, which), at_most(planes[which].second, width)),
                 [&](glm::dvec2) { return height; });
    }
    add_part(parts, deck, [](glm::dvec2) { return 0.0; });
    add_inner_walls(parts, deck, height);
    return parts;
}

std::vector<RoofPart> without(const std::vector<RoofPart>& parts, const Ring& hole) {
    std::vector<RoofPart> left;
    for (const RoofPart& part : parts) {
        if (part.is_upright) {
            left.push_back(part);
            continue;
        }
        Part rest{{}, part.outline_edges};
        for (const glm::dvec3 corner : part.corners) {
            rest.corners.emplace_back(corner);
        }
        const double height = part.corners.front().z;
        for (std::size_t edge = 0; edge < hole.size(); ++edge) {
            const HalfPlane inside = inside_of(hole, edge);
            add_part(left, clipped(rest, at_most(inside, 0.0)), [&](glm::dvec2) { return height; });
            rest = clipped(rest, inside);
        }
    }
    join_corners(left);
    return left;
}

std::vector<RoofPart> divided(const std::vector<RoofPart>& parts, double max_length) {
    std::vector<RoofPart> made;
    for (const RoofPart& part : parts) {
        RoofPart fine{{}, {}, part.is_upright};
        for (std::size_t i = 0; i < part.corners.size(); ++i) {
            const glm::dvec3 from = part.corners[i];
            const glm::dvec3 way = part.corners[(i + 1) % part.corners.size()] - from;
            const double length = glm::length(way);
            const int pieces =
                part.outline_edges[i] ? clamped_int(std::ceil(length / max_length), 1, 10'000) : 1;
            for (int k = 0; k < pieces; ++k) {
                fine.corners.push_back(from + way * (static_cast<double>(k) / pieces));
                fine.outline_edges.push_back(part.outline_edges[i]);
            }
        }
        made.push_back(std::move(fine));
    }
    return made;
}

} // namespace reljef::building
