#pragma once

#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>

#include <glm/vec2.hpp>

#include "engine/scene/graph/scene.h"
#include "engine/scene/tile_stream.h"
#include "engine/session/terrain_source.h"

namespace reljef::session {

/// The stream of a source's tiles, over `overview`; null where it is not streamed.
std::shared_ptr<scene::TileStream>
make_stream(const TerrainSource& source, std::shared_ptr<const scene::TerrainSurface> overview);

/// Waits until all tiles are there that a picture of the scene needs, or have failed for good.
/// Meanwhile tells faults, as tell_stream_faults.
void bring_tiles(const scene::Scene& scene, glm::ivec2 size, const std::stop_token& stop,
                 bool quiet);

/// Asks for the tiles that views need, the first view's first, and returns at once.
void ask_for_tiles(const scene::Scene& scene, std::span<const scene::Camera> views,
                   glm::ivec2 size);

/// Where a camera that came from `before` within `seconds` will be after `ahead` more, seconds, if
/// it goes on like that.
scene::Camera camera_ahead(const scene::Camera& before, const scene::Camera& now, double seconds,
                           double ahead);

/// Whether tiles came since the last call.
bool take_new_tiles(const scene::Scene& scene);
/// Whether some are still to come.
bool awaits_tiles(const scene::Scene& scene);

/// Tells the faults of streams on stderr, each file's once, and their notes.
void tell_stream_faults(const scene::Scene& scene, bool quiet);
/// Files that had faults.
std::size_t faulty_files(const scene::Scene& scene);

/// What was read, dropped and is kept, as lines; empty where nothing is streamed.
std::string stream_stats(const scene::Scene& scene);

} // namespace reljef::session
