#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/core/parallel_for.h"
#include "engine/io/index/error_index.h"

namespace reljef::io {

struct IndexReport {
    std::vector<ErrorIndex::Level> levels;
    std::uint64_t bytes_of_proofs = 0;
    std::uint64_t bytes_of_heights = 0;
    std::vector<FileError> errors; ///< of tiles that remain unproven; at most one per file
};

/// Memory of a thread of make_index, about, bytes.
inline constexpr std::size_t bytes_of_index_thread = std::size_t{25} << 20U;

/// How a process makes an index beside others.
struct IndexShare {
    Shard shard;        ///< of the chunks of samples; the last process makes the coarser ones
    bool waits = false; ///< for others that write it, instead of failing
};

/// Proves all tiles of a terrain that are not proven yet, in one pass over its samples. Chunks that
/// fail leave their tiles unproven, and the coarser ones over them; the next call tries them again.
/// Fails after a stop (finished chunks are kept), if the index cannot be written, and if the source
/// changed meanwhile (then nothing is kept).
///
/// With a shard, it proves the tiles of its chunks beside other processes; IndexReport::levels tell
/// what is missing still. A call without a shard completes what killed processes left.
Result<IndexReport> make_index(const IndexSource& source, const ParallelOptions& options,
                               const IndexShare& share = {});

/// A tile as an index has it.
struct IndexedTile {
    Grid<float> heights; ///< at its vertices and one step around them, metres; NaN: void
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

} // namespace reljef::io
