#include "engine/io/index/indexed_tile.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <mutex>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "engine/io/index/sample_source.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/tree/level_fill.h"

namespace reljef::io {

using terrain::LevelVertices;
using terrain::TileProof;
using terrain::TreeTile;

/// The filled heights of stored tiles: tiles in them need these again.
class IndexedTiles::Fills {
public:
    /// Null: they cannot be filled.
    using Filled = std::shared_ptr<const LevelVertices>;

    template <class Make> Filled find_or_make(TreeTile tile, const Make& make) {
        {
            const std::lock_guard lock(mutex_);
            const auto found = std::find_if(last_.begin(), last_.end(),
                                            [&](const Entry& entry) { return entry.tile == tile; });
            if (found != last_.end()) {
                return found->filled;
            }
        }
        Filled filled = make();
        const std::lock_guard lock(mutex_);
        last_.push_front({tile, filled});
        last_.resize(std::min(last_.size(), kept_tiles));
        return filled;
    }

private:
    static constexpr std::size_t kept_tiles = 32; // 18 kB each
    struct Entry {
        TreeTile tile;
        Filled filled;
    };

    std::mutex mutex_;
    std::deque<Entry> last_;
};

namespace {

/// A tile whose voids are not filled.
struct TileWithVoids {
    LevelVertices vertices;      ///< of the tile and one step around them
    Grid<float> samples;         ///< as for heights_from_samples; empty: the index has the vertices
    terrain::PartShares parts{}; ///< without samples
    std::vector<FileError> errors;
};

/// 1: a void.
Grid<std::uint8_t> voids_of(const Grid<float>& heights) {
    Grid<std::uint8_t> voids(heights.cols(), heights.rows());
    std::transform(heights.samples().begin(), heights.samples().end(), voids.samples().begin(),
                   [](float height) { return std::isnan(height) ? 1 : 0; });
    return voids;
}

/// Reads tiles of an index, and fills their voids. `Fills`: IndexedTiles::Fills.
template <class Fills> class FilledTiles {
public:
    FilledTiles(const IndexSource& source, const ErrorIndex& index, Fills& fills,
                std::stop_token stop)
        : source_(source), index_(index), fills_(fills), stop_(std::move(stop)) {}

    /// Absent if the index does not have it.
    [[nodiscard]] std::optional<TileWithVoids> read(TreeTile tile) {
        TileWithVoids found{
            .vertices = {tile.level, glm::ivec2(tile.col, tile.row) * terrain::tree_tile_cells - 1},
            .samples = {},
            .errors = {}};
        if (tile.level < ErrorIndex::first_stored_level) {
            read_samples(tile, found);
            return found;
        }
        auto stored = index_.stored(tile);
        if (!stored) {
            return std::nullopt;
        }
        found.vertices.heights = std::move(stored->heights);
        found.parts = stored->parts;
        return found;
    }

    /// Fills a tile's voids. Absent if coarser tiles cannot be read.
    [[nodiscard]] std::optional<LevelVertices> filled(TreeTile tile, LevelVertices vertices) {
        if (!terrain::has_voids(vertices.heights)) {
            return vertices;
        }
        if (tile == source_.tree.root()) {
            return filled_root(std::move(vertices));
        }
        const auto around = filled_parent({tile.level + 1, tile.col / 2, tile.row / 2});
        return around != nullptr
                   ? std::optional(filled_from(source_.tree, std::move(vertices), *around))
                   : std::nullopt;
    }

    /// A stored tile. Null if it or coarser ones cannot be read.
    [[nodiscard]] typename Fills::Filled filled_stored(TreeTile tile) {
        return fills_.find_or_make(tile, [&] { return made_filled(tile); });
    }

    /// Of coarser tiles, if these cannot be read.
    [[nodiscard]] const std::vector<FileError>& errors() const { return errors_; }
    /// Of samples, so far.
    [[nodiscard]] std::size_t bytes_read() const { return bytes_read_; }

private:
    [[nodiscard]] typename Fills::Filled filled_parent(TreeTile parent) {
        return parent.level < ErrorIndex::first_stored_level ? made_filled(parent)
                                                             : filled_stored(parent);
    }

    [[nodiscard]] typename Fills::Filled made_filled(TreeTile tile) {
        auto found = read(tile);
        if (!found) {
            return nullptr;
        }
        if (!found->errors.empty()) {
            errors_ = std::move(found->errors);
            return nullptr;
        }
        auto made = filled(tile, std::move(found->vertices));
        return made ? std::make_shared<const LevelVertices>(std::move(*made)) : nullptr;
    }

    void read_samples(TreeTile tile, TileWithVoids& found) {
        const int border = terrain::sample_border(tile.level);
        const glm::ivec2 size =
            source_.tree.cells(tile) * terrain::TileTree::step(tile) + 1 + 2 * border;
        const SampleWindow window =
            read_sample_window(source_, terrain::TileTree::first(tile) - border, size, stop_);
        found.samples = Grid<float>(size.x, size.y);
        for (int row = 0; row < size.y; ++row) {
            window.copy_row(row, found.samples.row(row));
        }
        found.errors = window.errors();
        bytes_read_ += window.bytes_read();
        found.vertices.heights = terrain::heights_from_samples(source_.tree, tile, found.samples);
    }

    /// Nothing coarser is known: a membrane, which is closed on a globe.
    [[nodiscard]] LevelVertices filled_root(LevelVertices vertices) const {
        Grid<float>& heights = vertices.heights;
        terrain::fill_voids(heights, voids_of(heights));
        const int last = heights.cols() - 2; // vertex
        for (int row = 0; source_.tree.wraps_longitude() && row < heights.rows(); ++row) {
            heights(last, row) = heights(1, row);
        }
        return vertices;
    }

    const IndexSource& source_;
    const ErrorIndex& index_;
    Fills& fills_;
    std::stop_token stop_;
    std::vector<FileError> errors_;
    std::size_t bytes_read_ = 0;
};

/// Compares a tile with its proof.
void check_with_proof(const IndexSource& source, TreeTile tile, const TileWithVoids& found,
                      IndexedTile& result) {
    terrain::ProofCheck check =
        check_proof(source.tree, tile, *result.proof, found.vertices.heights,
                    found.samples.empty() ? nullptr : &found.samples);
    if (found.samples.empty() && !terrain::are_parts_of(found.parts, result.proof->block_shares)) {
        check.contradiction = "errors of its parts found that are not those of its blocks, the "
                              "same were expected";
    }
    result.parts = check.parts.value_or(found.parts);
    if (const auto& wrong = check.contradiction) {
        result.proof.reset();
        result.errors.push_back(
            {source.file,
             fmt::format("{}: tile {} of level {}: {}", source.file.string(),
                         fmt::format("({},{})", tile.col, tile.row), tile.level, *wrong)});
    }
}

/// The heights of a tile that covers another one, or those of the tile, over the other one. Absent
/// if some are no numbers, or infinite.
std::optional<terrain::HeightRange> range_over(const terrain::TileTree& tree, TreeTile tile,
                                               const LevelVertices& vertices) {
    const int step = 1 << vertices.level;
    const glm::ivec2 first = terrain::TileTree::first(tile) / step - vertices.first;
    const glm::ivec2 last =
        (tree.sample(tile, tree.cells(tile)) + step - 1) / step - vertices.first;
    terrain::HeightRange range{std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity()};
    for (int row = first.y; row <= last.y; ++row) {
        for (int col = first.x; col <= last.x; ++col) {
            const double height = vertices.heights(col, row);
            if (!std::isfinite(height)) {
                return std::nullopt;
            }
            range = {std::min(range.low, height), std::max(range.high, height)};
        }
    }
    return range;
}

/// Of a small terrain all heights, and void poles.
terrain::HeightRange range_of_all(const terrain::TileTree& tree, const TileProof& proof) {
    const bool has_heights = proof.low <= proof.high;
    if (has_heights && !tree.wrap().begins_at_pole && !tree.wrap().ends_at_pole) {
        return {proof.low, proof.high};
    }
    return {has_heights ? std::min(proof.low, 0.0F) : 0.0F,
            has_heights ? std::max(proof.high, 0.0F) : 0.0F};
}

} // namespace

IndexedTiles::IndexedTiles(const IndexSource& source, const ErrorIndex& index)
    : source_(source), index_(index), fills_(std::make_unique<Fills>()) {}

IndexedTiles::~IndexedTiles() = default;

std::optional<IndexedTile> IndexedTiles::read(TreeTile tile, const std::stop_token& stop) const {
    FilledTiles tiles(source_, index_, *fills_, stop);
    auto found = tiles.read(tile);
    if (!found) {
        return std::nullopt;
    }
    IndexedTile result;
    result.errors = found->errors;
    result.bytes_read = tiles.bytes_read();
    result.proof = index_.find(tile);
    result.parts = found->parts;
    if (result.proof && result.errors.empty()) {
        check_with_proof(source_, tile, *found, result);
    }
    if (!result.proof || !result.errors.empty()) {
        result.heights = std::move(found->vertices.heights);
        return result;
    }
    if (terrain::has_voids(found->vertices.heights)) {
        result.was_void = voids_of(found->vertices.heights);
    }
    auto filled = tiles.filled(tile, found->vertices);
    result.bytes_read = tiles.bytes_read();
    if (!filled) {
        if (tiles.errors().empty()) {
            return std::nullopt;
        }
        result.errors = tiles.errors();
        result.proof.reset();
        result.heights = std::move(found->vertices.heights);
        return result;
    }
    if (result.proof->has_voids) {
        if (tile.level > 0 && !found->samples.empty()) {
            const Grid<float> samples =
                filled_samples(source_.tree, tile, std::move(found->samples), filled->heights);
            result.parts = parts_of(source_.tree, tile, *result.proof, filled->heights, samples);
        }
        const auto wider = proof(tile);
        if (wider) {
            result.parts = parts_of_wider(result.parts, *result.proof, *wider);
        }
        result.proof = wider;
    }
    result.heights = std::move(filled->heights);
    return result;
}

std::optional<TileProof> IndexedTiles::proof(TreeTile tile) const {
    auto proof = index_.find(tile);
    if (!proof || !proof->has_voids) {
        return proof;
    }
    TreeTile over = tile; // the finest one with stored heights
    while (over.level < std::min(ErrorIndex::first_stored_level, source_.tree.root().level)) {
        over = {over.level + 1, over.col / 2, over.row / 2};
    }
    const auto coarse = index_.find(over);
    if (!coarse) {
        return std::nullopt;
    }
    if (over.level < ErrorIndex::first_stored_level) {
        return terrain::with_fill(*proof, range_of_all(source_.tree, *coarse), tile.level);
    }
    const auto filled =
        FilledTiles(source_, index_, *fills_, std::stop_token()).filled_stored(over);
    const auto range = filled != nullptr ? range_over(source_.tree, tile, *filled) : std::nullopt;
    if (!range) {
        return std::nullopt;
    }
    return terrain::with_fill(*proof, {range->low - coarse->error, range->high + coarse->error},
                              tile.level);
}

} // namespace reljef::io
