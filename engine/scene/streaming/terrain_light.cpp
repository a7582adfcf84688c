#include "engine/scene/streaming/terrain_light.h"

#include <algorithm>
#include <functional>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>

#include "engine/core/bilinear.h"
#include "engine/scene/streaming/ground_overlay.h"
#include "engine/terrain/field/gradient.h"
#include "engine/terrain/field/tint.h"
#include "engine/terrain/light/sky_share.h"
#include "engine/terrain/light/sun_visibility.h"

namespace reljef::scene {
namespace {

float share_of_byte(std::uint8_t byte) {
    return static_cast<float>(byte) / 255.0F;
}

Grid<std::uint8_t> share_of_sky(const TerrainSurface& surface, const TerrainLight& light) {
    const terrain::Heightfield& heightfield = surface.heightfield();
    return light.sun.is_sky_hidden
               ? terrain::sky_share(heightfield.heights.view(), heightfield.spacing,
                                    surface.placement().exaggeration())
               : Grid<std::uint8_t>();
}

Grid<std::uint8_t> visibility_of_sun(const TerrainSurface& surface, const TerrainLight& light) {
    const terrain::Heightfield& heightfield = surface.heightfield();
    const glm::dvec2 middle =
        0.5 * glm::dvec2(heightfield.heights.cols() - 1, heightfield.heights.rows() - 1);
    // The components along the axes of the grid: a vector times a matrix.
    const glm::dvec3 to_sun_on_grid = glm::inverse(light.world_from_local) * to_light(light.sun) *
                                      terrain::grid_axes(heightfield, surface.placement(), middle);
    return terrain::sun_visibility(heightfield.heights.view(), heightfield.spacing,
                                   surface.placement().exaggeration(), to_sun_on_grid,
                                   heightfield.georeference &&
                                       heightfield.georeference->geodetic.rows().wrap().around);
}

} // namespace

Image albedo_map(const TerrainSurface& surface) {
    const terrain::Terrain& terrain = surface.terrain();
    const double share = surface.imagery_share();
    const bool opaque = share == 1.0 && !terrain.color.empty() &&
                        std::all_of(terrain.color.samples().begin(), terrain.color.samples().end(),
                                    [](Rgba8 pixel) { return pixel.a == 255; });
    Image colors =
        opaque ? terrain.color
               : terrain::composite(terrain.color,
                                    terrain::hypsometric_tint(terrain.heightfield, surface.ramp()),
                                    share);
    blend_overlay(surface, colors);
    return colors;
}

TerrainIrradiance::TerrainIrradiance(const TerrainSurface& surface, const TerrainLight& light)
    : sky_share_(share_of_sky(surface, light)), visibility_(visibility_of_sun(surface, light)),
      gradients_(terrain::surface_gradients(surface.heightfield(), surface.placement())),
      world_from_normal_(glm::inverseTranspose(light.world_from_local)),
      to_sun_(to_light(light.sun)), sun_(light.sun.color), sky_(light.sun.ambient),
      is_day_((glm::inverse(light.world_from_local) * to_light(light.sun)).z > 0.0) {}

glm::vec3 TerrainIrradiance::normal_at(glm::dvec2 sample) const {
    const glm::vec2 gradient = bilinear(gradients_, sample, std::identity());
    return glm::normalize(world_from_normal_ * glm::vec3(-gradient.x, -gradient.y, 1.0F));
}

float TerrainIrradiance::visibility(glm::dvec2 sample) const {
    return bilinear(visibility_, sample, share_of_byte);
}

float TerrainIrradiance::sky_at(glm::dvec2 sample, glm::vec3 normal) const {
    return sky_share_.empty() ? 0.5F + 0.5F * normal.z
                              : bilinear(sky_share_, sample, share_of_byte);
}

float TerrainIrradiance::openness(glm::dvec2 sample) const {
    if (sky_share_.empty()) {
        return 1.0F;
    }
    const float free = 0.5F + 0.5F * normal_at(sample).z;
    return std::min(bilinear(sky_share_, sample, share_of_byte) / free, 1.0F);
}

glm::vec3 TerrainIrradiance::at(glm::dvec2 sample) const {
    const glm::vec3 normal = normal_at(sample);
    const float sun = std::max(glm::dot(normal, to_sun_), 0.0F) * visibility(sample);
    return sun_ * sun + sky_ * sky_at(sample, normal);
}

glm::vec3 TerrainIrradiance::in_world(glm::vec3 normal) const {
    return glm::normalize(world_from_normal_ * normal);
}

glm::vec3 TerrainIrradiance::at(glm::vec3 normal, glm::vec3 up, float visibility,
                                float openness) const {
    const float sun = std::max(glm::dot(normal, to_sun_), 0.0F) * visibility;
    return sun_ * sun + sky_ * (openness * (0.5F + 0.5F * glm::dot(normal, up)));
}

IrradianceParts TerrainIrradiance::parts_at(glm::vec3 normal, glm::vec3 up, float openness) const {
    const float sun = is_day_ ? std::max(glm::dot(normal, to_sun_), 0.0F) : 0.0F;
    return {sky_ * (openness * (0.5F + 0.5F * glm::dot(normal, up))), sun_ * sun};
}

IrradianceParts TerrainIrradiance::parts_at(glm::dvec2 sample) const {
    const glm::vec3 normal = normal_at(sample);
    const float sun = is_day_ ? std::max(glm::dot(normal, to_sun_), 0.0F) : 0.0F;
    return {sky_ * sky_at(sample, normal), sun_ * sun};
}

} // namespace reljef::scene
