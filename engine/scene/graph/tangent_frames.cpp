#include "engine/scene/graph/tangent_frames.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "engine/core/check.h"

namespace reljef::scene {
namespace {

// The directions of u and v, summed over triangles with their areas as weights.
struct Gradients {
    glm::dvec3 tangent{0.0};   // weighted unit vectors
    glm::dvec3 bitangent{0.0}; // weighted unit vectors
    glm::dvec2 metres{0.0};    // weighted metres per unit of u and v
    double weight = 0.0;

    void operator+=(const Gradients& other) {
        tangent += other.tangent;
        bitangent += other.bitangent;
        metres += other.metres;
        weight += other.weight;
    }
};

bool is_length(double length) {
    return std::isfinite(length) && length > 0.0;
}

// Of one triangle; all zero if its corners or texture coordinates have no area.
Gradients gradients_of(const Mesh& mesh, std::size_t first) {
    const auto [corner, p, q, coordinate, s, t] = triangle_edges(mesh, first);
    const double area = glm::length(glm::cross(p, q));
    const double determinant = s.x * t.y - t.x * s.y;
    if (determinant == 0.0) {
        return {};
    }
    const glm::dvec3 along_u = (t.y * p - s.y * q) / determinant;
    const glm::dvec3 along_v = (s.x * q - t.x * p) / determinant;
    const glm::dvec2 metres(glm::length(along_u), glm::length(along_v));
    if (!is_length(area) || !is_length(metres.x) || !is_length(metres.y)) {
        return {};
    }
    return {area * along_u / metres.x, area * along_v / metres.y, area * metres, area};
}

std::vector<Gradients> summed_gradients(const Mesh& mesh) {
    std::vector<Gradients> sums(mesh.positions.size());
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Gradients gradients = gradients_of(mesh, i);
        for (std::size_t k = 0; k < 3; ++k) {
            sums[mesh.indices[i + k]] += gradients;
        }
    }
    return sums;
}

// Any unit vector orthogonal to n (Duff et al. 2017, Building an orthonormal basis, revisited).
glm::dvec3 any_orthogonal(glm::dvec3 n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1.0 / (sign + n.z);
    return {1.0 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

glm::dvec3 unit_normal(glm::vec3 normal) {
    const double length = glm::length(glm::dvec3(normal));
    return is_length(length) ? glm::dvec3(normal) / length : glm::dvec3(0.0, 0.0, 1.0);
}

// Texture coordinates per metre; 0 if a float cannot hold that.
float density_of(double metres) {
    const double density = 1.0 / metres;
    return density <= static_cast<double>(std::numeric_limits<float>::max())
               ? static_cast<float>(density)
               : 0.0F;
}

TangentFrame frame_of(const Gradients& gradients, glm::vec3 vertex_normal) {
    // Then rounding of the normal to floats (2^-24) rotates the tangent by at most 2^-4.
    constexpr double min_share = 0x1p-20;
    const glm::dvec3 normal = unit_normal(vertex_normal);
    const glm::dvec3 across = gradients.tangent - normal * glm::dot(normal, gradients.tangent);
    const double length = glm::length(across);
    if (!(length > min_share * gradients.weight)) {
        return {glm::vec3(any_orthogonal(normal)), 1.0F, glm::vec2(0.0F)};
    }
    const glm::dvec3 tangent = across / length;
    const double side = glm::dot(glm::cross(normal, tangent), gradients.bitangent);
    const glm::dvec2 metres = gradients.metres / gradients.weight;
    return {glm::vec3(tangent),
            side < 0.0 ? -1.0F : 1.0F,
            {density_of(metres.x), density_of(metres.y)}};
}

} // namespace

std::vector<TangentFrame> tangent_frames(const Mesh& mesh) {
    check(mesh.normals.size() == mesh.positions.size() &&
              mesh.texture_coordinates.size() == mesh.positions.size(),
          "a mesh needs a normal and a texture coordinate for every position");
    const std::vector<Gradients> gradients = summed_gradients(mesh);
    std::vector<TangentFrame> frames;
    frames.reserve(gradients.size());
    for (std::size_t i = 0; i < gradients.size(); ++i) {
        frames.push_back(frame_of(gradients[i], mesh.normals[i]));
    }
    return frames;
}

} // namespace reljef::scene
