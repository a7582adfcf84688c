#pragma once

#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/color.h"
#include "engine/core/geometry.h"
#include "engine/scene/graph/scene.h"
#include "engine/scene/graph/terrain_light.h"
#include "engine/truth/scene_caster.h"

namespace reljef::truth {

/// Light from the sky in a direction (need not be of unit length), linear: from the horizon's
/// colour to the zenith's as the root of the height, darker below; around the sun, where there is
/// one, its glow and its disc.
glm::vec3 sky_color(const scene::Sky& sky, const std::optional<scene::Light>& sun,
                    glm::dvec3 direction);

/// What is left of a colour after `distance` metres of air, with the air's own added (Koschmieder
/// 1924). Linear.
glm::vec3 seen_through_air(const scene::Sky& sky, glm::vec3 color, double distance);

/// Where shadows come from.
enum class SunShadow {
    sweep, ///< found once at the samples, with the sun's penumbra (scene/terrain_light.h)
    ray,   ///< an exact ray from each hit to the sun (sun_ray.h)
};

/// What the rays of one scene bring home, linear. Finds albedo, slopes and shadows of all terrains
/// when it is made; safe to ask from several threads; later changes of the scene are not seen.
class Shading {
public:
    /// Precondition: `caster` was made from `scene`, and lives longer where rays find the shadows.
    Shading(const scene::Scene& scene, const SceneCaster& caster,
            SunShadow shadow = SunShadow::sweep);

    /// Albedo times irradiance (scene/terrain_light.h) at the hit itself; the albedo alone without
    /// a light.
    [[nodiscard]] glm::vec3 at(const SceneHit& hit) const;
    /// As `at`, seen from `distance` metres away.
    [[nodiscard]] glm::vec3 at(const SceneHit& hit, double distance) const;
    /// Where there is no terrain: the sky, black without one.
    [[nodiscard]] glm::vec3 background(glm::dvec3 direction) const;

private:
    struct Maps {
        Image albedo;
        glm::dvec2 texels_per_sample;
        std::optional<scene::TerrainIrradiance> irradiance;
    };
    static Maps maps_of(const PlacedTerrain& terrain, const std::optional<scene::Light>& sun);
    [[nodiscard]] glm::vec3 irradiance(const Maps& maps, const SceneHit& hit,
                                       glm::dvec2 sample) const;

    const SceneCaster* caster_; // null: the shadows are in the maps
    std::optional<scene::Light> sun_;
    std::optional<scene::Sky> sky_;
    std::vector<Maps> maps_; // of each terrain
};

} // namespace reljef::truth
