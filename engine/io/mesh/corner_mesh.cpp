#include "engine/io/mesh/corner_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::io {
namespace {

using Vertices = std::vector<std::uint32_t>;
template <std::size_t size> using Bits = std::array<std::uint32_t, size>;

std::uint32_t bits_of(float number) {
    return std::bit_cast<std::uint32_t>(number);
}

Bits<3> bits_of(glm::vec3 v) {
    return {bits_of(v.x), bits_of(v.y), bits_of(v.z)};
}

Bits<8> bits_of(const scene::Mesh& mesh, std::uint32_t vertex) {
    const glm::vec3 p = mesh.positions[vertex];
    const glm::vec3 n = mesh.normals[vertex];
    const glm::vec2 t = mesh.texture_coordinates[vertex];
    return {bits_of(p.x), bits_of(p.y), bits_of(p.z), bits_of(n.x),
            bits_of(n.y), bits_of(n.z), bits_of(t.x), bits_of(t.y)};
}

template <std::size_t size> std::uint64_t hash_of(const Bits<size>& bits) {
    std::uint64_t hash = 0;
    for (const std::uint32_t part : bits) {
        hash = (hash ^ part) * 0x9E3779B97F4A7C15U;
        hash ^= hash >> 32U;
    }
    return hash;
}

// Calls take(span) with the vertices of each key; both they and the groups of one hash are ordered.
// Sorts, because strangers may choose keys of one hash.
template <class KeyOf, class Take>
void for_each_group(const Vertices& vertices, KeyOf key_of, Take take) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> hashed;
    hashed.reserve(vertices.size());
    for (const std::uint32_t vertex : vertices) {
        hashed.emplace_back(hash_of(key_of(vertex)), vertex);
    }
    std::sort(hashed.begin(), hashed.end());
    Vertices group;
    for (std::size_t i = 0; i < hashed.size();) {
        group.clear();
        const std::uint64_t hash = hashed[i].first;
        for (; i < hashed.size() && hashed[i].first == hash; ++i) {
            group.push_back(hashed[i].second);
        }
        std::stable_sort(group.begin(), group.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return key_of(a) < key_of(b); });
        for (auto first = group.begin(); first != group.end();) {
            const auto last = std::find_if(
                first, group.end(), [&, key = key_of(*first)](auto v) { return key_of(v) != key; });
            take(std::span<const std::uint32_t>(first, last));
            first = last;
        }
    }
}

// Of each triangle; 0 without area.
std::vector<glm::vec3> triangle_normals(const scene::Mesh& corners) {
    std::vector<glm::vec3> normals;
    normals.reserve(corners.positions.size() / 3);
    for (std::size_t i = 0; i + 2 < corners.positions.size(); i += 3) {
        const glm::dvec3 corner(corners.positions[i]);
        const glm::dvec3 across = glm::cross(glm::dvec3(corners.positions[i + 1]) - corner,
                                             glm::dvec3(corners.positions[i + 2]) - corner);
        const double length = glm::length(across);
        normals.push_back(length > 0.0 && std::isfinite(length) ? glm::vec3(across / length)
                                                                : glm::vec3(0.0F));
    }
    return normals;
}

// Its cell on the six sides of a cube around all directions.
Bits<3> cell_of(glm::vec3 normal) {
    constexpr int cells = 6;
    static_assert(6 * cells * cells == max_corner_directions);
    const glm::vec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto cell = [&](int other) {
        const float across = normal[other] / size[axis]; // size > 0: the normal is not 0
        return static_cast<std::uint32_t>(
            std::min(static_cast<int>((across + 1.0F) * 0.5F * cells), cells - 1));
    };
    const auto side = static_cast<std::uint32_t>(2 * axis + static_cast<int>(normal[axis] < 0.0F));
    return {side, cell((axis + 1) % 3), cell((axis + 2) % 3)};
}

// Triangles around one position that turn the same way.
struct Direction {
    glm::vec3 normal{0.0F};
    glm::vec3 sum{0.0F}; // of the normals of all triangles
    std::vector<std::uint32_t> vertices;
};

using KeyedVertices = std::vector<std::pair<Bits<3>, std::uint32_t>>;

// `normals`: of triangles.
std::vector<Direction> directions_of(KeyedVertices keyed, const std::vector<glm::vec3>& normals) {
    std::sort(keyed.begin(), keyed.end());
    std::vector<Direction> directions;
    for (std::size_t i = 0; i < keyed.size(); ++i) {
        if (i == 0 || keyed[i].first != keyed[i - 1].first) {
            directions.emplace_back();
        }
        directions.back().sum += normals[keyed[i].second / 3];
        directions.back().vertices.push_back(keyed[i].second);
    }
    for (Direction& direction : directions) {
        const float length = glm::length(direction.sum); // > 0: all lie on one side
        direction.normal = length > 0.0F ? direction.sum / length : direction.sum;
    }
    return directions;
}

// `own`: one of the directions.
glm::vec3 smoothed(const Direction& own, const std::vector<Direction>& directions,
                   float min_cosine) {
    glm::vec3 sum(0.0F);
    for (const Direction& other : directions) {
        const bool is_own = &own == &other; // its cosine may be less than 1
        if (is_own || glm::dot(own.normal, other.normal) >= min_cosine) {
            sum += other.sum;
        }
    }
    const float length = glm::length(sum);
    return length > 0.0F ? sum / length : own.normal;
}

// The vertices lie at one position.
void smooth(scene::Mesh& corners, const std::vector<glm::vec3>& normals,
            std::span<const std::uint32_t> vertices, float min_cosine) {
    KeyedVertices keyed;
    for (const std::uint32_t vertex : vertices) {
        const glm::vec3 normal = normals[vertex / 3];
        corners.normals[vertex] = glm::vec3(0.0F);
        if (normal != glm::vec3(0.0F)) {
            keyed.emplace_back(bits_of(normal), vertex);
        }
    }
    std::vector<Direction> directions = directions_of(keyed, normals);
    if (directions.size() > max_corner_directions) {
        for (auto& [key, vertex] : keyed) {
            key = cell_of(normals[vertex / 3]);
        }
        directions = directions_of(std::move(keyed), normals);
    }
    for (const Direction& own : directions) {
        const glm::vec3 normal = smoothed(own, directions, min_cosine);
        for (const std::uint32_t vertex : own.vertices) {
            corners.normals[vertex] = normal;
        }
    }
}

} // namespace

void add_missing_normals(scene::Mesh& corners, float hard_edge) {
    Vertices missing;
    for (std::size_t i = 0; i < corners.normals.size(); ++i) {
        if (!is_normal(corners.normals[i])) {
            missing.push_back(static_cast<std::uint32_t>(i));
        }
    }
    if (missing.empty()) {
        return;
    }
    const std::vector<glm::vec3> normals = triangle_normals(corners);
    const float min_cosine = std::cos(glm::radians(hard_edge));
    for_each_group(
        missing, [&](std::uint32_t vertex) { return bits_of(corners.positions[vertex]); },
        [&](std::span<const std::uint32_t> vertices) {
            smooth(corners, normals, vertices, min_cosine);
        });
}

scene::Mesh joined_corners(const scene::Mesh& corners) {
    Vertices same(corners.positions.size()); // the first equal vertex
    for (std::size_t i = 0; i < same.size(); ++i) {
        same[i] = static_cast<std::uint32_t>(i);
    }
    for_each_group(
        Vertices(same), [&](std::uint32_t vertex) { return bits_of(corners, vertex); },
        [&](std::span<const std::uint32_t> vertices) {
            for (const std::uint32_t vertex : vertices) {
                same[vertex] = vertices.front();
            }
        });
    scene::Mesh joined;
    Vertices place(same.size());
    joined.indices.reserve(same.size());
    for (std::size_t i = 0; i < same.size(); ++i) {
        if (same[i] == i) {
            place[i] = static_cast<std::uint32_t>(joined.positions.size());
            joined.positions.push_back(corners.positions[i]);
            joined.normals.push_back(corners.normals[i]);
            joined.texture_coordinates.push_back(corners.texture_coordinates[i]);
        }
        joined.indices.push_back(place[same[i]]);
    }
    return joined;
}

bool is_normal(glm::vec3 v) {
    const float length = glm::length(v);
    return std::isfinite(length) && length > 0.5F && length < 2.0F;
}

} // namespace reljef::io
