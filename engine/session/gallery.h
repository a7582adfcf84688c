#pragma once

#include <span>
#include <stop_token>
#include <vector>

#include "engine/io/formats/scene_file.h"
#include "engine/scene/graph/scene.h"
#include "engine/session/log.h"
#include "engine/session/options.h"

namespace reljef::session {

/// Adds the gallery's models with their detail tiles; returns their nodes, which the scene owns.
/// Objects without a place are its models instead: each once for every technique that draws any
/// mesh, in rows. Fails as read_whole_mesh, on unknown or unreadable materials, on a bad technique
/// in the scene file, and after a stop request.
Result<std::vector<scene::Node*>> add_gallery(scene::Scene& scene,
                                              const io::SceneDescription& description,
                                              const SourceOptions& terrain,
                                              const SceneOptions& view, Log& log,
                                              const std::stop_token& stop);

/// Shadows of models lie on the floor, and on each other, if the technique of one of them has
/// shadows. To be called when their techniques change.
void shadow_floor(scene::TerrainNode& floor, std::span<scene::Node* const> models);

} // namespace reljef::session
