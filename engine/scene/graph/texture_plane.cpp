#include "engine/scene/graph/texture_plane.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace reljef::scene {
namespace {

// The plane of one triangle; absent where it has no area or no texture coordinates.
std::optional<TexturePlane> plane_of_triangle(const Mesh& mesh, std::size_t first) {
    const auto [corner, p, q, coordinate, s, t] = triangle_edges(mesh, first);
    const double area = s.x * t.y - s.y * t.x;
    const glm::dvec3 across = glm::cross(p, q);
    if (area == 0.0 || glm::length(across) == 0.0) {
        return std::nullopt;
    }
    TexturePlane plane;
    plane.along_u = (t.y * p - s.y * q) / area;
    plane.along_v = (s.x * q - t.x * p) / area;
    plane.origin = corner - coordinate.x * plane.along_u - coordinate.y * plane.along_v;
    plane.normal = glm::normalize(across);
    return plane;
}

bool lies_on(const TexturePlane& plane, const Mesh& mesh, std::size_t vertex, double tolerance) {
    const glm::dvec2 coordinate(mesh.texture_coordinates[vertex]);
    const glm::dvec3 expected =
        plane.origin + coordinate.x * plane.along_u + coordinate.y * plane.along_v;
    return glm::distance(expected, glm::dvec3(mesh.positions[vertex])) <= tolerance;
}

} // namespace

std::optional<TexturePlane> texture_plane(const Mesh& mesh) {
    std::optional<TexturePlane> plane;
    for (std::size_t i = 0; i + 2 < mesh.indices.size() && !plane; i += 3) {
        plane = plane_of_triangle(mesh, i);
    }
    if (!plane) {
        return std::nullopt;
    }
    // Positions and coordinates are floats: a unit in the last place of each, a few times over.
    const glm::dvec3 size = bounds_of(mesh).size();
    const double tolerance = std::ldexp(std::max({size.x, size.y, size.z}), -20);
    plane->low = plane->high = glm::dvec2(mesh.texture_coordinates[mesh.indices.front()]);
    for (const std::uint32_t vertex : mesh.indices) {
        if (!lies_on(*plane, mesh, vertex, tolerance)) {
            return std::nullopt;
        }
        const glm::dvec2 coordinate(mesh.texture_coordinates[vertex]);
        plane->low = glm::min(plane->low, coordinate);
        plane->high = glm::max(plane->high, coordinate);
    }
    return plane;
}

} // namespace reljef::scene
