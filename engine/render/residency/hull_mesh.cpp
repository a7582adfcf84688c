#include "engine/render/residency/hull_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/mat2x3.hpp>
#include <glm/matrix.hpp>

namespace reljef::render {
namespace {

using Places = std::vector<scene::SharedPlace>;

struct HullCorner {
    glm::vec4 place{0.0F};
    glm::vec2 coordinate{0.0F};
    glm::vec3 normal{0.0F};
    std::uint32_t index = 0; // of the SharedPlace
};

struct HullHeights {
    double lift = 0.0;   // height of 1, metres
    double offset = 0.0; // added to the heights
};

// By the indices of the end places, ascending.
using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge edge_between(std::uint32_t one, std::uint32_t other) {
    return std::minmax(one, other);
}

// Edges on which the normals of their triangles differ.
std::set<Edge> hard_edges(const scene::Mesh& mesh, const Places& places) {
    std::map<Edge, std::pair<glm::vec3, glm::vec3>> normals; // at the first and the second end
    std::set<Edge> hard;
    for (std::size_t i = 0; i < mesh.indices.size() / 3 * 3; ++i) {
        const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
        std::uint32_t one = mesh.indices[i];
        std::uint32_t other = mesh.indices[next];
        if (places[other].index < places[one].index) {
            std::swap(one, other);
        }
        const std::pair found(mesh.normals[one], mesh.normals[other]);
        const Edge edge(places[one].index, places[other].index);
        if (normals.emplace(edge, found).first->second != found) {
            hard.insert(edge);
        }
    }
    return hard;
}

// Each vertex moves along its own normal; gaps at hard edges stay open.
Places upright_places(const scene::Mesh& mesh) {
    Places places = scene::shared_places(mesh);
    for (std::size_t i = 0; i < places.size(); ++i) {
        places[i].direction = glm::dvec3(mesh.normals[i]);
    }
    return places;
}

// Gradient of a triangle's texture coordinates in its plane.
glm::dmat3x2 coordinate_slopes(const scene::Mesh& mesh, std::size_t first) {
    const scene::TriangleEdges edges = scene::triangle_edges(mesh, first);
    const glm::dmat2x3 ways(edges.p, edges.q);
    const glm::dmat3x2 along = glm::transpose(ways);
    const glm::dmat2 products = along * ways;
    return std::isnormal(glm::determinant(products))
               ? glm::dmat2(edges.s, edges.t) * glm::inverse(products) * along
               : glm::dmat3x2(0.0);
}

class HullTriangle {
public:
    HullTriangle(const scene::Mesh& mesh, const Places& places, std::size_t first)
        : mesh_(mesh), places_(places), slopes_(coordinate_slopes(mesh, first)) {}

    [[nodiscard]] HullCorner corner(std::uint32_t vertex, double height,
                                    const HullHeights& heights) const {
        const glm::dvec3 normal(mesh_.normals[vertex]);
        const glm::dvec3 direction = places_[vertex].direction;
        const double lift = (height + heights.offset) * heights.lift;
        const glm::dvec3 moved = glm::dvec3(mesh_.positions[vertex]) + lift * direction;
        const glm::dvec2 coordinate =
            glm::dvec2(mesh_.texture_coordinates[vertex]) + slopes_ * (lift * (direction - normal));
        return {glm::vec4(glm::vec3(moved), static_cast<float>(height)), glm::vec2(coordinate),
                mesh_.normals[vertex], places_[vertex].index};
    }

private:
    const scene::Mesh& mesh_;
    const Places& places_;
    glm::dmat3x2 slopes_;
};

// In a global order, so that neighbours cut their shared side equally.
std::array<std::uint32_t, 3> by_place(const scene::Mesh& mesh, const Places& places,
                                      std::size_t first) {
    std::array<std::uint32_t, 3> corners{mesh.indices[first], mesh.indices[first + 1],
                                         mesh.indices[first + 2]};
    std::sort(corners.begin(), corners.end(),
              [&](std::uint32_t a, std::uint32_t b) { return places[a].index < places[b].index; });
    return corners;
}

// Six times the volume; positive where the other corners are clockwise from corner 0.
double volume(const std::array<HullCorner, 4>& part) {
    const auto from_first = [&](std::size_t corner) {
        return glm::dvec3(part[corner].place) - glm::dvec3(part[0].place);
    };
    return glm::dot(from_first(1), glm::cross(from_first(2), from_first(3)));
}

bool is_on_hard_edge(const std::array<HullCorner, 4>& part, std::size_t across,
                     const std::set<Edge>& hard) {
    std::set<std::uint32_t> places;
    for (std::size_t i = 0; i < 4; ++i) {
        if (i != across) {
            places.insert(part[i].index);
        }
    }
    return places.size() == 2 && hard.contains(edge_between(*places.begin(), *places.rbegin()));
}

void add_part(std::array<HullCorner, 4> part, const std::set<Edge>& hard,
              std::vector<HullPart>& hull) {
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
        added.normals[i] = glm::vec4(part[i].normal, is_on_hard_edge(part, i, hard) ? 1.0F : 0.0F);
    }
    added.coordinates = {glm::vec4(part[0].coordinate, part[1].coordinate),
                         glm::vec4(part[2].coordinate, part[3].coordinate)};
    hull.push_back(added);
}

} // namespace

std::vector<HullPart> hull_parts(const scene::Mesh& mesh, const scene::SurfaceDetail& detail) {
    const HullHeights heights{scene::relief_height(mesh, detail),
                              static_cast<double>(detail.offset)};
    const bool ends = detail.border == material::WrapMode::discard;
    const Places places = ends ? upright_places(mesh) : scene::shared_places(mesh);
    const std::set<Edge> hard = ends ? std::set<Edge>() : hard_edges(mesh, places);
    std::vector<HullPart> hull;
    for (std::size_t first = 0; first + 2 < mesh.indices.size(); first += 3) {
        const HullTriangle triangle(mesh, places, first);
        const auto vertices = by_place(mesh, places, first);
        std::array<HullCorner, 3> low;
        std::array<HullCorner, 3> high;
        for (std::size_t i = 0; i < 3; ++i) {
            low[i] = triangle.corner(vertices[i], -scene::hull_margin, heights);
            high[i] = triangle.corner(vertices[i], 1.0 + scene::hull_margin, heights);
        }
        add_part({low[0], low[1], low[2], high[2]}, hard, hull);
        add_part({low[0], low[1], high[1], high[2]}, hard, hull);
        add_part({low[0], high[0], high[1], high[2]}, hard, hull);
    }
    return hull;
}

} // namespace reljef::render
