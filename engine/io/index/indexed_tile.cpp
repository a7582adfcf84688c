#include "engine/io/index/indexed_tile.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "engine/io/index/sample_source.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/tree/level_fill.h"

namespace reljef::io {
namespace {

using terrain::LevelVertices;
using terrain::TileProof;
using terrain::TreeTile;

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

/// Reads tiles of an index, and fills their voids.
class FilledTiles {
public:
    FilledTiles(const IndexSource& source, const ErrorIndex& index, std::stop_token stop)
        : source_(source), index_(index), stop_(std::move(stop)) {}

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
        const TreeTile parent{tile.level + 1, tile.col / 2, tile.row / 2};
        auto coarser = read(parent);
        if (!coarser || !coarser->errors.empty()) {
            return std::nullopt;
        }
        const auto around = filled(parent, std::move(coarser->vertices));
        return around ? std::optional(filled_from(source_.tree, std::move(vertices), *around))
                      : std::nullopt;
    }
    /// Of samples, so far.
    [[nodiscard]] std::size_t bytes_read() const { return bytes_read_; }

private:
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
    std::stop_token stop_;
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

/// The heights of a tile that covers another one, or those of the tile, over the other one.
terrain::HeightRange range_over(const terrain::TileTree& tree, TreeTile tile,
                                const LevelVertices& vertices) {
    const int step = 1 << vertices.level;
    const glm::ivec2 first = terrain::TileTree::first(tile) / step - vertices.first;
    const glm::ivec2 last =
        (tree.sample(tile, tree.cells(tile)) + step - 1) / step - vertices.first;
    terrain::HeightRange range{vertices.heights(first.x, first.y),
                               vertices.heights(first.x, first.y)};
    for (int row = first.y; row <= last.y; ++row) {
        for (int col = first.x; col <= last.x; ++col) {
            const double height = vertices.heights(col, row);
            range = {std::min(range.low, height), std::max(range.high, height)};
        }
    }
    return range;
}

} // namespace

std::optional<IndexedTile> read_indexed_tile(const IndexSource& source, const ErrorIndex& index,
                                             TreeTile tile, const std::stop_token& stop) {
    FilledTiles tiles(source, index, stop);
    auto found = tiles.read(tile);
    if (!found) {
        return std::nullopt;
    }
    IndexedTile result;
    result.errors = found->errors;
    result.bytes_read = tiles.bytes_read();
    result.proof = index.find(tile);
    result.parts = found->parts;
    if (!result.proof || !result.errors.empty()) {
        result.heights = std::move(found->vertices.heights);
        return result;
    }
    check_with_proof(source, tile, *found, result);
    const Grid<float>& heights = found->vertices.heights;
    const bool has_void_samples = result.proof && result.proof->has_voids;
    if (terrain::has_voids(heights)) {
        result.was_void = voids_of(heights);
    }
    auto filled = tiles.filled(tile, std::move(found->vertices));
    if (!filled) {
        return std::nullopt;
    }
    if (has_void_samples && tile.level > 0 && !found->samples.empty()) {
        const Grid<float> samples =
            filled_samples(source.tree, tile, std::move(found->samples), filled->heights);
        result.parts = parts_of(source.tree, tile, *result.proof, filled->heights, samples);
    }
    if (const auto wider = has_void_samples ? proof_with_fill(source, index, tile) : std::nullopt) {
        result.parts = parts_of_wider(result.parts, *result.proof, *wider);
    }
    result.heights = std::move(filled->heights);
    result.bytes_read = tiles.bytes_read();
    return result;
}

std::optional<TileProof> proof_with_fill(const IndexSource& source, const ErrorIndex& index,
                                         TreeTile tile) {
    auto proof = index.find(tile);
    if (!proof || !proof->has_voids) {
        return proof;
    }
    TreeTile over = tile; // the finest one with stored heights
    while (over.level < std::min(ErrorIndex::first_stored_level, source.tree.root().level)) {
        over = {over.level + 1, over.col / 2, over.row / 2};
    }
    const auto coarse = index.find(over);
    if (!coarse) {
        return std::nullopt;
    }
    // Of a small terrain, of all heights, and of void poles.
    const bool has_heights = coarse->low <= coarse->high;
    terrain::HeightRange range{has_heights ? std::min(coarse->low, 0.0F) : 0.0F,
                               has_heights ? std::max(coarse->high, 0.0F) : 0.0F};
    if (over.level >= ErrorIndex::first_stored_level) {
        FilledTiles tiles(source, index, {});
        auto stored = tiles.read(over);
        const auto filled = stored ? tiles.filled(over, std::move(stored->vertices)) : std::nullopt;
        if (!filled) {
            return std::nullopt;
        }
        range = range_over(source.tree, tile, *filled);
        range = {range.low - coarse->error, range.high + coarse->error};
    }
    return terrain::with_fill(*proof, range, tile.level);
}

} // namespace reljef::io
