#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/color.h"
#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/scene/graph/scene.h"
#include "engine/scene/streaming/terrain_light.h"
#include "engine/truth/eye.h"
#include "engine/truth/scene_caster.h"

namespace reljef::truth {

/// Linear colour of the sky along a world ray (scene::Sky), or of the plane below it; a sun adds
/// glow and disc. `picture`: instead of these; null: none.
glm::vec3 sky_color(const scene::Sky& sky, const std::optional<scene::Light>& sun, const Ray& ray,
                    const scene::SeenSky* picture = nullptr);

/// A linear colour through `distance` metres of air along a world ray (Koschmieder 1924).
glm::vec3 seen_through_air(const scene::Sky& sky, const std::optional<scene::Light>& sun,
                           glm::vec3 color, const Ray& ray, double distance);

/// The sky, the air and the lights of a scene.
struct Backdrop {
    std::optional<scene::Light> sun;
    std::optional<scene::Sky> sky;
    std::vector<scene::PlacedPointLight> point_lights = {};

    /// A linear colour through `distance` metres of air along a world ray.
    [[nodiscard]] glm::vec3 through_air(glm::vec3 color, const Ray& ray, double distance) const;
    /// Linear radiance of point lights at albedo 1. `local`: the place; `normal`: of any length.
    [[nodiscard]] glm::vec3 from_points(const glm::dmat4& world_from_local, glm::dvec3 local,
                                        glm::dvec3 normal) const;
    /// Linear; black without a sky.
    [[nodiscard]] glm::vec3 behind(const Ray& ray, const Eye& eye) const;
};

enum class SunShadow {
    sweep, ///< precomputed per sample, with penumbra (scene/terrain_light.h)
    ray,   ///< exact, see sees_sun(); meshes cast and get shadows, too
};

/// `ray` if a visible terrain casts hard shadows (`shadow=hard`).
SunShadow sun_shadow_of(const scene::Scene& scene);

/// The ray to the sun from a place of a terrain, in its local coordinates: begins a thousandth of a
/// sample away. `spacing`: metres between samples.
Ray sun_ray_from(glm::dvec3 place, glm::dvec2 spacing, glm::dvec3 to_sun);
/// The same from a hit of a mesh along `ray`, in the world: begins a micrometre outside of the
/// triangle. Empty from one that is turned away.
std::optional<Ray> sun_ray_from(const MeshCaster& meshes, const MeshHit& hit, const Ray& ray,
                                glm::dvec3 to_sun);

/// Whether the ray from a hit to the sun meets nothing of the hit's terrain, and no mesh: exact, no
/// penumbra. `to_sun`: unit vector in the world.
bool sees_sun(const SceneCaster& caster, const SceneHit& hit, glm::dvec3 to_sun);

/// The same of a hit of a mesh, along `ray`: of all terrains and meshes. A triangle that is turned
/// away from the sun does not see it.
bool sees_sun(const SceneCaster& caster, const MeshHit& hit, const Ray& ray, glm::dvec3 to_sun);

/// Linear colours of a scene's hits. The constructor computes albedo, slopes and shadows of all
/// terrains; later changes of the scene have no effect. Thread-safe.
class Shading {
public:
    /// Precondition: `caster` was made from `scene`. With SunShadow::ray it must outlive this.
    Shading(const scene::Scene& scene, const SceneCaster& caster,
            SunShadow shadow = SunShadow::sweep);

    /// Albedo times irradiance (scene/terrain_light.h), without a sun the albedo; and what it
    /// reflects of point lights.
    [[nodiscard]] glm::vec3 at(const SceneHit& hit) const;
    /// Of a mesh of the caster.
    [[nodiscard]] glm::vec3 at(const MeshHit& hit, const SceneCaster& caster, const Ray& ray,
                               double distance) const;
    /// The same through `distance` metres of air.
    [[nodiscard]] glm::vec3 at(const SceneHit& hit, const Ray& ray, double distance) const;
    /// The sky; black without one.
    [[nodiscard]] glm::vec3 background(const Ray& ray, const Eye& eye) const;
    [[nodiscard]] const std::optional<scene::Sky>& sky() const { return backdrop_.sky; }

private:
    struct Maps {
        std::shared_ptr<const scene::TerrainSurface> surface;
        glm::dmat4 world_from_local{1.0};
        Image albedo;
        glm::dvec2 texels_per_sample;
        std::optional<scene::TerrainIrradiance> irradiance;
        Grid<glm::vec2> gradients; // for point lights; empty without some
    };
    [[nodiscard]] Maps maps_of(const PlacedTerrain& terrain) const;
    [[nodiscard]] glm::vec3 from_points(const Maps& maps, const SceneHit& hit,
                                        glm::dvec2 sample) const;
    [[nodiscard]] glm::vec3 irradiance(const Maps& maps, const SceneHit& hit,
                                       glm::dvec2 sample) const;

    const SceneCaster* caster_; // null: the maps contain the shadows
    Backdrop backdrop_;
    std::vector<Maps> maps_;
};

} // namespace reljef::truth
