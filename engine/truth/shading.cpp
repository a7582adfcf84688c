#include "engine/truth/shading.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>

#include "engine/core/bilinear.h"
#include "engine/terrain/field/gradient.h"
#include "engine/truth/eye.h"

namespace reljef::truth {
namespace {

float toward_sun(const std::optional<scene::Light>& sun, glm::dvec3 direction) {
    return sun ? static_cast<float>(
                     std::pow(std::max(glm::dot(direction, scene::to_light(*sun)), 0.0), 8))
               : 0.0F;
}

// Mean of exp(-z / height) between two heights above the base.
double mean_density(const scene::Sky& sky, double from, double to) {
    if (sky.air_height <= 0.0) {
        return 1.0;
    }
    const double low = std::max(std::min(from, to), 0.0) / sky.air_height;
    const double rise = std::abs(std::max(from, 0.0) - std::max(to, 0.0)) / sky.air_height;
    return std::exp(-low) * (rise > 0.0 ? -std::expm1(-rise) / rise : 1.0);
}

// `air`: metres of air as dense as at the base.
glm::vec3 behind_air(const scene::Sky& sky, const std::optional<scene::Light>& sun, glm::vec3 color,
                     glm::dvec3 direction, double air) {
    const auto depth = static_cast<float>(scene::extinction(sky) * air);
    return glm::mix(sky.horizon + sky.glow * toward_sun(sun, direction), color,
                    glm::exp(-depth * sky.fading));
}

bool meets_plane(const scene::Sky& sky, const Ray& ray) {
    const auto [above, up] = scene::air_place(sky, ray.origin);
    return sky.plane && glm::dot(ray.direction, up) < 0.0 && above > 0.0;
}

bool is_below(const scene::TerrainSurface& surface, glm::dvec3 local) {
    const auto sample = surface.placement().sample_from_world(local);
    const Grid<float>& heights = surface.heightfield().heights;
    const bool is_over = sample && sample->x >= 0.0 && sample->y >= 0.0 &&
                         sample->x <= heights.cols() - 1 && sample->y <= heights.rows() - 1;
    return is_over && sample->z < terrain::bilinear_height(heights.view(), glm::dvec2(*sample));
}

} // namespace

glm::vec3 sky_color(const scene::Sky& sky, const std::optional<scene::Light>& sun, const Ray& ray,
                    const scene::SeenSky* picture) {
    const glm::dvec3 direction = glm::normalize(ray.direction);
    const auto [above, up] = scene::air_place(sky, ray.origin);
    if (meets_plane(sky, ray)) {
        const double fall = -glm::dot(direction, up);
        const double air =
            scene::plane_air(sky, above) / scene::steepness_to_plane(sky, above, fall);
        return behind_air(sky, sun, *sky.plane, direction, air);
    }
    if (picture != nullptr) {
        return picture->color(direction);
    }
    const auto height = static_cast<float>(std::max(direction.z, 0.0));
    const float share = height * (1.0F + sky.curve) / (height + sky.curve);
    const glm::vec3 color =
        glm::mix(sky.horizon, sky.zenith, share) + sky.glow * toward_sun(sun, direction);
    if (!sun) {
        return color;
    }
    const double disc =
        glm::smoothstep(0.99985, 0.99995, glm::dot(direction, scene::to_light(*sun)));
    return color + sun->color * static_cast<float>(disc);
}

glm::vec3 seen_through_air(const scene::Sky& sky, const std::optional<scene::Light>& sun,
                           glm::vec3 color, const Ray& ray, double distance) {
    if (sky.visibility <= 0.0) {
        return color;
    }
    const glm::dvec3 direction = glm::normalize(ray.direction);
    const double eye = scene::air_place(sky, ray.origin).above;
    const double end = scene::air_place(sky, ray.origin + distance * direction).above;
    return behind_air(sky, sun, color, direction, distance * mean_density(sky, eye, end));
}

SunShadow sun_shadow_of(const scene::Scene& scene) {
    SunShadow found = SunShadow::sweep;
    scene::visit_visible(scene.root(), [&](const scene::Node& node, const glm::dmat4&) {
        const auto* const terrain = node.get<scene::TerrainNode>();
        if (terrain != nullptr && scene::casts_hard_shadows(terrain->material.technique.options)) {
            found = SunShadow::ray;
        }
    });
    return found;
}

Shading::Shading(const scene::Scene& scene, const SceneCaster& caster, SunShadow shadow)
    : caster_(shadow == SunShadow::ray ? &caster : nullptr), backdrop_{scene.sun(), scene.sky(),
                                                                       scene.point_lights()} {
    for (const PlacedTerrain& terrain : caster.terrains()) {
        maps_.push_back(maps_of(terrain));
    }
}

Shading::Maps Shading::maps_of(const PlacedTerrain& terrain) const {
    Maps maps;
    maps.surface = terrain.surface;
    maps.world_from_local = terrain.world_from_local;
    const Grid<float>& heights = terrain.surface->heightfield().heights;
    maps.albedo = scene::albedo_map(*terrain.surface);
    maps.texels_per_sample = glm::dvec2(maps.albedo.cols() - 1, maps.albedo.rows() - 1) /
                             glm::dvec2(heights.cols() - 1, heights.rows() - 1);
    if (backdrop_.sun) {
        maps.irradiance.emplace(
            *terrain.surface,
            scene::TerrainLight{*backdrop_.sun, glm::dmat3(terrain.world_from_local)});
    }
    if (!backdrop_.point_lights.empty()) {
        maps.gradients = terrain::surface_gradients(terrain.surface->heightfield(),
                                                    terrain.surface->placement());
    }
    return maps;
}

glm::vec3 Shading::from_points(const Maps& maps, const SceneHit& hit, glm::dvec2 sample) const {
    if (maps.gradients.empty()) {
        return glm::vec3(0.0F);
    }
    const glm::dvec2 gradient(bilinear(maps.gradients, sample, std::identity()));
    return backdrop_.from_points(maps.world_from_local,
                                 maps.surface->placement().world_from_sample(hit.surface.sample),
                                 glm::dvec3(-gradient, 1.0));
}

glm::vec3 Shading::at(const SceneHit& hit) const {
    const Maps& maps = maps_[hit.terrain];
    // Rounding may put a hit slightly beyond the border.
    const glm::dvec2 sample = glm::max(glm::dvec2(hit.surface.sample), glm::dvec2(0.0));
    const glm::vec3 albedo =
        bilinear(maps.albedo, sample * maps.texels_per_sample, linear_from_rgba8);
    const glm::vec3 by_sun = maps.irradiance ? albedo * irradiance(maps, hit, sample) : albedo;
    return by_sun + albedo * from_points(maps, hit, sample);
}

glm::vec3 Shading::irradiance(const Maps& maps, const SceneHit& hit, glm::dvec2 sample) const {
    if (caster_ == nullptr) {
        return maps.irradiance->at(sample);
    }
    const scene::IrradianceParts parts = maps.irradiance->parts_at(sample);
    return sees_sun(*caster_, hit, scene::to_light(*backdrop_.sun)) ? parts.sky + parts.sun
                                                                    : parts.sky;
}

glm::vec3 Shading::at(const SceneHit& hit, const Ray& ray, double distance) const {
    return backdrop_.through_air(at(hit), ray, distance);
}

glm::vec3 Shading::at(const MeshHit& hit, const SceneCaster& caster, const Ray& ray,
                      double distance) const {
    const bool is_lit = caster_ == nullptr || !backdrop_.sun ||
                        sees_sun(caster, hit, ray, scene::to_light(*backdrop_.sun));
    const glm::vec3 color = caster.meshes().color_at(hit, backdrop_.sun, is_lit) +
                            caster.meshes().from_points(hit, ray.at(hit.t), backdrop_.point_lights);
    return backdrop_.through_air(color, ray, distance);
}

glm::vec3 Backdrop::through_air(glm::vec3 color, const Ray& ray, double distance) const {
    return sky ? seen_through_air(*sky, sun, color, ray, distance) : color;
}

glm::vec3 Backdrop::from_points(const glm::dmat4& world_from_local, glm::dvec3 local,
                                glm::dvec3 normal) const {
    const glm::dvec3 turned = glm::inverseTranspose(glm::dmat3(world_from_local)) * normal;
    return scene::radiance_from(point_lights, glm::dvec3(world_from_local * glm::dvec4(local, 1.0)),
                                glm::vec3(glm::normalize(turned)));
}

glm::vec3 Backdrop::behind(const Ray& ray, const Eye& eye) const {
    if (!sky) {
        return glm::vec3(0.0F);
    }
    return !eye.looks_through_air() && meets_plane(*sky, ray)
               ? *sky->plane
               : sky_color(*sky, sun, ray, eye.sky());
}

glm::vec3 Shading::background(const Ray& ray, const Eye& eye) const {
    return backdrop_.behind(ray, eye);
}

Ray sun_ray_from(glm::dvec3 place, glm::dvec2 spacing, glm::dvec3 to_sun) {
    constexpr double start = 1e-3; // samples
    Ray ray{place, glm::normalize(to_sun)};
    ray.origin = ray.at(start * std::min(spacing.x, spacing.y));
    return ray;
}

std::optional<Ray> sun_ray_from(const MeshCaster& meshes, const MeshHit& hit, const Ray& ray,
                                glm::dvec3 to_sun) {
    constexpr double start = 1e-6; // metres: doubles of places on the Earth are rounded by less
    const glm::dvec3 face = meshes.face_at(hit);
    return glm::dot(face, to_sun) > 0.0 ? std::optional(Ray{ray.at(hit.t) + start * face, to_sun})
                                        : std::nullopt;
}

bool sees_sun(const SceneCaster& caster, const SceneHit& hit, glm::dvec3 to_sun) {
    const PlacedTerrain& terrain = caster.terrains()[hit.terrain];
    const scene::TerrainSurface& surface = *terrain.surface;
    const Ray ray =
        sun_ray_from(surface.placement().world_from_sample(hit.surface.sample),
                     surface.heightfield().spacing, glm::dmat3(terrain.local_from_world) * to_sun);
    return !is_below(surface, ray.origin) && !terrain.caster.first_hit(ray) &&
           !caster.meshes().hides(transformed(terrain.world_from_local, ray));
}

bool sees_sun(const SceneCaster& caster, const MeshHit& hit, const Ray& ray, glm::dvec3 to_sun) {
    const auto onward = sun_ray_from(caster.meshes(), hit, ray, to_sun);
    if (!onward || caster.meshes().hides(*onward)) {
        return false;
    }
    return std::none_of(
        caster.terrains().begin(), caster.terrains().end(), [&](const PlacedTerrain& terrain) {
            const Ray local = transformed(terrain.local_from_world, *onward);
            return is_below(*terrain.surface, local.origin) || terrain.caster.first_hit(local);
        });
}

} // namespace reljef::truth
