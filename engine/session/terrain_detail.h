#pragma once

#include <memory>
#include <stop_token>

#include "engine/io/formats/scene_file.h"
#include "engine/scene/graph/terrain_node.h"
#include "engine/session/log.h"
#include "engine/session/options.h"

namespace reljef::session {

/// The tile of detail that --detail or the scene file lays over the terrain; null: neither. Fails
/// on a tile that is unknown or cannot be read, on a technique that does not show it, and where it
/// is stopped; a usage error where an option names no tile or has none.
Result<std::shared_ptr<const scene::TerrainDetail>>
open_detail(const io::SceneDescription& description, const SourceOptions& terrain,
            const SceneOptions& view, Log& log, const std::stop_token& stop);

} // namespace reljef::session
