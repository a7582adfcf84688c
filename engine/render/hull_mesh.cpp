#include "engine/render/hull_mesh.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>

namespace reljef::render {
namespace {

struct HullCorner {
    glm::vec4 place{0.0F};
    glm::vec2 coordinate{0.0F};
    glm::vec3 normal{0.0F};
};

// What the mesh's vertices are moved by.
struct HullHeights {
    double lift = 0.0;   // metres that a height of 1 lifts a point
    double offset = 0.0; // of the heights against the mesh
};

HullCorner hull_corner(const scene::Mesh& mesh, std::uint32_t vertex, double height,
                       const HullHeights& heights) {
    const glm::dvec3 moved =
        glm::dvec3(mesh.positions[vertex]) +
        (height + heights.offset) * heights.lift * glm::dvec3(mesh.normals[vertex]);
    return {glm::vec4(glm::vec3(moved), static_cast<float>(height)),
            mesh.texture_coordinates[vertex], mesh.normals[vertex]};
}

// In an order that does not hang on the triangle: so neighbours cut the side they share alike.
std::array<std::uint32_t, 3> by_place(const scene::Mesh& mesh, std::size_t first) {
    std::array<std::uint32_t, 3> corners{mesh.indices[first], mesh.indices[first + 1],
                                         mesh.indices[first + 2]};
    const auto key = [&](std::uint32_t vertex) {
        const glm::vec3& p = mesh.positions[vertex];
        return std::tuple(p.x, p.y, p.z);
    };
    std::sort(corners.begin(), corners.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    return corners;
}

// Six times the volume; positive where the other corners are clockwise from corner 0.
double volume(const std::array<HullCorner, 4>& part) {
    const auto from_first = [&](std::size_t corner) {
        return glm::dvec3(part[corner].place) - glm::dvec3(part[0].place);
    };
    return glm::dot(from_first(1), glm::cross(from_first(2), from_first(3)));
}

void add_part(std::array<HullCorner, 4> part, std::vector<HullPart>& hull) {
    const double size = volume(part);
    if (!std::isnormal(static_cast<float>(size))) {
        return;
    }
    if (size < 0.0) {
        std::swap(part[2], part[3]);
    }
    HullPart added{};
    for (std::size_t i = 0; i < 4; ++i) {
        added.corners[i] = part[i].place;
        added.normals[i] = part[i].normal;
    }
    added.coordinates = {glm::vec4(part[0].coordinate, part[1].coordinate),
                         glm::vec4(part[2].coordinate, part[3].coordinate)};
    hull.push_back(added);
}

} // namespace

std::vector<HullPart> hull_parts(const scene::Mesh& mesh, const scene::TextureDetail& detail) {
    const HullHeights heights{scene::relief_height(mesh, detail),
                              static_cast<double>(detail.offset)};
    std::vector<HullPart> hull;
    for (std::size_t first = 0; first + 2 < mesh.indices.size(); first += 3) {
        const auto vertices = by_place(mesh, first);
        std::array<HullCorner, 3> low;
        std::array<HullCorner, 3> high;
        for (std::size_t i = 0; i < 3; ++i) {
            low[i] = hull_corner(mesh, vertices[i], -scene::hull_margin, heights);
            high[i] = hull_corner(mesh, vertices[i], 1.0 + scene::hull_margin, heights);
        }
        add_part({low[0], low[1], low[2], high[2]}, hull);
        add_part({low[0], low[1], high[1], high[2]}, hull);
        add_part({low[0], high[0], high[1], high[2]}, hull);
    }
    return hull;
}

} // namespace reljef::render
