#pragma once

#include <stop_token>
#include <vector>

#include "engine/io/formats/scene_file.h"
#include "engine/scene/graph/scene.h"
#include "engine/session/log.h"
#include "engine/session/options.h"

namespace reljef::session {

/// Puts the gallery's models into the scene, each with its tile of detail; returns their nodes,
/// which the scene owns. Fails on a texture set that is unknown or cannot be read, on a
/// technique of the scene file that is none, and where it is stopped.
Result<std::vector<scene::Node*>> add_gallery(scene::Scene& scene,
                                              const io::SceneDescription& description,
                                              const SourceOptions& terrain,
                                              const SceneOptions& view, Log& log,
                                              const std::stop_token& stop);

} // namespace reljef::session
