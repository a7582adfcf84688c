#include "engine/scene/levels/simplified_mesh.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <meshoptimizer.h>

namespace reljef::scene {
namespace {

using Indices = std::vector<std::uint32_t>;

// The first vertex at the place of each vertex.
Indices first_at_place(const Mesh& mesh) {
    const std::size_t count = mesh.positions.size();
    Indices place_of(count);
    const std::size_t places =
        meshopt_generateVertexRemap(place_of.data(), nullptr, count, mesh.positions.data(), count,
                                    sizeof(mesh.positions.front()));
    Indices first(places, std::numeric_limits<std::uint32_t>::max());
    Indices result(count);
    for (std::uint32_t vertex = 0; vertex < count; ++vertex) {
        std::uint32_t& first_there = first[place_of[vertex]];
        first_there = std::min(first_there, vertex);
        result[vertex] = first_there;
    }
    return result;
}

Indices collapsed(const Mesh& mesh, const Indices& indices, std::size_t triangles) {
    constexpr float any_error = std::numeric_limits<float>::max();
    Indices left(indices.size());
    left.resize(meshopt_simplify(left.data(), indices.data(), indices.size(),
                                 &mesh.positions.front().x, mesh.positions.size(),
                                 sizeof(mesh.positions.front()), 3 * triangles, any_error,
                                 meshopt_SimplifyLockBorder, nullptr));
    return left;
}

// For each place, by its first vertex, all vertices there.
class Vertices {
public:
    Vertices(const Mesh& mesh, const Indices& first) : mesh_(mesh), begin_(first.size() + 1) {
        for (const std::uint32_t place : first) {
            ++begin_[place + 1];
        }
        for (std::size_t i = 1; i < begin_.size(); ++i) {
            begin_[i] += begin_[i - 1];
        }
        sorted_.resize(first.size());
        Indices next(begin_.begin(), begin_.end() - 1);
        for (std::uint32_t vertex = 0; vertex < first.size(); ++vertex) {
            sorted_[next[first[vertex]]++] = vertex;
        }
    }

    // The one whose normal is nearest to a direction.
    [[nodiscard]] std::uint32_t facing(std::uint32_t place, glm::vec3 direction) const {
        std::uint32_t best = place;
        float best_cosine = -std::numeric_limits<float>::infinity();
        for (std::uint32_t i = begin_[place]; i < begin_[place + 1]; ++i) {
            const float cosine = glm::dot(mesh_.normals[sorted_[i]], direction);
            if (cosine > best_cosine) {
                best = sorted_[i];
                best_cosine = cosine;
            }
        }
        return best;
    }

private:
    const Mesh& mesh_;
    Indices begin_;
    Indices sorted_;
};

void choose_normals(const Mesh& mesh, const Indices& first, Indices& indices) {
    const Vertices vertices(mesh, first);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const glm::vec3 corner = mesh.positions[indices[i]];
        const glm::vec3 across = glm::cross(mesh.positions[indices[i + 1]] - corner,
                                            mesh.positions[indices[i + 2]] - corner);
        for (std::size_t at = i; at < i + 3; ++at) {
            indices[at] = vertices.facing(indices[at], across);
        }
    }
}

// Without the vertices that no triangle has, in the order in which triangles need them.
Mesh with_used_vertices(const Mesh& mesh, Indices indices) {
    constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
    Indices new_of(mesh.positions.size(), unused);
    Mesh made;
    for (std::uint32_t& index : indices) {
        std::uint32_t& vertex = new_of[index];
        if (vertex == unused) {
            vertex = static_cast<std::uint32_t>(made.positions.size());
            made.positions.push_back(mesh.positions[index]);
            made.normals.push_back(mesh.normals[index]);
            made.texture_coordinates.push_back(mesh.texture_coordinates[index]);
        }
        index = vertex;
    }
    made.indices = std::move(indices);
    return made;
}

} // namespace

Mesh simplified_mesh(const Mesh& mesh, std::size_t triangles) {
    if (mesh.indices.empty()) {
        return mesh;
    }
    const Indices first = first_at_place(mesh);
    Indices joined = mesh.indices;
    for (std::uint32_t& index : joined) {
        index = first[index];
    }
    Indices left = collapsed(mesh, joined, triangles);
    choose_normals(mesh, first, left);
    return with_used_vertices(mesh, std::move(left));
}

} // namespace reljef::scene
