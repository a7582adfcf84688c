#include "engine/terrain/tree/tile_error.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/common.hpp>

#include "engine/core/check.h"
#include "engine/terrain/tree/column_ranges.h"
#include "engine/terrain/tree/level_fill.h"
#include "engine/terrain/tree/level_residuals.h"
#include "engine/terrain/tree/level_step.h"
#include "engine/terrain/tree/part_errors.h"

namespace reljef::terrain {
namespace {

/// Ranges of the base level's heights: of each tile, and the largest of all.
class BaseRanges {
public:
    /// `cols`: of vertices with the border; of them, `end` and the following ones lie beyond the
    /// raster.
    BaseRanges(glm::ivec2 tiles, int cols, int end)
        : tiles_(tiles.x, tiles.y), columns_(static_cast<std::size_t>(cols)),
          end_(static_cast<std::size_t>(std::min(end, cols))) {}

    /// Rows in order, with the chunk's border.
    void add(int row, std::span<const float> heights, bool is_last) {
        columns_.add(heights);
        const int vertex = row - chunk_border;
        if (is_last || (vertex >= 0 && vertex % tree_tile_cells == 0)) {
            close(vertex > 0 ? (vertex - 1) / tree_tile_cells : -1);
            columns_.add(heights);
        }
    }
    [[nodiscard]] float largest() const { return largest_; }
    [[nodiscard]] Grid<TileProof>& tiles() { return tiles_; }

private:
    /// Ends a row of tiles; rows outside the chunk have none.
    void close(int row) {
        for (int col = 0; row >= 0 && row < tiles_.rows() && col < tiles_.cols(); ++col) {
            const auto first = static_cast<std::size_t>(chunk_border) +
                               static_cast<std::size_t>(col) * tree_tile_cells;
            columns_.join_with(tiles_(col, row), first,
                               std::min(first + tree_tile_cells + 1, end_));
        }
        largest_ = higher(largest_, columns_.largest());
        columns_.clear();
    }

    Grid<TileProof> tiles_;
    ColumnRanges columns_; // of the vertices, so far in a row of tiles
    std::size_t end_;
    float largest_ = 0.0F;
};

/// The largest distance from the surface in each part of each tile.
Grid<PartErrors> part_errors(const Residuals& residuals, glm::ivec2 tiles) {
    Grid<PartErrors> parts(tiles.x, tiles.y);
    std::vector<float> errors(static_cast<std::size_t>(residuals.low.cols()));
    for (int row = 0; row < residuals.low.rows(); ++row) {
        const float* const low = residuals.low.row(row).data();
        const float* const high = residuals.high.row(row).data();
        float* __restrict const error = errors.data();
        for (std::size_t i = 0; i < errors.size(); ++i) {
            error[i] = higher(higher(error[i], -low[i]), high[i]);
        }
        if (row % cells_per_error_part != cells_per_error_part - 1 &&
            row != residuals.low.rows() - 1) {
            continue;
        }
        for (int col = 0; col < residuals.low.cols(); ++col) {
            const int part = row % tree_tile_cells / cells_per_error_part * error_parts +
                             col % tree_tile_cells / cells_per_error_part;
            float& largest =
                parts(col / tree_tile_cells, row / tree_tile_cells)[static_cast<std::size_t>(part)];
            float& found = errors[static_cast<std::size_t>(col)];
            largest = higher(largest, std::exchange(found, 0.0F));
        }
    }
    return parts;
}

/// `rounding`: metres, of each error.
PartShares set_errors(const PartErrors& errors, float rounding, TileProof& tile) {
    const float largest = *std::max_element(errors.begin(), errors.end());
    const bool is_exact = tile.low >= tile.high && largest == 0.0F; // means of equal heights
    tile.error = is_exact ? 0.0F : std::nextafter(largest + rounding, infinite);
    tile.block_shares = shares_of(block_errors(errors), rounding, tile.error);
    return shares_of(errors, rounding, tile.error);
}

/// Tiles of a level, and their parts, from the tiles below it and from its residuals. `rounding`:
/// metres.
void add_tiles(const Grid<TileProof>& below, float rounding, ChunkLevel& level) {
    level.tiles = Grid<TileProof>((below.cols() + 1) / 2, (below.rows() + 1) / 2);
    level.parts = Grid<PartShares>(level.tiles.cols(), level.tiles.rows());
    for (int row = 0; row < below.rows(); ++row) {
        for (int col = 0; col < below.cols(); ++col) {
            TileProof& tile = level.tiles(col / 2, row / 2);
            tile.low = lower(tile.low, below(col, row).low);
            tile.high = higher(tile.high, below(col, row).high);
            tile.has_voids = tile.has_voids || below(col, row).has_voids;
        }
    }
    const Grid<PartErrors> errors =
        part_errors(level.residuals, {level.tiles.cols(), level.tiles.rows()});
    for (std::size_t i = 0; i < level.tiles.size(); ++i) {
        level.parts.samples()[i] =
            set_errors(errors.samples()[i], rounding, level.tiles.samples()[i]);
    }
}

// Outwards. `largest`: height; none is farther than twice that from a surface between heights.
void widen(Residuals& residuals, float rounding, float largest) {
    const float limit = 2.0F * largest;
    for (std::size_t i = 0; i < residuals.low.size(); ++i) {
        float& low = residuals.low.samples()[i];
        float& high = residuals.high.samples()[i];
        if (low <= high) { // else there are no samples
            low = std::max(std::nextafter(low - rounding, -infinite), -limit);
            high = std::min(std::nextafter(high + rounding, infinite), limit);
        }
    }
}

/// The rows of a chunk's base, with their ranges.
Grid<float> base_of(const ChunkInput& input, glm::ivec2 vertices, BaseRanges& ranges) {
    Grid<float> base(vertices.x, vertices.y);
    for (int row = 0; row < vertices.y; ++row) {
        input.heights(row, base.row(row));
        ranges.add(row, base.row(row), row == vertices.y - 1);
    }
    return base;
}

struct PlacedChunk {
    const TileTree& tree;
    Chunk chunk;
};

/// Vertices of a level of a chunk, `levels` above its base. `finer`: of the level below it.
ChunkLevel level_above(const PlacedChunk& placed, int levels, const Grid<float>& finer) {
    const auto& [tree, chunk] = placed;
    const glm::ivec2 first = first_vertex(chunk) / (1 << levels);
    const glm::ivec2 cells = chunk_size(tree, chunk) / (1 << levels);
    ChunkLevel level;
    level.border = ((finer.rows() - 1) / 2 - cells.y - 1) / 2;
    level.heights = coarser_heights(finer, {tree, chunk.base + levels, first - level.border});
    return level;
}

/// The base of a chunk and its levels without voids. Differences of levels do not depend on what
/// fills the highest one.
std::array<Grid<float>, levels_per_chunk + 1>
without_voids(const PlacedChunk& placed, const Grid<float>& base, const ChunkProof& proof) {
    const auto& [tree, chunk] = placed;
    std::array<Grid<float>, levels_per_chunk + 1> filled;
    LevelVertices coarser;
    for (int i = levels_per_chunk; i >= 0; --i) {
        const auto* const made =
            i > 0 ? &proof.levels.at(static_cast<std::size_t>(i - 1)) : nullptr;
        const int border = made != nullptr ? made->border : chunk_border;
        LevelVertices level{chunk.base + i, first_vertex(chunk) / (1 << i) - border,
                            made != nullptr ? made->heights : base};
        if (i == levels_per_chunk) {
            const auto heights = level.heights.samples();
            std::replace_if(
                heights.begin(), heights.end(), [](float h) { return std::isnan(h); }, 0.0F);
        } else {
            level = filled_from(tree, std::move(level), coarser);
        }
        filled.at(static_cast<std::size_t>(i)) = level.heights;
        coarser = std::move(level);
    }
    return filled;
}

void add_residuals(const PlacedChunk& placed, const Grid<float>& base, const Residuals* own,
                   ChunkProof& proof) {
    const auto& [tree, chunk] = placed;
    const bool is_filled = has_voids(base);
    const auto filled = is_filled ? without_voids(placed, base, proof)
                                  : std::array<Grid<float>, levels_per_chunk + 1>();
    for (int levels = 1; levels <= levels_per_chunk; ++levels) {
        ChunkLevel& made = proof.levels.at(static_cast<std::size_t>(levels - 1));
        const Grid<float>& heights =
            is_filled ? filled.at(static_cast<std::size_t>(levels)) : made.heights;
        made.residuals = residuals_over(
            {is_filled ? filled[0] : base, chunk_border, own}, {heights, made.border},
            {coarser_axis(tree, chunk, levels, 0), coarser_axis(tree, chunk, levels, 1)},
            chunk_size(tree, chunk) / (1 << levels));
    }
}

} // namespace

glm::ivec2 level_cells(const TileTree& tree, int level) {
    const int step = 1 << level;
    return (glm::ivec2(tree.cols(), tree.rows()) - 2 + step) / step;
}

glm::ivec2 level_tiles(const TileTree& tree, int level) {
    return (level_cells(tree, level) + tree_tile_cells - 1) / tree_tile_cells;
}

glm::ivec2 level_chunks(const TileTree& tree, int base) {
    return (level_cells(tree, base) + chunk_cells - 1) / chunk_cells;
}

glm::ivec2 first_vertex(Chunk chunk) {
    return glm::ivec2(chunk.col, chunk.row) * chunk_cells;
}

glm::ivec2 chunk_size(const TileTree& tree, Chunk chunk) {
    constexpr int cell = 1 << levels_per_chunk;
    const glm::ivec2 cells =
        glm::min(level_cells(tree, chunk.base) - first_vertex(chunk), glm::ivec2(chunk_cells));
    return (cells + cell - 1) / cell * cell;
}

ChunkProof prove_chunk(const TileTree& tree, Chunk chunk, const ChunkInput& input) {
    const glm::ivec2 size = chunk_size(tree, chunk);
    const glm::ivec2 vertices = size + 1 + 2 * chunk_border;
    const glm::ivec2 base_tiles =
        glm::min(level_tiles(tree, chunk.base) - first_vertex(chunk) / tree_tile_cells,
                 glm::ivec2(chunk_cells / tree_tile_cells));
    const int beyond = level_cells(tree, chunk.base).x - first_vertex(chunk).x + 1;
    BaseRanges ranges(base_tiles, vertices.x, chunk_border + beyond);
    const Grid<float> base = base_of(input, vertices, ranges);
    ChunkProof proof;
    const Grid<float>* finer = &base;
    for (int i = 0; i < levels_per_chunk; ++i) {
        ChunkLevel& made = proof.levels.at(static_cast<std::size_t>(i));
        made = level_above({tree, chunk}, i + 1, *finer);
        finer = &made.heights;
    }
    add_residuals({tree, chunk}, base, input.residuals, proof);
    const Grid<TileProof>* below = input.tiles != nullptr ? input.tiles : &ranges.tiles();
    float largest = ranges.largest();
    for (const TileProof& tile : below->samples()) {
        largest = higher(higher(largest, tile.high), -tile.low);
    }
    const float rounding = largest * rounding_of_errors;
    for (ChunkLevel& made : proof.levels) {
        add_tiles(*below, rounding, made);
        below = &made.tiles;
    }
    widen(proof.levels.back().residuals, rounding, largest);
    proof.base = input.tiles != nullptr ? Grid<TileProof>() : std::move(ranges.tiles());
    return proof;
}

int sample_border(int level) {
    return (2 << level) - 1;
}

Grid<float> heights_from_samples(const TileTree& tree, TreeTile tile, Grid<float> samples) {
    const int border = sample_border(tile.level);
    const glm::ivec2 size = tree.cells(tile) * TileTree::step(tile) + 1 + 2 * border;
    check(samples.cols() == size.x && samples.rows() == size.y, "samples of another tile");
    for (int level = 1; level <= tile.level; ++level) {
        const glm::ivec2 first = TileTree::first(tile) / (1 << level) - (border >> level);
        samples = coarser_heights(samples, {tree, level, first});
    }
    return samples;
}

} // namespace reljef::terrain
