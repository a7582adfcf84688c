#include "engine/scene/graph/surface_detail.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace reljef::scene {
namespace {

// The longest edge of a triangle, in texels of the heights.
double longest_edge(const Mesh& mesh, std::size_t first, glm::dvec2 texels_per_coordinate) {
    double longest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec2 from(mesh.texture_coordinates[mesh.indices[first + k]]);
        const glm::dvec2 to(mesh.texture_coordinates[mesh.indices[first + (k + 1) % 3]]);
        longest = std::max(longest, glm::length((to - from) * texels_per_coordinate));
    }
    return longest;
}

// Interpolates at (i, j, k)/n. All triangles of an edge get the same bits, because the products
// with its two corners are exact and addition commutes.
template <class V>
V between(const std::vector<V>& values, std::span<const std::uint32_t, 3> corners,
          glm::ivec3 parts) {
    glm::vec<V::length(), double> sum(0.0);
    for (int k = 0; k < 3; ++k) {
        sum += static_cast<double>(parts[k]) *
               glm::vec<V::length(), double>(values[corners[static_cast<std::size_t>(k)]]);
    }
    return V(sum / static_cast<double>(parts.x + parts.y + parts.z));
}

void add_cut_triangle(const Mesh& mesh, std::size_t index, int n, Mesh& fine) {
    const std::span<const std::uint32_t, 3> corners(&mesh.indices[index], 3);
    const auto first = static_cast<std::uint32_t>(fine.positions.size());
    for (int row = 0; row <= n; ++row) {
        for (int col = 0; col <= row; ++col) {
            const glm::ivec3 parts(n - row, row - col, col);
            fine.positions.push_back(between(mesh.positions, corners, parts));
            fine.normals.push_back(glm::normalize(between(mesh.normals, corners, parts)));
            fine.texture_coordinates.push_back(between(mesh.texture_coordinates, corners, parts));
        }
    }
    const auto vertex = [&](int row, int col) {
        return first + static_cast<std::uint32_t>(row * (row + 1) / 2 + col);
    };
    for (int row = 0; row < n; ++row) {
        for (int col = 0; col <= row; ++col) {
            fine.indices.insert(fine.indices.end(),
                                {vertex(row, col), vertex(row + 1, col), vertex(row + 1, col + 1)});
            if (col < row) {
                fine.indices.insert(fine.indices.end(), {vertex(row, col), vertex(row + 1, col + 1),
                                                         vertex(row, col + 1)});
            }
        }
    }
}

// The vertices in an order that groups equal positions.
std::vector<std::size_t> ordered_by_place(const std::vector<glm::vec3>& positions) {
    std::vector<std::size_t> order(positions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto key = [&](std::size_t i) {
        const glm::vec3& p = positions[i];
        return std::tuple(p.x, p.y, p.z);
    };
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
    return order;
}

// The displacement of vertices at one place by height 1: the same distance along each of their
// normals, so that faces stay joined. Follows one normal if they point in opposite directions.
glm::dvec3 shared_direction(const Mesh& mesh, std::span<const std::size_t> vertices) {
    std::vector<glm::vec3> normals;
    glm::dvec3 sum(0.0);
    for (const std::size_t vertex : vertices) {
        const glm::vec3& normal = mesh.normals[vertex];
        if (std::find(normals.begin(), normals.end(), normal) == normals.end()) {
            normals.push_back(normal);
            sum += glm::dvec3(normal);
        }
    }
    constexpr double min_share = 1.0 / (max_lift * max_lift); // of a normal's length, squared
    const glm::dvec3 mean = sum / static_cast<double>(normals.size());
    const double share = glm::dot(mean, mean);
    return share > 0.0 ? mean / std::max(share, min_share) : glm::dvec3(normals.front());
}

// Calls `visit` with the vertices at each place.
template <class Visit> void visit_places(const Mesh& mesh, const Visit& visit) {
    const std::vector<std::size_t> order = ordered_by_place(mesh.positions);
    for (auto begin = order.begin(); begin != order.end();) {
        const auto end = std::find_if(begin, order.end(), [&](std::size_t vertex) {
            return mesh.positions[vertex] != mesh.positions[*begin];
        });
        visit(std::span(begin, end));
        begin = end;
    }
}

} // namespace

double tile_width(const Mesh& mesh, glm::vec2 repeats) {
    // Twice the area of the mesh, in metres² and in texture coordinates.
    double surface_area = 0.0;
    double texture_area = 0.0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const auto [corner, p, q, coordinate, s, t] = triangle_edges(mesh, i);
        surface_area += glm::length(glm::cross(p, q));
        texture_area += std::abs(s.x * t.y - s.y * t.x);
    }
    const double tiles = texture_area * static_cast<double>(repeats.x) * repeats.y;
    return tiles > 0.0 ? std::sqrt(surface_area / tiles) : 0.0;
}

double relief_height(const Mesh& mesh, const SurfaceDetail& detail) {
    return static_cast<double>(detail.scale) * tile_width(mesh, detail.repeats);
}

double raised_above(const Mesh& mesh, const SurfaceDetail& detail) {
    return max_lift * (1.0 + detail.offset) * relief_height(mesh, detail);
}

double hull_reach(const Mesh& mesh, const SurfaceDetail& detail) {
    const auto offset = static_cast<double>(detail.offset);
    return max_lift * (std::max(1.0 + offset, -offset) + hull_margin) * relief_height(mesh, detail);
}

Mesh tessellated(const Mesh& mesh, int n) {
    check(n >= 1, "a mesh cut into no parts");
    Mesh fine;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        add_cut_triangle(mesh, i, n, fine);
    }
    return fine;
}

int cuts_for(const Mesh& mesh, const SurfaceDetail& detail, double texels) {
    const Grid<float>& heights = detail.set->heights;
    const glm::dvec2 texels_per_coordinate =
        glm::dvec2(detail.repeats) * glm::dvec2(heights.cols(), heights.rows());
    double longest = 0.0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        longest = std::max(longest, longest_edge(mesh, i, texels_per_coordinate));
    }
    const std::size_t triangles = std::max<std::size_t>(mesh.indices.size() / 3, 1);
    const double max_cuts =
        std::sqrt(static_cast<double>(max_displaced_triangles) / static_cast<double>(triangles));
    return static_cast<int>(std::clamp(std::ceil(longest / texels), 1.0, std::max(max_cuts, 1.0)));
}

std::vector<glm::vec3> displaced_positions(const Mesh& mesh, const SurfaceDetail& detail) {
    const double lift = relief_height(mesh, detail);
    const auto height_of = [&](std::size_t vertex) {
        const glm::dvec2 coordinate =
            glm::dvec2(mesh.texture_coordinates[vertex]) * glm::dvec2(detail.repeats);
        return tile_height(*detail.set, coordinate, detail.border);
    };
    std::vector<glm::vec3> positions = mesh.positions;
    visit_places(mesh, [&](std::span<const std::size_t> vertices) {
        double sum = 0.0;
        for (const std::size_t vertex : vertices) {
            sum += height_of(vertex);
        }
        const double height = sum / static_cast<double>(vertices.size());
        const glm::dvec3 way = (height + detail.offset) * lift * shared_direction(mesh, vertices);
        for (const std::size_t vertex : vertices) {
            positions[vertex] += glm::vec3(way);
        }
    });
    return positions;
}

std::vector<SharedPlace> shared_places(const Mesh& mesh) {
    std::vector<SharedPlace> places(mesh.positions.size());
    std::uint32_t index = 0;
    visit_places(mesh, [&](std::span<const std::size_t> vertices) {
        const glm::dvec3 direction = shared_direction(mesh, vertices);
        for (const std::size_t vertex : vertices) {
            places[vertex] = {index, direction};
        }
        ++index;
    });
    return places;
}

double tile_height(const material::ReliefMaterial& set, glm::dvec2 coordinate,
                   material::WrapMode border) {
    const Grid<float>& heights = set.heights;
    const glm::ivec2 size(heights.cols(), heights.rows());
    const glm::dvec2 place = coordinate * glm::dvec2(size) - 0.5;
    const glm::ivec2 cell(glm::floor(place));
    const glm::dvec2 part = place - glm::dvec2(cell);
    const auto at = [&](int right, int down) {
        return static_cast<double>(heights(material::index_beyond(cell.x + right, size.x, border),
                                           material::index_beyond(cell.y + down, size.y, border)));
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), part.x), glm::mix(at(0, 1), at(1, 1), part.x),
                    part.y);
}

} // namespace reljef::scene
