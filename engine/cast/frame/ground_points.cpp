#include "engine/cast/frame/ground_points.h"

#include <algorithm>

#include "engine/core/color.h"
#include "engine/view/terrain_maps.h"

namespace reljef::cast {

namespace {

LitGround levels_of(const view::GroundMap& map, glm::ivec2 samples, bool has_sun_share,
                    unsigned threads) {
    Grid<glm::vec3> normals(map.surface.cols(), map.surface.rows());
    std::transform(map.surface.samples().begin(), map.surface.samples().end(),
                   normals.samples().begin(), [](glm::vec4 texel) { return glm::vec3(texel); });
    LitGround ground{
        LitLevels(map.albedo, samples, threads), LitLevels(normals, samples, threads), {}};
    if (has_sun_share) {
        Image share(map.surface.cols(), map.surface.rows());
        std::transform(map.surface.samples().begin(), map.surface.samples().end(),
                       share.samples().begin(),
                       [](glm::vec4 texel) { return rgba8_from_linear(glm::vec3(texel.w)); });
        ground.sun_share.emplace(share, samples, threads);
    }
    return ground;
}

} // namespace

void LitGround::paint(PlacedTile& tile, glm::vec2 first_sample) const {
    tile.albedo = albedo.paint(first_sample);
    tile.normals = normals.paint(first_sample);
    if (sun_share) {
        tile.sun_share = sun_share->paint(first_sample);
    }
}

LitGround lit_ground(const scene::TerrainSurface& surface,
                     const std::optional<scene::TerrainLight>& light, int max_side) {
    const Grid<float>& heights = surface.heightfield().heights;
    return levels_of(view::ground_map(surface, light, max_side), {heights.cols(), heights.rows()},
                     light.has_value(), 0);
}

LitGround lit_ground(const scene::TileBuilder& builder, const scene::TerrainTile& tile,
                     const scene::TerrainIrradiance* irradiance) {
    constexpr unsigned alone = 1; // other threads make other tiles
    return levels_of(view::ground_of_tile(builder, tile, irradiance), tile.cells + 1,
                     irradiance != nullptr, alone);
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
