#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>

#include "engine/io/index/error_index.h"
#include "engine/io/index/indexed_tile.h"
#include "engine/scene/streaming/tile_stream.h"
#include "engine/terrain/tree/tile_error.h"

namespace reljef::session {

/// The proven tiles of a stream, from the index of its terrain. The stream's tree may be finer than
/// the samples: such tiles show parts of tiles of all samples. Once a tile contradicts its proof,
/// or a proof the one of the coarser tile, no tile is proven any more. Thread-safe.
class ProvenTiles {
public:
    /// `refinement`: samples of the stream's tree per sample of the terrain, a power of two.
    ProvenTiles(io::IndexSource source, io::ErrorIndex index, int refinement);

    /// Whether all tiles are proven.
    [[nodiscard]] bool is_complete() const { return index_.is_complete(); }
    /// Absent: unproven.
    [[nodiscard]] std::optional<terrain::TileProof> find(terrain::TreeTile tile) const;
    /// Reads the heights that a tile's proof holds for. Absent if it is unproven.
    [[nodiscard]] std::optional<scene::TileContent> read(terrain::TreeTile tile,
                                                         const std::stop_token& stop) const;
    /// Whether there was a contradiction.
    [[nodiscard]] bool is_wrong() const { return is_wrong_; }
    /// The contradiction, once.
    [[nodiscard]] std::optional<FileError> take_error() const;

private:
    /// Whether the index has a possible proof of a tile. It may lack what fills its voids.
    [[nodiscard]] bool may_be_proven(terrain::TreeTile at) const;
    void contradict(const std::string& error) const;
    /// The tile of the index that a tile of the stream is, or is a part of.
    [[nodiscard]] terrain::TreeTile indexed(terrain::TreeTile tile) const;
    /// The vertices that a tile finer than the samples has of a tile of all samples, with one step
    /// around them. `was_void`: as TileContent::was_void.
    [[nodiscard]] scene::FilledHeights part(terrain::TreeTile tile, const Grid<float>& samples,
                                            const Grid<std::uint8_t>& was_void) const;

    io::IndexSource source_;
    io::ErrorIndex index_;
    io::IndexedTiles tiles_; ///< of these two
    int level_of_samples_;
    mutable std::atomic<bool> is_wrong_{false};
    mutable std::mutex mutex_;
    mutable std::optional<FileError> error_;
};

} // namespace reljef::session
