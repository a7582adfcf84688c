#include "terrains/gallery/sheet_tiles.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace reljef::terrains {
namespace {

// Of a ring's radius. Equal circles whose planes lean against each other along x cross once over
// and once under one another; so far apart neither those that hang in each other touch, nor those
// of one lean.
constexpr double ring_wire = 0.11;
constexpr double ring_distance = 1.14; // to the next ring of the other ring_lean, along x and y
constexpr double ring_lean = 0.42;     // height over way along x
constexpr double ring_room = 0.02;     // over and under the rings, of the range of heights
constexpr int ring_vertices = 96;      // vertices
constexpr int wire_vertices = 20;

double ring_radius(int rows) {
    return 1.0 / (2.0 * ring_distance * rows);
}

// Half the range of heights, in ring radii.
constexpr double ring_range = (ring_lean + ring_wire) / (1.0 - 2.0 * ring_room);

struct RingMesh {
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> indices;
};

// In ring radii; `way` is the height over the way along x.
glm::dvec3 ring_point(int along, int across, double way) {
    const double turn = 2.0 * std::acos(-1.0);
    const double angle = turn * along / ring_vertices;
    const glm::dvec3 out =
        glm::normalize(glm::dvec3(std::cos(angle), std::sin(angle), way * std::cos(angle)));
    const glm::dvec3 off = glm::normalize(glm::dvec3(-way, 0.0, 1.0));
    const glm::dvec3 middle(std::cos(angle), std::sin(angle), way * std::cos(angle));
    const double wire_angle = turn * across / wire_vertices;
    return middle + ring_wire * (std::cos(wire_angle) * out + std::sin(wire_angle) * off);
}

void add_ring(glm::dvec2 center, double radius, double way, RingMesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int along = 0; along < ring_vertices; ++along) {
        for (int across = 0; across < wire_vertices; ++across) {
            const glm::dvec3 point = ring_point(along, across, way);
            mesh.positions.emplace_back(glm::dvec3(center, 0.5) +
                                        point * glm::dvec3(radius, radius, 0.5 / ring_range));
        }
    }
    const auto vertex = [&](int along, int across) {
        return first + static_cast<std::uint32_t>((along % ring_vertices) * wire_vertices +
                                                  across % wire_vertices);
    };
    for (int along = 0; along < ring_vertices; ++along) {
        for (int across = 0; across < wire_vertices; ++across) {
            for (const std::uint32_t index :
                 {vertex(along, across), vertex(along, across + 1), vertex(along + 1, across),
                  vertex(along + 1, across), vertex(along, across + 1),
                  vertex(along + 1, across + 1)}) {
                mesh.indices.push_back(index);
            }
        }
    }
}

} // namespace

float ring_scale(int rows) {
    return static_cast<float>(2.0 * ring_range * ring_radius(rows));
}

material::LayerMap ring_layers(int rows, int texels) {
    // Off the texels' centres, so that no plumb line meets an edge.
    constexpr double off = 1.0 / 7919.0;
    RingMesh mesh;
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < rows; ++col) {
            const glm::dvec2 middle = (glm::dvec2(col, row) + 0.25 + off) / glm::dvec2(rows);
            add_ring(middle, ring_radius(rows), ring_lean, mesh);
            add_ring(middle + 0.5 / rows, ring_radius(rows), -ring_lean, mesh);
        }
    }
    return material::layers_of_mesh({mesh.positions, mesh.indices}, texels, texels).value().layers;
}

} // namespace reljef::terrains
