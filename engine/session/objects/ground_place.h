#pragma once

#include <optional>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/result.h"
#include "engine/scene/streaming/terrain_surface.h"

namespace reljef::session {

/// Where something stands on a terrain.
struct GroundPlace {
    std::string name; ///< of what stands there, for errors
    /// Latitude and longitude on georeferenced terrain; on other terrain x and y, scene metres.
    glm::dvec2 at{0.0};
    std::optional<double> ground_height = {}; ///< true metres; absent: the surface's
};

/// An error "NAME: at X,Y FOUND found, EXPECTED was expected".
Error misplaced(const GroundPlace& place, const std::string& found, const std::string& expected);

/// The ground at a place, scene metres. Fails on a place that is no place on Earth, outside the
/// terrain, or in a void.
Result<glm::dvec3> ground_at(const scene::TerrainSurface& surface, const GroundPlace& place);

} // namespace reljef::session
