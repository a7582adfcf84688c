#pragma once

#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/scene/graph/scene.h"
#include "engine/scene/tile_stream.h"
#include "engine/session/log.h"
#include "engine/session/terrain_source.h"
#include "engine/view/frame_selector.h"

namespace reljef::session {

/// The stream of a source's tiles, over `overview`; null where it is not streamed.
std::shared_ptr<scene::TileStream>
make_stream(const TerrainSource& source, std::shared_ptr<const scene::TerrainSurface> overview);

/// Forwards what views need to the streams: the tiles of the first views first.
void request_tiles(std::span<const view::TileRequests> requests);

/// Selects the scene's view, loads what it lacks and selects again, until all tiles are in memory
/// or have failed for good: the selected frame is then the one to draw. Logs faults
/// meanwhile, as log_stream_faults().
void wait_for_tiles(const scene::Scene& scene, glm::ivec2 size, view::FrameSelector& selector,
                    Log& log, const std::stop_token& stop);

/// Where a camera that came from `before` within `seconds` will be after `ahead` more, seconds, if
/// it goes on like that.
scene::Camera camera_ahead(const scene::Camera& before, const scene::Camera& now, double seconds,
                           double ahead);

/// Whether tiles arrived since the last call.
bool take_arrivals(const scene::Scene& scene);
/// Whether some are still to arrive.
bool awaits_tiles(const scene::Scene& scene);

/// Logs the faults of streams, each file's once, and their notes.
void log_stream_faults(const scene::Scene& scene, Log& log);
/// Files that had faults.
std::size_t faulty_files(const scene::Scene& scene);

/// What each stream read, dropped and keeps; empty where nothing is streamed.
std::vector<scene::TileStreamStats> stream_stats(const scene::Scene& scene);

} // namespace reljef::session
