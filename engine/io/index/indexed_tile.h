#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

#include "engine/core/grid.h"
#include "engine/io/index/error_index.h"

namespace reljef::io {

/// A tile as an index has it.
struct IndexedTile {
    Grid<float> heights; ///< at its vertices and one step around them, metres; voids are filled
    Grid<std::uint8_t> was_void; ///< 1: filled, see terrain/tree/level_fill.h; empty: none
    std::optional<terrain::TileProof> proof; ///< absent: unproven
    terrain::PartShares parts{};             ///< of the proof
    std::vector<FileError> errors;           ///< then the heights are unusable
    std::size_t bytes_read = 0;              ///< of samples
};

/// Reads a tile's heights, from samples below ErrorIndex::first_stored_level, and checks them
/// against its proof: a contradiction is an error of the index file, without a proof. Absent if the
/// index has no such heights.
std::optional<IndexedTile> read_indexed_tile(const IndexSource& source, const ErrorIndex& index,
                                             terrain::TreeTile tile,
                                             const std::stop_token& stop = {});

/// The proof of a tile whose range contains what fills its voids, too. Absent: unproven.
std::optional<terrain::TileProof> proof_with_fill(const IndexSource& source,
                                                  const ErrorIndex& index, terrain::TreeTile tile);

} // namespace reljef::io
