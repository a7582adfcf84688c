#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/scene/graph/camera.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::app {

/// The options that show the view of a perspective camera again:
/// "--camera LAT,LON,HEIGHT,HEADING,PITCH", or "--eye X,Y,Z --look X,Y,Z" without a place on Earth.
std::string camera_text(const scene::TerrainSurface& surface, const scene::Camera& camera);

/// The camera of such options, with the projection of `camera`. Empty if the text is none of them,
/// or the terrain has no such place.
std::optional<scene::Camera> camera_from_text(const scene::TerrainSurface& surface,
                                              std::string_view text, scene::Camera camera);

} // namespace reljef::app
