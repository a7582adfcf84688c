#include "engine/scene/levels/mesh_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

// The distance to a triangle is a convex function of the point, so its largest value over a convex
// piece of a plane is that of a corner. So each triangle of the one mesh is cut into pieces until
// one triangle of the other mesh is near enough to all corners of a piece. The largest of these
// distances bounds that between the meshes.

namespace reljef::scene {
namespace {

constexpr double accuracy = 1.125;
// Of a triangle; beyond them, pieces are not divided again. The bound is looser then.
constexpr int max_pieces = 4096;
constexpr int block_triangles = 512;
const double min_cosine = std::cos(0.2); // of normals that look alike

using Corners = std::array<glm::dvec3, 3>;

// A convex polygon, but for rounding: a cut may give a corner at each side, so there is room for
// twice as many.
struct Piece {
    static constexpr std::size_t max_cut = 16; // corners
    std::array<glm::dvec3, 2 * max_cut> corners;
    std::size_t count = 0;

    void add(glm::dvec3 corner) { corners[count++] = corner; }
    [[nodiscard]] bool may_be_cut() const { return count <= max_cut; }
};

Piece whole(const Corners& triangle) {
    Piece piece;
    for (const glm::dvec3& corner : triangle) {
        piece.add(corner);
    }
    return piece;
}

glm::dvec3 middle_of(const Piece& piece) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < piece.count; ++i) {
        sum += piece.corners[i];
    }
    return sum / static_cast<double>(piece.count);
}

double distance_to(const Corners& triangle, glm::dvec3 point) {
    return glm::distance(point, nearest_point(triangle, point));
}

double largest_distance(const Piece& piece, const Corners& triangle) {
    double largest = 0.0;
    for (std::size_t i = 0; i < piece.count; ++i) {
        largest = std::max(largest, distance_to(triangle, piece.corners[i]));
    }
    return largest;
}

struct Plane {
    glm::dvec3 normal; // unit length, or 0: cuts nothing
    glm::dvec3 origin;
};

Plane plane_through(glm::dvec3 origin, glm::dvec3 across) {
    const double length = glm::length(across);
    return {length > 0.0 ? across / length : glm::dvec3(0.0), origin};
}

struct Parts {
    Piece inside; // against the normal
    Piece outside;
};

// Empty if the plane does not pass through the piece, by `resolution` metres at least.
std::optional<Parts> cut(const Piece& piece, const Plane& plane, double resolution) {
    Parts parts;
    const auto height = [&](std::size_t i) {
        return glm::dot(piece.corners[i] - plane.origin, plane.normal);
    };
    double lowest = 0.0;
    double highest = 0.0;
    for (std::size_t i = 0; i < piece.count; ++i) {
        lowest = std::min(lowest, height(i));
        highest = std::max(highest, height(i));
    }
    if (!(lowest < -resolution && highest > resolution)) {
        return std::nullopt;
    }
    for (std::size_t i = 0; i < piece.count; ++i) {
        const std::size_t next = (i + 1) % piece.count;
        const double here = height(i);
        const double there = height(next);
        if (here <= 0.0) {
            parts.inside.add(piece.corners[i]);
        }
        if (here >= 0.0) {
            parts.outside.add(piece.corners[i]);
        }
        if ((here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0)) {
            const glm::dvec3 between =
                glm::mix(piece.corners[i], piece.corners[next], here / (here - there));
            parts.inside.add(between);
            parts.outside.add(between);
        }
    }
    return parts;
}

// Across the longest line between two corners.
Plane halving_plane(const Piece& piece) {
    glm::dvec3 longest(0.0);
    for (std::size_t i = 0; i < piece.count; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const glm::dvec3 line = piece.corners[i] - piece.corners[j];
            longest = glm::dot(line, line) > glm::dot(longest, longest) ? line : longest;
        }
    }
    return plane_through(middle_of(piece), longest);
}

// Through the edges of a triangle, perpendicular to it; normals point away from it.
std::array<Plane, 3> sides_of(const Corners& triangle) {
    const glm::dvec3 across = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
    std::array<Plane, 3> planes;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 edge = triangle[(i + 1) % 3] - triangle[i];
        planes[i] = plane_through(triangle[i], glm::cross(edge, across));
    }
    return planes;
}

// The part over a triangle and those beside it; both halves if no side of it cuts the piece. False
// if the piece is too small.
bool divide(const Piece& piece, const Corners& triangle, double resolution,
            std::vector<Piece>& open) {
    Piece rest = piece;
    const std::size_t before = open.size();
    for (const Plane& side : sides_of(triangle)) {
        if (const auto parts = rest.may_be_cut() ? cut(rest, side, resolution) : std::nullopt) {
            open.push_back(parts->outside);
            rest = parts->inside;
        }
    }
    if (open.size() > before) {
        open.push_back(rest);
        return true;
    }
    const auto halves = cut(piece, halving_plane(piece), resolution);
    if (halves) {
        open.insert(open.end(), {halves->inside, halves->outside});
    }
    return halves.has_value();
}

// Metres, as `enough` and `resolution`.
struct Goal {
    double enough = 0.0;
    double resolution = 0.0;
};

// What the triangles of a block share: room for pieces, and the triangle that was nearest last.
struct Search {
    std::vector<Piece> open;
    std::size_t nearest = 0;
};

double max_distance_of(const Corners& triangle, const MeshTree& to, const Goal& goal,
                       Search& search) {
    auto& [open, nearest] = search;
    double largest = 0.0;
    int pieces = 0;
    open.assign(1, whole(triangle));
    while (!open.empty()) {
        const Piece piece = open.back();
        open.pop_back();
        const glm::dvec3 middle = middle_of(piece);
        nearest = to.nearest_triangle(middle, nearest);
        const Corners other = triangle_corners(to.mesh(), nearest);
        const double bound = largest_distance(piece, other);
        const bool is_near =
            bound <= std::max({goal.enough, largest, accuracy * distance_to(other, middle)});
        const bool is_divided = !is_near && ++pieces <= max_pieces && piece.may_be_cut() &&
                                divide(piece, other, goal.resolution, open);
        largest = is_divided ? largest : std::max(largest, bound);
    }
    return largest;
}

// What floats of a mesh's places resolve: pieces need no smaller distance; metres.
double resolution_of(const Mesh& mesh) {
    const Box bounds = bounds_of(mesh);
    const glm::dvec3 largest = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    return std::max({largest.x, largest.y, largest.z}) * 0x1p-24;
}

double longest_edge(const Corners& triangle) {
    return std::max({glm::distance(triangle[0], triangle[1]),
                     glm::distance(triangle[1], triangle[2]),
                     glm::distance(triangle[2], triangle[0])});
}

// Between those of the corners, unit length; `place` is in the triangle.
glm::dvec3 normal_at(const Mesh& mesh, std::size_t first, const Corners& corners,
                     glm::dvec3 place) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < 3; ++i) {
        const double share =
            glm::length(glm::cross(corners[(i + 1) % 3] - place, corners[(i + 2) % 3] - place));
        sum += share * glm::dvec3(mesh.normals[mesh.indices[first + i]]);
    }
    const double length = glm::length(sum);
    return length > 0.0 ? sum / length : glm::dvec3(mesh.normals[mesh.indices[first]]);
}

// The largest result of `measure(begin, end)` for the items [0, count) in blocks. Empty if stopped.
template <class Measure>
std::optional<double> largest_of(std::size_t count, const Measure& measure,
                                 const ParallelOptions& options) {
    const std::size_t blocks = (count + block_triangles - 1) / block_triangles;
    std::vector<double> largest(blocks, 0.0);
    const auto measure_block = [&](int block) {
        const auto first = static_cast<std::size_t>(block) * block_triangles;
        largest[static_cast<std::size_t>(block)] =
            measure(first, std::min(first + block_triangles, count));
    };
    if (!parallel_for(static_cast<int>(blocks), measure_block, options)) {
        return std::nullopt;
    }
    return blocks == 0 ? 0.0 : *std::max_element(largest.begin(), largest.end());
}

// Of the corners of triangles only: a lower bound.
std::optional<double> max_distance_of_corners(const Mesh& from, const MeshTree& to,
                                              const ParallelOptions& options) {
    std::vector<bool> is_corner(from.positions.size());
    for (const std::uint32_t index : from.indices) {
        is_corner[index] = true;
    }
    const auto measure = [&](std::size_t begin, std::size_t end) {
        double largest = 0.0;
        std::size_t nearest = 0;
        for (std::size_t i = begin; i < end; ++i) {
            if (!is_corner[i]) {
                continue;
            }
            const glm::dvec3 place(from.positions[i]);
            nearest = to.nearest_triangle(place, nearest);
            largest = std::max(largest, distance_to(triangle_corners(to.mesh(), nearest), place));
        }
        return largest;
    };
    return largest_of(from.positions.size(), measure, options);
}

} // namespace

std::optional<double> max_distance(const Mesh& from, const MeshTree& to, double enough,
                                   const ParallelOptions& options) {
    const double resolution = std::max(resolution_of(from), resolution_of(to.mesh()));
    const auto measure = [&](std::size_t begin, std::size_t end) {
        Search search;
        double largest = std::max(enough, resolution);
        double found = 0.0;
        for (std::size_t i = begin; i < end; ++i) {
            found = std::max(found, max_distance_of(triangle_corners(from, 3 * i), to,
                                                    {largest, resolution}, search));
            largest = std::max(largest, found);
        }
        return found;
    };
    const auto found = largest_of(from.indices.size() / 3, measure, options);
    return found ? std::optional(*found + resolution) : found; // rounding is less
}

std::optional<double> max_distance_between(const Mesh& a, const Mesh& b,
                                           const ParallelOptions& options) {
    const MeshTree tree_of_a(a);
    const MeshTree tree_of_b(b);
    const auto of_corners = max_distance_of_corners(a, tree_of_b, options);
    if (!of_corners) {
        return std::nullopt;
    }
    const double enough = accuracy * *of_corners;
    const auto there = max_distance(a, tree_of_b, enough, options);
    const auto back = there ? max_distance(b, tree_of_a, std::max(enough, *there), options) : there;
    return back ? std::optional(std::max(*there, *back)) : back;
}

std::optional<double> width_of_other_normals(const Mesh& fine, const Mesh& coarse,
                                             const ParallelOptions& options) {
    const MeshTree tree(coarse);
    const auto measure = [&](std::size_t begin, std::size_t end) {
        double widest = 0.0;
        std::size_t nearest = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const Corners corners = triangle_corners(fine, 3 * i);
            const glm::dvec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            nearest = tree.nearest_triangle(middle, nearest);
            const Corners other = triangle_corners(coarse, nearest);
            const double width = longest_edge(other);
            if (width > widest && glm::dot(normal_at(fine, 3 * i, corners, middle),
                                           normal_at(coarse, nearest, other,
                                                     nearest_point(other, middle))) < min_cosine) {
                widest = width;
            }
        }
        return widest;
    };
    return largest_of(fine.indices.size() / 3, measure, options);
}

} // namespace reljef::scene
