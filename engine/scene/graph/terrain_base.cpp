#include "engine/scene/graph/terrain_base.h"

#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

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
        const double height = heights(at.x, at.y);
        const glm::dvec3 top = place(i, height);
        const glm::dvec3 along =
            place(std::min(i + 1, side.count - 1), 0.0) - place(std::max(i - 1, 0), 0.0);
        const glm::vec3 normal(glm::normalize(glm::cross(along, placement.up(top))));
        for (const glm::dvec3& position : {top, place(i, std::min(bottom, height))}) {
            mesh.positions.emplace_back(position);
            mesh.normals.push_back(normal);
            mesh.texture_coordinates.emplace_back(0.0F);
        }
    }
    const auto is_above = [&](int index) {
        const glm::ivec2 at = side.first + index * side.step;
        return heights(at.x, at.y) > bottom;
    };
    for (int i = 0; i + 1 < side.count; ++i) {
        if (!is_above(i) && !is_above(i + 1)) {
            continue;
        }
        const std::uint32_t top = base + 2 * static_cast<std::uint32_t>(i);
        for (const std::uint32_t index : {top, top + 1, top + 3, top, top + 3, top + 2}) {
            mesh.indices.push_back(index);
        }
    }
}

} // namespace

double block_bottom(const TerrainSurface& surface) {
    const terrain::Heightfield& heightfield = surface.heightfield();
    const glm::dvec2 metres = heightfield.spacing * glm::dvec2(heightfield.heights.cols() - 1,
                                                               heightfield.heights.rows() - 1);
    return heightfield.range.low -
           depth_in_sides * std::min(metres.x, metres.y) / surface.placement().exaggeration();
}

std::optional<Mesh> terrain_base(const TerrainSurface& surface, double bottom) {
    const Grid<float>& heights = surface.heightfield().heights;
    const glm::ivec2 size(heights.cols(), heights.rows());
    if (surface.placement().columns_all_around()) {
        return std::nullopt;
    }
    Mesh mesh;
    for (const Side& side :
         {Side{{0, size.y - 1}, {1, 0}, size.x}, Side{{size.x - 1, size.y - 1}, {0, -1}, size.y},
          Side{{size.x - 1, 0}, {-1, 0}, size.x}, Side{{0, 0}, {0, 1}, size.y}}) {
        add_side(surface, side, bottom, mesh);
    }
    return mesh.indices.empty() ? std::nullopt : std::optional(std::move(mesh));
}

bool may_show_base(const TerrainSurface& surface, const glm::dmat4& world_from_local,
                   const Camera& camera) {
    if (camera.projection != ProjectionKind::perspective) {
        return true;
    }
    const glm::dvec3 eye(glm::inverse(world_from_local) * glm::dvec4(camera.eye, 1.0));
    const auto sample = surface.placement().sample_from_world(eye);
    const Grid<float>& heights = surface.heightfield().heights;
    const bool is_over = sample && sample->x >= 0.0 && sample->y >= 0.0 &&
                         sample->x <= heights.cols() - 1 && sample->y <= heights.rows() - 1;
    return !is_over;
}

} // namespace reljef::scene
