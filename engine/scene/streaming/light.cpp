#include "engine/scene/streaming/light.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::scene {

glm::dvec3 to_light(const Light& light) {
    const double azimuth = glm::radians(light.azimuth);
    const double altitude = glm::radians(light.altitude);
    return {std::sin(azimuth) * std::cos(altitude), std::cos(azimuth) * std::cos(altitude),
            std::sin(altitude)};
}

Light turned(Light light, const glm::dmat4& world_from_local) {
    const glm::dmat3 axes(world_from_local);
    if (axes != glm::dmat3(1.0)) {
        const glm::dvec3 direction = glm::normalize(axes * to_light(light));
        light.azimuth = glm::degrees(std::atan2(direction.x, direction.y));
        light.altitude = glm::degrees(std::asin(std::clamp(direction.z, -1.0, 1.0)));
    }
    return light;
}

} // namespace reljef::scene
