#include "engine/scene/streaming/terrain_tile.h"

#include <algorithm>
#include <functional>

#include <glm/geometric.hpp>

#include "engine/core/bilinear.h"

namespace reljef::scene {

glm::dvec2 TerrainTile::vertex_of(glm::ivec2 texel) const {
    return glm::dvec2(texel) * glm::dvec2(cells) / glm::dvec2(albedo.cols() - 1, albedo.rows() - 1);
}

glm::vec3 TerrainTile::normal_at(glm::dvec2 vertex) const {
    return glm::normalize(bilinear(normals, vertex, std::identity()));
}

std::size_t TerrainTile::bytes() const {
    const std::size_t more = albedo.size() - std::min(albedo.size(), normals.size());
    constexpr std::size_t bytes_of_cones = 2 * 2 * sizeof(float); // on the CPU and on the GPU
    return (bytes_per_vertex + (cones != nullptr ? bytes_of_cones : 0)) * normals.size() +
           static_cast<std::size_t>(bytes_per_texel * static_cast<double>(more));
}

} // namespace reljef::scene
