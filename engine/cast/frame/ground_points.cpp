#include "engine/cast/frame/ground_points.h"

#include <algorithm>

#include "engine/view/terrain_maps.h"

namespace reljef::cast {

void LitGround::paint(PlacedTile& tile, glm::vec2 first_sample) const {
    tile.albedo = albedo.paint(first_sample);
    tile.normals = normals.paint(first_sample);
}

LitGround lit_ground(const scene::TerrainSurface& surface, int max_side) {
    const view::GroundMap map = view::ground_map(surface, {}, max_side);
    Grid<glm::vec3> normals(map.surface.cols(), map.surface.rows());
    std::transform(map.surface.samples().begin(), map.surface.samples().end(),
                   normals.samples().begin(), [](glm::vec4 texel) { return glm::vec3(texel); });
    const Grid<float>& heights = surface.heightfield().heights;
    const glm::ivec2 samples(heights.cols(), heights.rows());
    return {LitLevels(map.albedo, samples), LitLevels(normals, samples)};
}

LitGround lit_ground(const scene::TerrainTile& tile) {
    Grid<glm::vec3> normals(tile.albedo.cols(), tile.albedo.rows());
    for (int row = 0; row < normals.rows(); ++row) {
        for (int col = 0; col < normals.cols(); ++col) {
            normals(col, row) = tile.normal_at(tile.vertex_of({col, row}));
        }
    }
    const glm::ivec2 samples = tile.cells + 1;
    return {LitLevels(tile.albedo, samples), LitLevels(normals, samples)};
}

std::vector<PointLightPaint> point_light_paints(const view::DrawList& list) {
    std::vector<PointLightPaint> paints;
    for (const auto& [light, place] : list.point_lights) {
        paints.push_back({glm::vec3(place - list.camera.eye), light.color * light.intensity,
                          1.0F / (light.range * light.range),
                          scene::nearest_point_light * scene::nearest_point_light});
    }
    return paints;
}

} // namespace reljef::cast
