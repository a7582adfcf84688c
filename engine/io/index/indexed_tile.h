#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "engine/core/grid.h"
#include "engine/io/index/error_index.h"

namespace reljef::io {

/// A tile as an index has it.
struct IndexedTile {
    /// At its vertices and one step around them, metres. Voids are filled in proven tiles, else
    /// NaN.
    Grid<float> heights;
    Grid<std::uint8_t> was_void; ///< 1: filled, see terrain/tree/level_fill.h; empty: none
    /// Its range contains what fills voids, too. Absent: unproven.
    std::optional<terrain::TileProof> proof;
    terrain::PartShares parts{};   ///< of the proof
    std::vector<FileError> errors; ///< then the heights are unusable
    std::size_t bytes_read = 0;    ///< of samples
};

/// The tiles of an index. Thread-safe. Valid as long as source and index.
class IndexedTiles {
public:
    IndexedTiles(const IndexSource& source, const ErrorIndex& index);
    ~IndexedTiles();

    /// Reads a tile's heights, from samples below ErrorIndex::first_stored_level, and checks them
    /// against its proof: a contradiction is an error of the index file, without a proof. Absent if
    /// the index has no such heights.
    [[nodiscard]] std::optional<IndexedTile> read(terrain::TreeTile tile,
                                                  const std::stop_token& stop = {}) const;
    /// As IndexedTile::proof. May read stored heights of the index.
    [[nodiscard]] std::optional<terrain::TileProof> proof(terrain::TreeTile tile) const;

private:
    class Fills;

    const IndexSource& source_;
    const ErrorIndex& index_;
    std::unique_ptr<Fills> fills_; ///< those of the last tiles
};

} // namespace reljef::io
