#pragma once

#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/scene/graph/scene.h"
#include "engine/scene/streaming/tile_stream.h"
#include "engine/session/log.h"
#include "engine/session/terrain_source.h"
#include "engine/view/select.h"

namespace reljef::session {

/// Makes the stream of a source's tiles over its `overview`; null if the source is not streamed.
std::shared_ptr<scene::TileStream>
make_stream(const TerrainSource& source, std::shared_ptr<const scene::TerrainSurface> overview);

/// Gives a node the stream of its source, and the numbers of triangles and vertices that may be
/// drawn with `megabytes` of memory, MiB.
void set_stream_and_limits(scene::TerrainNode& shown, const TerrainSource& source, int megabytes);

/// Requests the tiles of views from their streams; the tiles of the first views come first.
void request_tiles(std::span<const view::TileRequests> requests);

/// Selects the scene's view, loads its missing tiles and selects again, until all tiles are in
/// memory or have failed for good, or `stop` is requested. The last selection is the frame to draw.
/// Logs errors meanwhile, as log_stream_errors().
void wait_for_tiles(const scene::Scene& scene, glm::ivec2 size, view::FrameSelector& selector,
                    Log& log, const std::stop_token& stop);

/// Loads the full-resolution tiles below the camera's eye, until they are in memory or have failed
/// for good, or `stop` is requested.
void wait_for_ground_below_eye(const scene::Scene& scene, const std::stop_token& stop);

/// What errors of pictures are compared with, pixels.
struct ExpectedError {
    double pixels = 0.0;
    bool is_named = true; ///< an error bound; false: scene::max_expected_error_of_rays
};
/// The smallest of the scene's terrains; empty if none has one.
std::optional<ExpectedError> expected_error(const scene::Scene& scene);

/// The memory with which all streamed terrains keep their error bounds in a view.
struct MemoryForBound {
    double growth = 1.0;   ///< relative to their memory
    bool is_enough = true; ///< false: counting ended there, and more is needed
    /// With which all terrains are read whole and have no error but that of their triangles, MiB;
    /// absent: tiles are needed for more than heights.
    std::optional<int> whole_megabytes;
};
MemoryForBound memory_for_bound(const scene::Scene& scene, glm::ivec2 size);
/// With which terrains in memory would not be averages of their samples, MiB; empty: they are none.
std::optional<int> megabytes_for_all_samples(const scene::Scene& scene);

/// The memory that holds all samples of terrains as vertices, where their technique draws every
/// sample and their memory does not hold them (scene::triangle_bound), MiB; 0: all are drawn.
int megabytes_for_every_sample(const scene::Scene& scene);

/// The memory that allows a number of triangles in a view of terrains in memory, MiB.
int megabytes_for_triangles(std::size_t triangles);

/// A streamed terrain that may be shown instead of another one of the same ground.
struct StreamedSurface {
    std::shared_ptr<const scene::TerrainSurface> surface; ///< the overview
    std::shared_ptr<scene::TileStream> stream;
};

/// Loads the tiles of the scene's view for `next` as if the terrain showed it. Returns whether they
/// are in memory or have failed for good; call it until then.
bool load_view(const scene::Scene& scene, scene::TerrainNode& terrain, const StreamedSurface& next,
               glm::ivec2 size);

/// Extrapolates a camera that moved from `before` to `now` in `seconds` by `ahead` more seconds.
scene::Camera camera_ahead(const scene::Camera& before, const scene::Camera& now, double seconds,
                           double ahead);

/// Whether tiles arrived since the last call.
bool take_arrivals(const scene::Scene& scene);
/// Whether requested tiles are still missing.
bool awaits_tiles(const scene::Scene& scene);

/// Logs the errors of streams, once per file, and their notes.
void log_stream_errors(const scene::Scene& scene, Log& log);
std::size_t failed_files(const scene::Scene& scene);

/// Counts of each stream: tiles read, evicted and kept. Empty if nothing is streamed.
std::vector<scene::TileStreamStats> stream_stats(const scene::Scene& scene);
/// Why tiles of these streams are unproven, for notes.
const char* why_unproven(const std::vector<scene::TileStreamStats>& streams);

} // namespace reljef::session
