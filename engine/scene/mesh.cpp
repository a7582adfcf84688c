#include "engine/scene/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/core/grid_triangles.h"

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
        mesh.texture_coordinates.push_back(t);
    }
    for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) {
        mesh.indices.push_back(first + i);
    }
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
    add_quad(mesh, {low.x, high.y, low.z}, z, x);
    add_quad(mesh, low, z, y);
    add_quad(mesh, {high.x, low.y, low.z}, y, z);
    return mesh;
}

Mesh sphere_mesh(float radius, int segments) {
    Mesh mesh;
    const int around = std::max(segments, 3);
    const int down = std::max(around / 2, 2);
    for (int row = 0; row <= down; ++row) {
        for (int col = 0; col <= around; ++col) {
            const float v = static_cast<float>(row) / static_cast<float>(down);
            const float u = static_cast<float>(col) / static_cast<float>(around);
            // The last column stands exactly where the first does, the poles are points.
            const float angle = col < around ? 2.0F * pi * u : 0.0F;
            const float ring = row > 0 && row < down ? std::sin(pi * v) : 0.0F;
            const glm::vec3 normal{ring * std::cos(angle), ring * std::sin(angle),
                                   std::cos(pi * v)};
            mesh.positions.push_back(radius * normal);
            mesh.normals.push_back(normal);
            mesh.texture_coordinates.emplace_back(u, v);
        }
    }
    mesh.indices = grid_triangles<std::uint32_t>(around, down);
    return mesh;
}

} // namespace reljef::scene
