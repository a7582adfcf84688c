#include "engine/scene/graph/mesh.h"
#include "engine/terrain/mesh/grid_triangles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace reljef::scene {
namespace {

constexpr float pi = 3.14159265F;

void add_quad(Mesh& mesh, glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const glm::vec3 normal = glm::normalize(glm::cross(u, v));
    for (const glm::vec2 t : {glm::vec2(0.0F, 0.0F), glm::vec2(1.0F, 0.0F), glm::vec2(1.0F, 1.0F),
                              glm::vec2(0.0F, 1.0F)}) {
        mesh.positions.push_back(corner + t.x * u + t.y * v);
        mesh.normals.push_back(normal);
        mesh.texture_coordinates.emplace_back(t.x, 1.0F - t.y);
    }
    for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) {
        mesh.indices.push_back(first + i);
    }
}

// Gives the same bits for the first and the last column.
glm::vec2 direction_of(int col, int around) {
    const float u = static_cast<float>(col % around) / static_cast<float>(around);
    return {std::cos(2.0F * pi * u), std::sin(2.0F * pi * u)};
}

// Rows of vertices over (u, v) in [0,1]²: from outside, u points right and v down. The last column
// has the positions of the first. `vertex(direction, row)` gives position and normal.
template <class Vertex> Mesh swept(int around, int down, const Vertex& vertex) {
    Mesh mesh;
    for (int row = 0; row <= down; ++row) {
        for (int col = 0; col <= around; ++col) {
            const float v = static_cast<float>(row) / static_cast<float>(down);
            const float u = static_cast<float>(col) / static_cast<float>(around);
            const std::pair<glm::vec3, glm::vec3> made = vertex(direction_of(col, around), row);
            mesh.positions.push_back(made.first);
            mesh.normals.push_back(made.second);
            mesh.texture_coordinates.emplace_back(u, v);
        }
    }
    mesh.indices = terrain::grid_triangles<std::uint32_t>(around, down);
    return mesh;
}

// The disc that closes a cylinder; `up` is 1 at the top and -1 at the bottom.
void add_disc(Mesh& mesh, float radius, float height, int around, float up) {
    const glm::vec2 density(1.0F / (2.0F * pi * radius), 1.0F / height);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto add = [&](glm::vec2 place) {
        mesh.positions.emplace_back(place, 0.5F * up * height);
        mesh.normals.emplace_back(0.0F, 0.0F, up);
        mesh.texture_coordinates.push_back(0.5F + glm::vec2(place.x, -up * place.y) * density);
    };
    add(glm::vec2(0.0F));
    for (int col = 0; col < around; ++col) {
        add(radius * direction_of(col, around));
    }
    for (std::uint32_t col = 0; col < static_cast<std::uint32_t>(around); ++col) {
        const std::uint32_t one = first + 1 + col;
        const std::uint32_t next = first + 1 + (col + 1) % static_cast<std::uint32_t>(around);
        for (const std::uint32_t index : {first, up > 0.0F ? one : next, up > 0.0F ? next : one}) {
            mesh.indices.push_back(index);
        }
    }
}

// Empty if the triangle has no area or no texture coordinates.
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

// For what rounding leaves of lines and points.
glm::dvec3 nearest_corner(const std::array<glm::dvec3, 3>& triangle, glm::dvec3 point) {
    return *std::min_element(triangle.begin(), triangle.end(),
                             [&](const glm::dvec3& one, const glm::dvec3& other) {
                                 return glm::distance(one, point) < glm::distance(other, point);
                             });
}

} // namespace

Box bounds_of(const Mesh& mesh) {
    Box box;
    for (const glm::vec3& position : mesh.positions) {
        box.add(glm::dvec3(position));
    }
    return box;
}

Mesh box_mesh(glm::vec3 size) {
    Mesh mesh;
    const glm::vec3 low = -0.5F * size;
    const glm::vec3 high = 0.5F * size;
    const glm::vec3 x{size.x, 0.0F, 0.0F};
    const glm::vec3 y{0.0F, size.y, 0.0F};
    const glm::vec3 z{0.0F, 0.0F, size.z};
    add_quad(mesh, low, y, x);
    add_quad(mesh, {low.x, low.y, high.z}, x, y);
    add_quad(mesh, low, x, z);
    add_quad(mesh, {high.x, high.y, low.z}, -x, z);
    add_quad(mesh, {low.x, high.y, low.z}, -y, z);
    add_quad(mesh, {high.x, low.y, low.z}, y, z);
    return mesh;
}

TriangleEdges triangle_edges(const Mesh& mesh, std::size_t first) {
    const std::uint32_t a = mesh.indices[first];
    const std::uint32_t b = mesh.indices[first + 1];
    const std::uint32_t c = mesh.indices[first + 2];
    TriangleEdges edges;
    edges.corner = glm::dvec3(mesh.positions[a]);
    edges.p = glm::dvec3(mesh.positions[b]) - edges.corner;
    edges.q = glm::dvec3(mesh.positions[c]) - edges.corner;
    edges.coordinate = glm::dvec2(mesh.texture_coordinates[a]);
    edges.s = glm::dvec2(mesh.texture_coordinates[b]) - edges.coordinate;
    edges.t = glm::dvec2(mesh.texture_coordinates[c]) - edges.coordinate;
    return edges;
}

std::array<glm::dvec3, 3> triangle_corners(const Mesh& mesh, std::size_t first) {
    return {glm::dvec3(mesh.positions[mesh.indices[first]]),
            glm::dvec3(mesh.positions[mesh.indices[first + 1]]),
            glm::dvec3(mesh.positions[mesh.indices[first + 2]])};
}

// By the part of the plane over which a point lies (Ericson 2005, "Real-Time Collision Detection",
// 5.1.5).
glm::dvec3 nearest_point(const std::array<glm::dvec3, 3>& triangle, glm::dvec3 point) {
    const auto& [a, b, c] = triangle;
    const glm::dvec3 ab = b - a;
    const glm::dvec3 ac = c - a;
    const double ab_from_a = glm::dot(ab, point - a);
    const double ac_from_a = glm::dot(ac, point - a);
    if (ab_from_a <= 0.0 && ac_from_a <= 0.0) {
        return a;
    }
    const double ab_from_b = glm::dot(ab, point - b);
    const double ac_from_b = glm::dot(ac, point - b);
    if (ab_from_b >= 0.0 && ac_from_b <= ab_from_b) {
        return b;
    }
    const double ab_from_c = glm::dot(ab, point - c);
    const double ac_from_c = glm::dot(ac, point - c);
    if (ac_from_c >= 0.0 && ab_from_c <= ac_from_c) {
        return c;
    }
    const double over_c = ab_from_a * ac_from_b - ab_from_b * ac_from_a;
    if (over_c <= 0.0 && ab_from_a > 0.0 && ab_from_b <= 0.0) {
        return a + ab_from_a / (ab_from_a - ab_from_b) * ab;
    }
    const double over_b = ab_from_c * ac_from_a - ab_from_a * ac_from_c;
    if (over_b <= 0.0 && ac_from_a > 0.0 && ac_from_c <= 0.0) {
        return a + ac_from_a / (ac_from_a - ac_from_c) * ac;
    }
    const double over_a = ab_from_b * ac_from_c - ab_from_c * ac_from_b;
    const double to_b = ab_from_c - ac_from_c; // along the edge from b to c
    const double to_c = ac_from_b - ab_from_b;
    if (over_a <= 0.0 && to_c >= 0.0 && to_b >= 0.0 && to_b + to_c > 0.0) {
        return b + to_c / (to_b + to_c) * (c - b);
    }
    const double area = over_a + over_b + over_c;
    if (!(area > 0.0)) {
        return nearest_corner(triangle, point);
    }
    const double to_corner_b = glm::clamp(over_b / area, 0.0, 1.0); // rounding leaves needles
    const double to_corner_c = glm::clamp(over_c / area, 0.0, 1.0 - to_corner_b);
    return a + to_corner_b * ab + to_corner_c * ac;
}

Mesh plane_mesh(glm::vec2 size) {
    Mesh mesh;
    add_quad(mesh, glm::vec3(-0.5F * size, 0.0F), {size.x, 0.0F, 0.0F}, {0.0F, size.y, 0.0F});
    return mesh;
}

Mesh billboard_mesh(glm::vec2 size) {
    Mesh mesh;
    add_quad(mesh, {-0.5F * size.x, 0.0F, -0.5F * size.y}, {size.x, 0.0F, 0.0F},
             {0.0F, 0.0F, size.y});
    mesh.normals.assign(mesh.normals.size(), {0.0F, 0.0F, 1.0F});
    return mesh;
}

Mesh sphere_mesh(float radius, int segments) {
    const int around = std::max(segments, 3);
    const int down = std::max(around / 2, 2);
    return swept(around, down, [&](glm::vec2 direction, int row) {
        const float angle = pi * static_cast<float>(row) / static_cast<float>(down);
        const float ring = row > 0 && row < down ? std::sin(angle) : 0.0F; // poles are points
        const glm::vec3 normal(ring * direction, std::cos(angle));
        return std::pair(radius * normal, normal);
    });
}

Mesh bowl_mesh(float radius, int segments) {
    const int around = std::max(segments, 3);
    const int down = std::max(around / 4, 2);
    return swept(around, down, [&](glm::vec2 direction, int row) {
        const float angle = 0.5F * pi * static_cast<float>(row) / static_cast<float>(down);
        const glm::vec3 normal(row < down ? std::cos(angle) * direction : glm::vec2(0.0F),
                               row > 0 ? -std::sin(angle) : 0.0F);
        return std::pair(radius * normal, normal);
    });
}

Mesh torus_mesh(float ring_radius, float tube_radius, int segments) {
    const int around = std::max(segments, 3);
    const int down = std::max(around / 2, 3);
    return swept(around, down, [&](glm::vec2 direction, int row) {
        const float angle =
            row < down ? 2.0F * pi * static_cast<float>(row) / static_cast<float>(down) : 0.0F;
        const glm::vec3 normal(-std::cos(angle) * direction, std::sin(angle));
        return std::pair(glm::vec3(ring_radius * direction, 0.0F) + tube_radius * normal, normal);
    });
}

Mesh cylinder_mesh(float radius, float height, int segments) {
    const int around = std::max(segments, 3);
    Mesh mesh = swept(around, 1, [&](glm::vec2 direction, int row) {
        const glm::vec3 normal(direction, 0.0F);
        return std::pair(radius * normal + glm::vec3(0.0F, 0.0F, row == 0 ? 0.5F : -0.5F) * height,
                         normal);
    });
    add_disc(mesh, radius, height, around, 1.0F);
    add_disc(mesh, radius, height, around, -1.0F);
    return mesh;
}

std::optional<TexturePlane> texture_plane(const Mesh& mesh) {
    std::optional<TexturePlane> plane;
    for (std::size_t i = 0; i + 2 < mesh.indices.size() && !plane; i += 3) {
        plane = plane_of_triangle(mesh, i);
    }
    if (!plane) {
        return std::nullopt;
    }
    // A few units in the last place of the floats of positions and coordinates.
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
