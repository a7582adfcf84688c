#pragma once

#include <functional>
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
    Shard shard; ///< of the chunks of samples; the last process makes the coarser ones
    /// Not empty: others that write it are waited for, and after a second this is called, once.
    std::function<void()> on_wait = {};
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

} // namespace reljef::io
