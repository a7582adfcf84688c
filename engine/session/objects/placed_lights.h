#pragma once

#include <optional>
#include <vector>

#include "engine/core/result.h"
#include "engine/io/formats/scene_file.h"
#include "engine/scene/graph/scene.h"
#include "engine/session/objects/placed_objects.h"

namespace reljef::session {

/// A point light that stands on a terrain.
struct StandingLight {
    scene::Node* node = nullptr; ///< owned by the scene
    io::PointLightDescription description;
    std::optional<double> ground_height; ///< true metres from the source; absent: the surface's
};

/// The light, without its place.
scene::PointLight point_light_of(const io::PointLightDescription& description);

/// A light besides the sun.
scene::Light light_of(const io::LightDescription& description);

/// Adds point lights above the ground, along the local vertical. `height`: as add_objects(). Fails
/// on a place that is no place on Earth or not on the terrain.
Result<std::vector<StandingLight>>
add_point_lights(scene::Scene& scene, const scene::TerrainSurface& surface,
                 const std::vector<io::PointLightDescription>& lights, const SourceHeight& height);

/// Puts lights on another surface of the same terrain.
void stand_on(const scene::TerrainSurface& surface, const std::vector<StandingLight>& lights);

} // namespace reljef::session
