#include "engine/truth/sun_ray.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace reljef::truth {
namespace {

constexpr double nearest_samples = 1e-3;

// Metres along a local ray until it has passed as many samples.
double metres_of_samples(const scene::TerrainSurface& surface, double samples) {
    const glm::dvec2 spacing = surface.heightfield().spacing;
    return samples * std::min(spacing.x, spacing.y);
}

bool is_below(const scene::TerrainSurface& surface, glm::dvec3 local) {
    const auto sample = surface.placement().sample_from_world(local);
    const Grid<float>& heights = surface.heightfield().heights;
    const bool is_over = sample && sample->x >= 0.0 && sample->y >= 0.0 &&
                         sample->x <= heights.cols() - 1 && sample->y <= heights.rows() - 1;
    return is_over && sample->z < terrain::bilinear_height(heights.view(), glm::dvec2(*sample));
}

} // namespace

bool sees_sun(const SceneCaster& caster, const SceneHit& hit, glm::dvec3 to_sun) {
    const PlacedTerrain& terrain = caster.terrains()[hit.terrain];
    const scene::TerrainSurface& surface = *terrain.surface;
    Ray ray;
    ray.origin = surface.placement().world_from_sample(hit.surface.sample);
    ray.direction = glm::normalize(glm::dmat3(terrain.local_from_world) * to_sun);
    ray.origin = ray.at(metres_of_samples(surface, nearest_samples));
    return !is_below(surface, ray.origin) && !terrain.caster.first_hit(ray);
}

} // namespace reljef::truth
