#include "engine/scene/graph/point_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace reljef::scene {

PlacedPointLight as_point_light(const Light& light) {
    constexpr double square = distance_of_parallel_light * distance_of_parallel_light;
    return {{light.color, static_cast<float>(square), std::numeric_limits<float>::infinity()},
            distance_of_parallel_light * to_light(light)};
}

glm::vec3 radiance_from(const PlacedPointLight& light, glm::dvec3 place, glm::vec3 normal) {
    const glm::dvec3 way = light.place - place;
    const double range = light.light.range;
    const double square =
        std::max(glm::dot(way, way), static_cast<double>(nearest_point_light) *
                                         static_cast<double>(nearest_point_light));
    const double facing = glm::dot(glm::dvec3(normal), way) / std::sqrt(square);
    if (square >= range * range || facing <= 0.0) {
        return glm::vec3(0.0F);
    }
    const double part = square / (range * range);
    const double window = 1.0 - part * part;
    return light.light.color *
           static_cast<float>(light.light.intensity * facing * window * window / square);
}

glm::vec3 radiance_from(std::span<const PlacedPointLight> lights, glm::dvec3 place,
                        glm::vec3 normal) {
    glm::vec3 sum(0.0F);
    for (const PlacedPointLight& light : lights) {
        sum += radiance_from(light, place, normal);
    }
    return sum;
}

} // namespace reljef::scene
