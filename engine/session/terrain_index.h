#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>

#include "engine/io/index/index_pass.h"
#include "engine/session/log.h"
#include "engine/session/options.h"
#include "engine/session/terrain_source.h"

namespace reljef::session {

struct IndexedTerrain {
    std::optional<io::IndexReport> report; ///< absent: it needs no index
    std::string reason;                    ///< why it needs none: a sentence
    std::filesystem::path file;            ///< of the index
    double seconds = 0.0;
};

/// Makes or completes the index of a terrain that does not fit the memory. Logs progress. Fails as
/// open_heights, io::index_source and io::make_index, and without a cache folder. `shard`: the part
/// of the index that this process makes; others may make theirs at the same time.
Result<IndexedTerrain> index_terrain(const SourceOptions& options, Log& log,
                                     const std::stop_token& stop, const Shard& shard = {});

/// The proofs of a streamed source, from its index, which is made or completed first; waits for
/// other processes that do so. Logs progress, and a note if files cannot be read, whose tiles
/// remain unproven. Fails as io::index_source and io::make_index, and for files on servers, because
/// that reads all of them.
Result<std::shared_ptr<const ProvenTiles>>
make_proofs(const TerrainSource& source, unsigned threads, Log& log, const std::stop_token& stop);

/// Adds TerrainSource::proofs to a streamed source: from an index that is there, or from
/// make_proofs() with `makes_index`. A note says why there are none. Fails only after a stop.
Result<void> add_proofs(TerrainSource& source, bool makes_index, Log& log,
                        const std::stop_token& stop);

/// A note on a terrain without proofs: the reason, and "; the errors of tiles are estimated".
std::string unproven_note(const Error& reason);

} // namespace reljef::session
