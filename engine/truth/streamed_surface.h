#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/scene/streaming/tile_stream.h"
#include "engine/terrain/field/tiled_surface.h"

namespace reljef::truth {

struct StreamedSurfaceStats {
    std::size_t loaded = 0;    ///< tiles, so far
    std::size_t reloaded = 0;  ///< of these, tiles that had been evicted
    std::size_t max_bytes = 0; ///< of loaded tiles, so far
};

/// Reads a tile, again after pauses if it fails. Fails with the file's error after the usual
/// attempts, and when stopped. Of files that the stream has given up, takes what it shows instead.
/// The notes of the files are added to `notes`.
Result<scene::TileContent> read_surely(const scene::TileStream& stream,
                                       const scene::TileContentReader& read, terrain::TreeTile tile,
                                       const std::stop_token& stop);

/// All samples of a streamed terrain in the frame of its node. Keeps the latest loaded tiles, and
/// the bounds of more.
class StreamedSurface : public terrain::TiledSurface {
public:
    /// `memory_budget`: bytes of tiles; at least min_tiles are kept.
    StreamedSurface(std::shared_ptr<scene::TileStream> stream, std::size_t memory_budget);

    [[nodiscard]] glm::ivec2 last_sample() const override { return last_; }
    [[nodiscard]] int tile_cells() const override { return terrain::tree_tile_cells; }
    [[nodiscard]] const terrain::SurfaceTile* tile(glm::ivec2 at) const override;
    [[nodiscard]] std::optional<terrain::MinMax> range(glm::ivec2 at) const override;
    [[nodiscard]] std::optional<Ray> sample_ray(const Ray& world_ray) const override;
    [[nodiscard]] glm::dvec3 world_from_sample(glm::dvec3 sample) const override;
    [[nodiscard]] std::optional<glm::dvec3> sample_from_world(glm::dvec3 world) const override;
    [[nodiscard]] std::optional<double> columns_all_around() const override;

    /// Tiles that may be loaded at once. The tiles of three such loads stay in memory.
    [[nodiscard]] std::size_t max_load() const { return max_load_; }
    /// Loads tiles from several threads; not while other threads use tiles. Evicts those that were
    /// loaded first. Fails as read_surely(), and on heights too large for rays on an ellipsoid.
    Result<void> load(std::span<const glm::ivec2> tiles, const ParallelOptions& parallel);

    [[nodiscard]] const scene::TileStream& stream() const { return *stream_; }
    [[nodiscard]] const StreamedSurfaceStats& stats() const { return stats_; }
    /// Notes of files since the last call.
    std::vector<std::string> take_notes() { return std::exchange(notes_, {}); }

private:
    struct Loaded {
        Grid<float> heights;
        terrain::MinMaxPyramid pyramid;
        terrain::SurfaceTile tile;
    };
    struct Read {
        std::shared_ptr<Loaded> loaded;
        std::vector<std::string> notes;
    };
    [[nodiscard]] Result<Read> read(glm::ivec2 at, const std::stop_token& stop) const;
    void keep(glm::ivec2 at, std::shared_ptr<const Loaded> loaded);

    std::shared_ptr<scene::TileStream> stream_;
    glm::ivec2 last_;
    std::size_t max_tiles_;
    std::size_t max_load_;
    std::size_t max_ranges_;
    std::unordered_map<std::uint64_t, std::shared_ptr<const Loaded>> tiles_;
    std::deque<std::uint64_t> order_; // the oldest first
    std::unordered_map<std::uint64_t, terrain::MinMax> ranges_;
    StreamedSurfaceStats stats_;
    std::vector<std::string> notes_;
};

/// The first hits of world rays in `range`; empty for a ray that meets nothing. Loads the tiles
/// that the rays need, the nearest along the rays first (Pharr, Kolb, Gershbein and Hanrahan 1997,
/// "Rendering Complex Scenes with Memory-Coherent Ray Tracing"). The hits depend on the rays and
/// the terrain only. Memory: bytes_per_ray each. Fails as StreamedSurface::load.
Result<std::vector<std::optional<terrain::SurfaceHit>>> first_hits(StreamedSurface& surface,
                                                                   std::span<const Ray> local_rays,
                                                                   Interval range,
                                                                   const ParallelOptions& parallel);
extern const std::size_t bytes_per_ray;

/// Bilinear heights at samples, metres, clamped to the terrain. Fails as StreamedSurface::load.
Result<std::vector<double>> heights_at(StreamedSurface& surface,
                                       std::span<const glm::dvec2> samples,
                                       const ParallelOptions& parallel);

} // namespace reljef::truth
