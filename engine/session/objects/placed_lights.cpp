#include "engine/session/objects/placed_lights.h"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "engine/core/color.h"
#include "engine/session/objects/ground_place.h"
#include "engine/session/objects/upright_axes.h"

namespace reljef::session {
namespace {

// `number`: from 1 on, for errors.
GroundPlace place_of(const StandingLight& light, std::size_t number = 0) {
    return {fmt::format("point light {}", number), light.description.at.value_or(glm::dvec2(0.0)),
            light.ground_height};
}

Result<glm::dvec3> position_of(const scene::TerrainSurface& surface, const StandingLight& light,
                               std::size_t number = 0) {
    const auto ground = ground_at(surface, place_of(light, number));
    if (!ground) {
        return ground.error();
    }
    return *ground + light.description.height * surface.placement().up(*ground);
}

} // namespace

scene::PointLight point_light_of(const io::PointLightDescription& description) {
    scene::PointLight light;
    light.color = linear_from_rgba8(description.color);
    light.intensity = static_cast<float>(description.intensity);
    light.range = static_cast<float>(io::range_of(description));
    return light;
}

scene::Light light_of(const io::LightDescription& description) {
    scene::Light light;
    light.azimuth = description.azimuth;
    light.altitude = description.altitude;
    light.color = static_cast<float>(description.intensity) * linear_from_rgba8(description.color);
    light.ambient = glm::vec3(0.0F);
    return light;
}

Result<std::vector<StandingLight>>
add_point_lights(scene::Scene& scene, const scene::TerrainSurface& surface,
                 const std::vector<io::PointLightDescription>& lights, const SourceHeight& height) {
    std::vector<StandingLight> placed;
    for (const io::PointLightDescription& description : lights) {
        const std::size_t number = placed.size() + 1;
        StandingLight light{nullptr, description, {}};
        if (height) {
            light.ground_height = height(*description.at);
            if (!light.ground_height) {
                return misplaced(place_of(light, number), "no height",
                                 "a place on the terrain with one");
            }
        }
        const auto position = position_of(surface, light, number);
        if (!position) {
            return position.error();
        }
        light.node = &scene.add_point_light(point_light_of(description), *position);
        placed.push_back(light);
    }
    return placed;
}

void stand_on(const scene::TerrainSurface& surface, const std::vector<StandingLight>& lights) {
    for (const StandingLight& light : lights) {
        if (const auto position = position_of(surface, light)) {
            light.node->set_position(*position);
        }
    }
}

} // namespace reljef::session
