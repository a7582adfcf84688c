#include "engine/io/index/index_pass.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "engine/io/index/column_runs.h"
#include "engine/io/index/sample_source.h"

namespace reljef::io {
namespace {

using terrain::Chunk;
using terrain::chunk_border;
using terrain::chunk_cells;
using terrain::ChunkInput;
using terrain::levels_per_chunk;
using terrain::TileProof;
using terrain::tree_tile_cells;
using terrain::TreeTile;

/// Of those of a shard, row by row.
std::vector<Chunk> missing_chunks(const terrain::TileTree& tree, const ErrorIndex& index, int base,
                                  const Shard& shard) {
    std::vector<Chunk> chunks;
    const glm::ivec2 count = level_chunks(tree, base);
    std::size_t item = 0;
    for (int row = 0; row < count.y; ++row) {
        for (int col = 0; col < count.x; ++col) {
            const Chunk chunk{base, col, row};
            if (shard.has(item++) && !index.has(chunk)) {
                chunks.push_back(chunk);
            }
        }
    }
    return chunks;
}

void put(const Grid<float>& part, glm::ivec2 first, Grid<float>& grid) {
    const int begin = std::max(0, -first.x);
    const int end = std::min(part.cols(), grid.cols() - first.x);
    for (int row = std::max(0, -first.y); row < std::min(part.rows(), grid.rows() - first.y);
         ++row) {
        for (int col = begin; col < end; ++col) {
            grid(first.x + col, first.y + row) = part(col, row);
        }
    }
}

/// What a chunk above level 0 needs of the index.
struct StoredBase {
    /// Of the raster's vertices in the chunk and its border; on a globe also of those beyond its
    /// seam.
    Grid<float> heights;
    glm::ivec2 first{0}; ///< their first vertex
    terrain::Residuals residuals;
    Grid<TileProof> tiles;
};

/// Vertices of a level from `first` on; false if a tile is missing.
bool add_heights(const terrain::TileTree& tree, const ErrorIndex& index, int level,
                 glm::ivec2 first, Grid<float>& heights) {
    const glm::ivec2 size(heights.cols(), heights.rows());
    const glm::ivec2 last =
        glm::min((first + size - 1) / tree_tile_cells, level_tiles(tree, level) - 1);
    for (int row = first.y / tree_tile_cells; row <= last.y; ++row) {
        for (int col = first.x / tree_tile_cells; col <= last.x; ++col) {
            const auto stored = index.stored({level, col, row});
            if (!stored) {
                return false;
            }
            put(stored->heights, glm::ivec2(col, row) * tree_tile_cells - 1 - first, heights);
        }
    }
    return true;
}

bool add_heights(const terrain::TileTree& tree, const ErrorIndex& index, int level,
                 StoredBase& base) {
    const int last = level_cells(tree, level).x;
    const ColumnRange range{last + 1, tree.wrap().around ? last : 0};
    for (const ColumnRun& run : column_runs(base.first.x, base.heights.cols(), range)) {
        Grid<float> part(run.count, base.heights.rows());
        if (!add_heights(tree, index, level, {run.first, base.first.y}, part)) {
            return false;
        }
        put(part, {run.at, 0}, base.heights);
    }
    return true;
}

bool add_residuals(const terrain::TileTree& tree, const ErrorIndex& index, Chunk chunk,
                   StoredBase& base) {
    const int below = chunk.base - levels_per_chunk;
    constexpr int side = 1 << levels_per_chunk; // chunks of the level below
    const glm::ivec2 first = glm::ivec2(chunk.col, chunk.row) * side;
    const glm::ivec2 end = glm::min(first + side, level_chunks(tree, below));
    for (int row = first.y; row < end.y; ++row) {
        for (int col = first.x; col < end.x; ++col) {
            const auto part = index.residuals({below, col, row});
            if (!part) {
                return false;
            }
            const glm::ivec2 place = (glm::ivec2(col, row) - first) * (chunk_cells / side);
            put(part->low, place, base.residuals.low);
            put(part->high, place, base.residuals.high);
        }
    }
    return true;
}

bool add_tiles(const ErrorIndex& index, Chunk chunk, StoredBase& base) {
    const glm::ivec2 first = first_vertex(chunk) / tree_tile_cells;
    for (int row = 0; row < base.tiles.rows(); ++row) {
        for (int col = 0; col < base.tiles.cols(); ++col) {
            const auto proof = index.find({chunk.base, first.x + col, first.y + row});
            if (!proof) {
                return false;
            }
            base.tiles(col, row) = *proof;
        }
    }
    return true;
}

/// Absent if a part is missing.
std::optional<StoredBase> stored_base(const terrain::TileTree& tree, const ErrorIndex& index,
                                      Chunk chunk) {
    constexpr float infinite = std::numeric_limits<float>::infinity();
    const glm::ivec2 begin = first_vertex(chunk);
    const glm::ivec2 size = chunk_size(tree, chunk);
    glm::ivec2 first = glm::max(begin - chunk_border, glm::ivec2(0));
    glm::ivec2 end = glm::min(begin + size + chunk_border, level_cells(tree, chunk.base)) + 1;
    if (tree.wrap().around) {
        first.x = begin.x - chunk_border;
        end.x = begin.x + size.x + chunk_border + 1;
    }
    const glm::ivec2 tiles = glm::min(level_tiles(tree, chunk.base) - begin / tree_tile_cells,
                                      glm::ivec2(chunk_cells / tree_tile_cells));
    StoredBase base{Grid<float>(end.x - first.x, end.y - first.y),
                    first,
                    {Grid<float>(size.x, size.y, infinite), Grid<float>(size.x, size.y, -infinite)},
                    Grid<TileProof>(tiles.x, tiles.y)};
    return add_tiles(index, chunk, base) && add_residuals(tree, index, chunk, base) &&
                   add_heights(tree, index, chunk.base, base)
               ? std::optional(std::move(base))
               : std::nullopt;
}

class IndexPass {
public:
    IndexPass(const IndexSource& source, ErrorIndex& index, const ParallelOptions& options)
        : source_(source), index_(index), options_(options), samples_(source) {}

    /// The shard's chunks of samples. Fails after a stop, and if the index cannot be written.
    Result<void> read_samples(const Shard& shard) {
        return make_all(missing_chunks(source_.tree, index_, 0, shard), options_);
    }
    /// The chunks of all other levels. Fails as read_samples().
    Result<void> add_coarser_levels() {
        ParallelOptions options = options_;
        options.progress = Progress();
        Result<void> made;
        for (int base = levels_per_chunk; base < source_.tree.root().level && made;
             base += levels_per_chunk) {
            made = make_all(missing_chunks(source_.tree, index_, base, {}), options);
        }
        return made;
    }
    [[nodiscard]] std::vector<FileError> take_errors() { return std::move(errors_); }

private:
    Result<void> make_all(const std::vector<Chunk>& chunks, const ParallelOptions& options) {
        const bool done = parallel_for(
            static_cast<int>(chunks.size()),
            [&](int i) { make(chunks[static_cast<std::size_t>(i)]); }, options);
        if (failure_) {
            return *failure_;
        }
        return done ? Result<void>()
                    : Error{fmt::format("{}: was interrupted; finished parts of the index are "
                                        "kept, and the next call goes on",
                                        source_.tiles.name())};
    }

    void make(Chunk chunk) {
        if (has_failed_) {
            return;
        }
        const auto proof = chunk.base == 0 ? from_samples(chunk) : from_index(chunk);
        if (!proof || options_.stop.stop_requested()) {
            return;
        }
        if (auto written = index_.write(chunk, *proof); !written) {
            const std::lock_guard lock(mutex_);
            has_failed_ = true;
            failure_ = written.error();
        }
    }

    std::optional<terrain::ChunkProof> from_samples(Chunk chunk) {
        const SampleWindow window =
            samples_.read(first_vertex(chunk) - chunk_border,
                          chunk_size(source_.tree, chunk) + 1 + 2 * chunk_border, options_.stop);
        if (!window.errors().empty()) {
            const std::lock_guard lock(mutex_);
            for (const FileError& error : window.errors()) {
                const bool is_new =
                    std::none_of(errors_.begin(), errors_.end(),
                                 [&](const FileError& known) { return known.file == error.file; });
                if (is_new) {
                    errors_.push_back(error);
                }
            }
            return std::nullopt;
        }
        const auto rows = [&](int row, std::span<float> heights) { window.copy_row(row, heights); };
        return prove_chunk(source_.tree, chunk, {rows});
    }

    std::optional<terrain::ChunkProof> from_index(Chunk chunk) {
        const auto base = stored_base(source_.tree, index_, chunk);
        if (!base) {
            return std::nullopt;
        }
        const glm::ivec2 first = first_vertex(chunk) - chunk_border - base->first;
        const auto rows = [&](int row, std::span<float> heights) {
            for (std::size_t i = 0; i < heights.size(); ++i) {
                heights[i] = base->heights.clamped(first.x + static_cast<int>(i), first.y + row);
            }
        };
        return prove_chunk(source_.tree, chunk, {rows, &base->residuals, &base->tiles});
    }

    const IndexSource& source_;
    ErrorIndex& index_;
    const ParallelOptions& options_;
    const SampleSource samples_;
    std::atomic<bool> has_failed_{false};
    std::mutex mutex_;
    std::optional<Error> failure_;
    std::vector<FileError> errors_;
};

bool is_whole(const std::vector<ErrorIndex::Level>& levels) {
    return std::all_of(levels.begin(), levels.end(),
                       [](const ErrorIndex::Level& level) { return level.unproven == 0; });
}

Error changed_meanwhile(const IndexSource& source) {
    return {fmt::format("{}: changed while it was indexed, the same files at the end were "
                        "expected; nothing is kept",
                        source.tiles.name())};
}

/// Proves what is missing; returns the errors of files.
Result<std::vector<FileError>> add_missing(const IndexSource& source,
                                           const ParallelOptions& options, ErrorIndex& index,
                                           const Shard& shard) {
    IndexPass pass(source, index, options);
    auto done = pass.read_samples(shard);
    const bool is_last = done && (shard.is_whole() || index.claim());
    if (is_last) {
        done = pass.add_coarser_levels();
    }
    if (options.stop.stop_requested() && !done) {
        return done.error();
    }
    const auto now = source.tiles.fingerprint();
    if (!now || *now != source.fingerprint) {
        index.remove();
        return changed_meanwhile(source);
    }
    if (!done) {
        return done.error();
    }
    if (auto completed = is_last && is_whole(index.levels()) ? index.complete() : Result<void>();
        !completed) {
        return completed.error();
    }
    return pass.take_errors();
}

} // namespace

Result<IndexReport> make_index(const IndexSource& source, const ParallelOptions& options,
                               const IndexShare& share) {
    const IndexAccess alone = share.on_wait ? IndexAccess::queued : IndexAccess::alone;
    auto index = ErrorIndex::open_to_write(
        source, share.shard.is_whole() ? alone : IndexAccess::shared, options.stop, share.on_wait);
    if (!index) {
        return index.error();
    }
    IndexReport report;
    report.levels = index->levels();
    if (!index->is_complete() || !is_whole(report.levels)) {
        auto errors = add_missing(source, options, *index, share.shard);
        if (!errors) {
            return errors.error();
        }
        report.errors = std::move(*errors);
        report.levels = index->levels();
    }
    report.bytes_of_proofs = index->bytes_of_proofs();
    report.bytes_of_heights = index->bytes_of_heights();
    return report;
}

} // namespace reljef::io
