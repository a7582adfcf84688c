#include "engine/scene/graph/terrain_base.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace reljef::scene {
namespace {

// Of the shorter side of the terrain, below its lowest height.
constexpr double depth_in_sides = 0.04;

// From left to right as seen from outside.
struct Side {
    glm::ivec2 first;
    glm::ivec2 step;
    int count = 0; // samples
};

void add_side(const TerrainSurface& surface, const Side& side, double bottom, Mesh& mesh) {
    const terrain::Placement& placement = surface.placement();
    const Grid<float>& heights = surface.heightfield().heights;
    const auto place = [&](int index, double height) {
        return placement.world_from_sample(
            glm::dvec3(glm::dvec2(side.first + index * side.step), height));
    };
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < side.count; ++i) {
        const glm::ivec2 at = side.first + i * side.step;
        const glm::dvec3 top = place(i, heights(at.x, at.y));
        const glm::dvec3 along =
            place(std::min(i + 1, side.count - 1), 0.0) - place(std::max(i - 1, 0), 0.0);
        const glm::vec3 normal(glm::normalize(glm::cross(along, placement.up(top))));
        for (const glm::dvec3& position : {top, place(i, bottom)}) {
            mesh.positions.emplace_back(position);
            mesh.normals.push_back(normal);
            mesh.texture_coordinates.emplace_back(0.0F);
        }
    }
    for (std::uint32_t i = 0; i + 1 < static_cast<std::uint32_t>(side.count); ++i) {
        const std::uint32_t top = base + 2 * i;
        for (const std::uint32_t index : {top, top + 1, top + 3, top, top + 3, top + 2}) {
            mesh.indices.push_back(index);
        }
    }
}

} // namespace

std::optional<Mesh> terrain_base(const TerrainSurface& surface) {
    const terrain::Heightfield& heightfield = surface.heightfield();
    const glm::ivec2 size(heightfield.heights.cols(), heightfield.heights.rows());
    if (surface.placement().columns_all_around()) {
        return std::nullopt;
    }
    const glm::dvec2 metres = heightfield.spacing * glm::dvec2(size - 1);
    const double bottom = heightfield.range.low - depth_in_sides * std::min(metres.x, metres.y) /
                                                      surface.placement().exaggeration();
    Mesh mesh;
    for (const Side& side :
         {Side{{0, size.y - 1}, {1, 0}, size.x}, Side{{size.x - 1, size.y - 1}, {0, -1}, size.y},
          Side{{size.x - 1, 0}, {-1, 0}, size.x}, Side{{0, 0}, {0, 1}, size.y}}) {
        add_side(surface, side, bottom, mesh);
    }
    return mesh;
}

} // namespace reljef::scene
