#include "engine/io/index/error_index.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstring>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/io/cache/cache_file.h"
#include "engine/io/cache/fnv_hash.h"
#include "engine/io/index/index_format.h"
#include "engine/io/index/proof_block.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/tree_tile.h"

namespace reljef::io {
namespace fs = std::filesystem;
using terrain::Chunk;
using terrain::levels_per_chunk;
using terrain::TileProof;
using terrain::tree_tile_cells;
using terrain::TreeTile;

namespace {

/// Cells of the highest of a chunk's levels.
glm::ivec2 residual_size(const terrain::TileTree& tree, Chunk chunk) {
    return chunk_size(tree, chunk) / (1 << levels_per_chunk);
}

/// Of the proofs of a chunk.
std::size_t bytes_of_chunk(const terrain::TileTree& tree, Chunk chunk) {
    return bytes_of_block(floats_of_proofs(tiles_with_proof(tree, chunk)));
}

/// Of the proofs of a row of chunks.
std::size_t bytes_of_row(const terrain::TileTree& tree, Chunk first) {
    const int last = level_chunks(tree, first.base).x - 1;
    return static_cast<std::size_t>(last) * bytes_of_chunk(tree, first) +
           bytes_of_chunk(tree, {first.base, last, first.row});
}

} // namespace

fs::path index_file(const TileSet& tiles, const TileGrid& grid, Gaps gaps,
                    const fs::path& cache_folder) {
    const std::string what =
        fmt::format("{}\n{:.17g} {:.17g} {:.17g} {:.17g} {} {} {} {:.17g} {:.17g}{}",
                    full_name(tiles.name()), grid.first.x, grid.first.y, grid.step.x, grid.step.y,
                    grid.cols, grid.rows, gaps == Gaps::sea ? 1 : 0, tiles.options().height_scale,
                    tiles.options().height_offset, tiles.wrap(grid).around ? " globe" : "");
    return cache_folder / fmt::format("{:016x}.index", fnv_hash(what));
}

Result<IndexSource> index_source(TileSet tiles, const TileGrid& grid, Gaps gaps,
                                 const fs::path& cache_folder) {
    const WrappedGrid closed = wrapped_grid(grid, tiles.wrap(grid), 1);
    const int longer = std::max(closed.grid.cols, closed.grid.rows);
    if (std::min(grid.cols, grid.rows) < 2 || longer > terrain::max_tree_samples) {
        return Error{fmt::format("{}: {}×{} samples found, 2 to {} a side were expected",
                                 tiles.name(), grid.cols, grid.rows, terrain::max_tree_samples)};
    }
    const auto fingerprint = tiles.fingerprint();
    if (!fingerprint) {
        return fingerprint.error();
    }
    const auto poles = pole_heights(tiles, closed.wrap);
    if (!poles) {
        return poles.error();
    }
    const fs::path file = index_file(tiles, grid, gaps, cache_folder);
    return IndexSource{std::move(tiles),
                       grid,
                       gaps,
                       terrain::TileTree(closed.grid.cols, closed.grid.rows, closed.wrap),
                       *fingerprint,
                       file,
                       static_cast<float>(poles->north),
                       static_cast<float>(poles->south)};
}

ErrorIndex::ErrorIndex(const IndexSource& source, Descriptor file)
    : path_(source.file), tree_(source.tree), fingerprint_(source.fingerprint),
      file_(std::move(file)), places_(static_cast<std::size_t>(tree_.root().level) + 1) {
    std::uint64_t end = sizeof(IndexHeader);
    for (int base = 0; base == 0 || base < tree_.root().level; base += levels_per_chunk) {
        places_[static_cast<std::size_t>(base)].proofs = end;
        const int last = level_chunks(tree_, base).y - 1;
        end += static_cast<std::size_t>(last) * bytes_of_row(tree_, {base, 0, 0}) +
               bytes_of_row(tree_, {base, 0, last});
    }
    for (int level = first_stored_level; level <= tree_.root().level; ++level) {
        places_[static_cast<std::size_t>(level)].tiles = end;
        end += count_of(level_tiles(tree_, level)) * bytes_of_block(floats_of_tile);
    }
    interim_ = end;
    for (int level = levels_per_chunk; level < tree_.root().level; level += levels_per_chunk) {
        places_[static_cast<std::size_t>(level)].residuals = end;
        end += count_of(level_chunks(tree_, level - levels_per_chunk)) *
               bytes_of_block(floats_of_residuals);
    }
}

Error ErrorIndex::error(const char* what) const {
    return {fmt::format("{}: cannot be {}: {}", path_.string(), what, std::strerror(errno))};
}

std::string ErrorIndex::header(bool is_complete) const {
    IndexHeader header;
    header.cols = tree_.cols();
    header.rows = tree_.rows();
    header.is_complete = is_complete ? 1 : 0;
    header.source = fingerprint_;
    std::string bytes(reinterpret_cast<const char*>(&header), sizeof(header));
    header.seal = fnv_hash(bytes);
    bytes.assign(reinterpret_cast<const char*>(&header), sizeof(header));
    return bytes;
}

Result<std::optional<ErrorIndex>> ErrorIndex::open(const IndexSource& source) {
    auto file = open_cache_file(source.file, CacheAccess::read);
    if (!file) {
        return file.error();
    }
    if (!*file) {
        return std::optional<ErrorIndex>();
    }
    ErrorIndex index(source, std::move(**file));
    std::string found(sizeof(IndexHeader), '\0');
    static_cast<void>(index.read_at(0, std::as_writable_bytes(std::span(found))));
    const bool was_complete = found == index.header(true);
    if (!was_complete && found != index.header(false)) {
        return Error{fmt::format("{}: no index (version {}) of the present state of {} found, one "
                                 "was expected; 'reljef index' makes it",
                                 source.file.string(), index_version, source.tiles.name())};
    }
    index.is_complete_ = was_complete && index.has_all_parts();
    index.is_damaged_ = was_complete && !index.is_complete_;
    return std::optional(std::move(index));
}

bool ErrorIndex::has_all_parts() const {
    struct stat file {};
    if (::fstat(file_.number(), &file) != 0 ||
        static_cast<std::uint64_t>(std::max<off_t>(file.st_size, 0)) < interim_) {
        return false;
    }
    const std::vector<Level> found = levels();
    return std::all_of(found.begin(), found.end(),
                       [](const Level& level) { return level.unproven == 0; });
}

bool ErrorIndex::has_all_heights() const {
    for (int level = first_stored_level; has_level(level); ++level) {
        const glm::ivec2 tiles = level_tiles(tree_, level);
        for (int row = 0; row < tiles.y; ++row) {
            for (int col = 0; col < tiles.x; ++col) {
                if (!read_block(tile_at({level, col, row}), floats_of_tile)) {
                    return false;
                }
            }
        }
    }
    return true;
}

bool ErrorIndex::has_level(int level) const {
    return level >= 0 && level <= tree_.root().level;
}

// Row after row: all chunks of a row but the last one have blocks of one length, as have all rows.
std::uint64_t ErrorIndex::proofs_at(Chunk chunk) const {
    const Chunk first{chunk.base, 0, chunk.row};
    return places_[static_cast<std::size_t>(chunk.base)].proofs +
           static_cast<std::size_t>(chunk.row) * bytes_of_row(tree_, {chunk.base, 0, 0}) +
           static_cast<std::size_t>(chunk.col) * bytes_of_chunk(tree_, first);
}

std::uint64_t ErrorIndex::tile_at(TreeTile tile) const {
    return places_[static_cast<std::size_t>(tile.level)].tiles +
           index_in(level_tiles(tree_, tile.level), tile.col, tile.row) *
               bytes_of_block(floats_of_tile);
}

std::uint64_t ErrorIndex::residuals_at(Chunk chunk) const {
    return places_[static_cast<std::size_t>(chunk.base) + levels_per_chunk].residuals +
           index_in(level_chunks(tree_, chunk.base), chunk.col, chunk.row) *
               bytes_of_block(floats_of_residuals);
}

bool ErrorIndex::read_at(std::uint64_t place, std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t count =
            ::pread(file_.number(), bytes.data(), bytes.size(), static_cast<off_t>(place));
        if (count == 0 || (count < 0 && errno != EINTR)) {
            return false;
        }
        const auto done = static_cast<std::size_t>(std::max<ssize_t>(count, 0));
        bytes = bytes.subspan(done);
        place += done;
    }
    return true;
}

Result<void> ErrorIndex::write_at(std::uint64_t place, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t count =
            ::pwrite(file_.number(), bytes.data(), bytes.size(), static_cast<off_t>(place));
        if (count < 0 && errno != EINTR) {
            return error("written");
        }
        const auto done = static_cast<std::size_t>(std::max<ssize_t>(count, 0));
        bytes = bytes.subspan(done);
        place += done;
    }
    return {};
}

std::optional<std::vector<float>> ErrorIndex::read_block(std::uint64_t place,
                                                         std::size_t floats) const {
    std::vector<float> block(floats + 2);
    std::uint64_t seal = 0;
    if (!read_at(place, std::as_writable_bytes(std::span(block)))) {
        return std::nullopt;
    }
    std::memcpy(&seal, block.data() + floats, sizeof(seal));
    block.resize(floats);
    return seal == seal_of(block, place, fingerprint_) ? std::optional(std::move(block))
                                                       : std::nullopt;
}

Result<void> ErrorIndex::write_block(std::uint64_t place, std::vector<float> floats) {
    const std::uint64_t seal = seal_of(floats, place, fingerprint_);
    floats.resize(floats.size() + 2);
    std::memcpy(floats.data() + floats.size() - 2, &seal, sizeof(seal));
    return write_at(place, std::as_bytes(std::span(floats)));
}

std::optional<std::vector<float>> ErrorIndex::read_proofs(Chunk chunk) const {
    return read_block(proofs_at(chunk), floats_of_proofs(tiles_with_proof(tree_, chunk)));
}

std::optional<TileProof> ErrorIndex::find(TreeTile tile) const {
    const glm::ivec2 count = has_level(tile.level) ? level_tiles(tree_, tile.level) : glm::ivec2(0);
    if (tile.col < 0 || tile.row < 0 || tile.col >= count.x || tile.row >= count.y) {
        return std::nullopt;
    }
    const Chunk chunk = chunk_with_proof(tile);
    const auto block = read_proofs(chunk);
    return block ? std::optional(unpacked_proof(tiles_with_proof(tree_, chunk), *block, tile))
                 : std::nullopt;
}

std::optional<ErrorIndex::StoredTile> ErrorIndex::stored(TreeTile tile) const {
    if (tile.level < first_stored_level || !has_level(tile.level)) {
        return std::nullopt;
    }
    const auto block = read_block(tile_at(tile), floats_of_tile);
    if (!block) {
        return std::nullopt;
    }
    StoredTile stored{grid_from(*block, tree_.cells(tile) + 3, side_of_heights)};
    std::memcpy(stored.parts.data(), block->data() + floats_of_heights, bytes_of_parts);
    return stored;
}

std::optional<terrain::Residuals> ErrorIndex::residuals(Chunk chunk) const {
    const auto block = read_block(residuals_at(chunk), floats_of_residuals);
    if (!block) {
        return std::nullopt;
    }
    const std::span<const float> floats(*block);
    const glm::ivec2 size = residual_size(tree_, chunk);
    return terrain::Residuals{
        grid_from(floats, size, side_of_residuals),
        grid_from(floats.subspan(floats_of_residuals / 2), size, side_of_residuals)};
}

bool ErrorIndex::has(Chunk chunk) const {
    return read_proofs(chunk).has_value();
}

Result<void> ErrorIndex::write_tiles(int level, glm::ivec2 first, const terrain::ChunkLevel& made) {
    for (int row = 0; row < made.tiles.rows(); ++row) {
        for (int col = 0; col < made.tiles.cols(); ++col) {
            const TreeTile tile{level, first.x + col, first.y + row};
            const glm::ivec2 size = tree_.cells(tile) + 3;
            std::vector<float> floats(floats_of_tile);
            std::memcpy(floats.data() + floats_of_heights, made.parts(col, row).data(),
                        bytes_of_parts);
            const glm::ivec2 from = glm::ivec2(col, row) * tree_tile_cells + (made.border - 1);
            for (int y = 0; y < size.y; ++y) {
                const auto heights = made.heights.row(from.y + y);
                std::copy_n(heights.begin() + from.x, size.x,
                            floats.begin() + std::ptrdiff_t{y} * side_of_heights);
            }
            if (auto written = write_block(tile_at(tile), std::move(floats)); !written) {
                return written;
            }
        }
    }
    return {};
}

// Proofs come last: they say that a chunk is there.
Result<void> ErrorIndex::write(Chunk chunk, const terrain::ChunkProof& proof) {
    const glm::ivec2 first = first_vertex(chunk) / tree_tile_cells;
    Result<void> written;
    for (int i = 0; i < levels_per_chunk && written; ++i) {
        const int level = chunk.base + i + 1;
        if (has_level(level) && level >= first_stored_level) {
            written =
                write_tiles(level, first / (2 << i), proof.levels.at(static_cast<std::size_t>(i)));
        }
    }
    if (written && chunk.base + levels_per_chunk < tree_.root().level) {
        const terrain::Residuals& residuals = proof.levels.back().residuals;
        std::vector<float> floats(floats_of_residuals);
        copy_into(residuals.low, floats, side_of_residuals);
        copy_into(residuals.high, std::span(floats).subspan(floats_of_residuals / 2),
                  side_of_residuals);
        written = write_block(residuals_at(chunk), std::move(floats));
    }
    return written
               ? write_block(proofs_at(chunk), packed_proofs(tiles_with_proof(tree_, chunk), proof))
               : written;
}

std::vector<ErrorIndex::Level> ErrorIndex::levels() const {
    std::vector<Level> levels(places_.size());
    for (int base = 0; base == 0 || base < tree_.root().level; base += levels_per_chunk) {
        const glm::ivec2 chunks = level_chunks(tree_, base);
        for (int row = 0; row < chunks.y; ++row) {
            for (int col = 0; col < chunks.x; ++col) {
                add_to(levels, {base, col, row});
            }
        }
    }
    return levels;
}

void ErrorIndex::add_to(std::vector<Level>& levels, Chunk chunk) const {
    const auto block = read_proofs(chunk);
    const std::vector<TileRange> ranges = tiles_with_proof(tree_, chunk);
    for (const TileRange& range : ranges) {
        Level& level = levels.at(static_cast<std::size_t>(range.level));
        level.tiles += count_of(range.count);
        level.unproven += block ? 0 : count_of(range.count);
        const glm::ivec2 end = block ? range.first + range.count : range.first;
        for (int row = range.first.y; row < end.y; ++row) {
            for (int col = range.first.x; col < end.x; ++col) {
                const TileProof tile = unpacked_proof(ranges, *block, {range.level, col, row});
                level.max_error = std::max(level.max_error, tile.error);
            }
        }
    }
}

std::uint64_t ErrorIndex::bytes_of_proofs() const {
    std::uint64_t bytes = interim_;
    for (int level = first_stored_level; level <= tree_.root().level; ++level) {
        bytes -=
            count_of(level_tiles(tree_, level)) * (bytes_of_block(floats_of_tile) - bytes_of_parts);
    }
    return bytes;
}

std::uint64_t ErrorIndex::bytes_of_heights() const {
    return interim_ - bytes_of_proofs();
}

Result<void> ErrorIndex::complete() {
    const std::string bytes = header(true);
    if (auto written = write_at(0, std::as_bytes(std::span(bytes))); !written) {
        return written;
    }
    is_complete_ = true;
    return ::ftruncate(file_.number(), static_cast<off_t>(interim_)) == 0 ? Result<void>()
                                                                          : error("written");
}

Result<void> ErrorIndex::clear() {
    is_complete_ = false;
    if (::ftruncate(file_.number(), 0) != 0) {
        return error("written");
    }
    const std::string bytes = header(false);
    return write_at(0, std::as_bytes(std::span(bytes)));
}

void ErrorIndex::remove() {
    std::error_code ignored;
    fs::remove(path_, ignored);
}

} // namespace reljef::io
