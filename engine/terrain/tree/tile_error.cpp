#include "engine/terrain/tree/tile_error.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "engine/core/check.h"
#include "engine/terrain/tree/level_fill.h"
#include "engine/terrain/tree/level_residuals.h"
#include "engine/terrain/tree/level_step.h"

namespace reljef::terrain {
namespace {

/// Ranges of the base level's heights: of each tile, and the largest of all.
class BaseRanges {
public:
    /// `cols`: of vertices with the border; of them, `end` and the following ones lie beyond the
    /// raster.
    BaseRanges(glm::ivec2 tiles, int cols, int end)
        : tiles_(tiles.x, tiles.y), low_(static_cast<std::size_t>(cols), infinite),
          high_(low_.size(), -infinite), voids_(low_.size(), 0.0F),
          end_(static_cast<std::size_t>(std::min(end, cols))) {}

    /// Rows in order, with the chunk's border.
    void add(int row, std::span<const float> heights, bool is_last) {
        join(heights);
        const int vertex = row - chunk_border;
        if (is_last || (vertex >= 0 && vertex % tree_tile_cells == 0)) {
            close(vertex > 0 ? (vertex - 1) / tree_tile_cells : -1);
            join(heights);
        }
    }
    [[nodiscard]] float largest() const { return largest_; }
    [[nodiscard]] Grid<TileProof>& tiles() { return tiles_; }

private:
    void join(std::span<const float> heights) {
        const float* const more = heights.data();
        float* __restrict const low = low_.data();
        float* __restrict const high = high_.data();
        float* __restrict const voids = voids_.data();
        for (std::size_t i = 0; i < heights.size(); ++i) {
            low[i] = lower(low[i], more[i]);
            high[i] = higher(high[i], more[i]);
            voids[i] = more[i] == more[i] ? voids[i] : 1.0F; // NaN: void
        }
    }
    /// Ends a row of tiles; rows outside the chunk have none.
    void close(int row) {
        for (int col = 0; row >= 0 && row < tiles_.rows() && col < tiles_.cols(); ++col) {
            const auto first = static_cast<std::size_t>(chunk_border) +
                               static_cast<std::size_t>(col) * tree_tile_cells;
            const std::size_t end = std::min(first + tree_tile_cells + 1, end_);
            TileProof& tile = tiles_(col, row);
            for (std::size_t i = first; i < end; ++i) {
                tile.low = lower(tile.low, low_[i]);
                tile.high = higher(tile.high, high_[i]);
                tile.has_voids = tile.has_voids || voids_[i] > 0.0F;
            }
        }
        for (std::size_t i = 0; i < low_.size(); ++i) {
            largest_ = higher(higher(largest_, high_[i]), -low_[i]);
        }
        std::fill(low_.begin(), low_.end(), infinite);
        std::fill(high_.begin(), high_.end(), -infinite);
        std::fill(voids_.begin(), voids_.end(), 0.0F);
    }

    Grid<TileProof> tiles_;
    std::vector<float> low_; // of the vertices of a column, so far in a row of tiles
    std::vector<float> high_;
    std::vector<float> voids_; // 1: there is one
    std::size_t end_;
    float largest_ = 0.0F;
};

/// Metres, of the parts of a tile.
using PartErrors = std::array<float, std::tuple_size_v<PartShares>>;
using BlockErrors = std::array<float, std::tuple_size_v<BlockShares>>;

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

std::size_t block_of_part(std::size_t part) {
    constexpr std::size_t parts_per_block = error_parts / error_blocks;
    return part / error_parts / parts_per_block * error_blocks +
           part % error_parts / parts_per_block;
}

BlockErrors block_errors(const PartErrors& parts) {
    BlockErrors blocks{};
    for (std::size_t i = 0; i < parts.size(); ++i) {
        float& largest = blocks.at(block_of_part(i));
        largest = higher(largest, parts.at(i));
    }
    return blocks;
}

/// Errors as shares of the largest one. `rounding`: metres, of each error.
template <std::size_t count>
std::array<std::uint8_t, count> shares_of(const std::array<float, count>& errors, float rounding,
                                          float largest) {
    std::array<std::uint8_t, count> shares{};
    for (std::size_t i = 0; i < count && largest > 0.0F; ++i) {
        const float share = std::ceil(255.0F * ((errors.at(i) + rounding) / largest));
        shares.at(i) = static_cast<std::uint8_t>(std::min(share + 1.0F, 255.0F)); // the division
    }
    return shares;
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

// Of errors of a level, in units of the largest height, 2^-24 each for: shares along both axes (4
// and 4: two products, their sum, and the share itself), the difference of heights (2), and its sum
// with a residual (4: widen() bounds it by twice the largest height).
constexpr float rounding_of_errors = 14.0F / 16777216.0F;

// Of heights of the next level, 2^-24 of the largest for each of nine sums.
constexpr float rounding_per_level = 9.0F / 16777216.0F;

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

namespace {

/// Between two heights; one that has no share may be a void.
float mixed(float a, float b, double share) {
    return share == 1.0 ? b : static_cast<float>(glm::mix<double>(a, b, share));
}

/// Bilinear on a tile; vertices without a share may be voids.
float surface_at(const TileTree& tree, TreeTile tile, const Grid<float>& heights,
                 glm::ivec2 sample) {
    if (tile.level == 0) {
        const glm::ivec2 vertex = sample - TileTree::first(tile) + 1;
        return heights(vertex.x, vertex.y);
    }
    const glm::ivec2 cell =
        glm::min((sample - TileTree::first(tile)) / TileTree::step(tile), tree.cells(tile) - 1);
    const glm::dvec2 low = tree.place(tree.sample(tile, cell));
    const glm::dvec2 share =
        (tree.place(sample) - low) / (tree.place(tree.sample(tile, cell + 1)) - low);
    const auto row_at = [&](int row) {
        return share.x == 0.0 ? heights(cell.x + 1, row)
                              : mixed(heights(cell.x + 1, row), heights(cell.x + 2, row), share.x);
    };
    return share.y == 0.0 ? row_at(cell.y + 1)
                          : mixed(row_at(cell.y + 1), row_at(cell.y + 2), share.y);
}

std::string found_text(const char* what, double found, double expected) {
    return fmt::format("{} of {} m found, {} m was expected", what, found, expected);
}

/// What a proof claims, as found in all samples of a tile.
struct FoundInSamples {
    TileProof proof; // without errors
    PartErrors errors{};

    /// Of the parts from `first` to `last`.
    void add_error(float error, glm::ivec2 first, glm::ivec2 last) {
        for (int row = first.y; row <= last.y; ++row) {
            for (int col = first.x; col <= last.x; ++col) {
                float& largest = errors.at(static_cast<std::size_t>(row) * error_parts +
                                           static_cast<std::size_t>(col));
                largest = higher(largest, error);
            }
        }
    }
};

FoundInSamples found_in(const TileTree& tree, TreeTile tile, const Grid<float>& heights,
                        const Grid<float>& samples) {
    const int border = sample_border(tile.level);
    const glm::ivec2 first = TileTree::first(tile);
    const glm::ivec2 last = tree.sample(tile, tree.cells(tile));
    const auto part_of = [&](glm::ivec2 from_first) {
        return glm::min(from_first / TileTree::step(tile), tree.cells(tile) - 1) /
               cells_per_error_part;
    };
    FoundInSamples found;
    for (int row = first.y; row <= last.y; ++row) {
        for (int col = first.x; col <= last.x; ++col) {
            const float height = samples(col - first.x + border, row - first.y + border);
            if (std::isnan(height)) {
                found.proof.has_voids = true;
                continue;
            }
            const float difference = height - surface_at(tree, tile, heights, {col, row});
            found.proof.low = lower(found.proof.low, height);
            found.proof.high = higher(found.proof.high, height);
            const glm::ivec2 from_first = glm::ivec2(col, row) - first;
            found.add_error(std::abs(difference), // a sample between cells belongs to all of them
                            part_of(glm::max(from_first - 1, glm::ivec2(0))), part_of(from_first));
        }
    }
    return found;
}

float rounding_of(const TileProof& proof) {
    return proof.low > proof.high
               ? 0.0F
               : rounding_of_errors * higher(std::abs(proof.low), std::abs(proof.high));
}

/// Whether the lowest height of a proof is that of the samples, or up to a step below it. For the
/// highest, with both exchanged.
bool is_rounded(float low, float of_samples, float step) {
    return low == of_samples || (low < of_samples && double{of_samples} - low <= step);
}

/// Compares a proof with all samples of the tile.
std::optional<std::string> contradiction_of_samples(const TileProof& proof,
                                                    const FoundInSamples& samples) {
    const auto& [found, errors] = samples;
    if (!is_rounded(proof.low, found.low, proof.range_step)) {
        return found_text("a lowest height", proof.low, found.low);
    }
    if (!is_rounded(found.high, proof.high, proof.range_step)) {
        return found_text("a highest height", proof.high, found.high);
    }
    if (found.has_voids != proof.has_voids) {
        return proof.has_voids ? "voids found, none were expected"
                               : "no voids found, some were expected";
    }
    const float rounding = rounding_of(found);
    const BlockErrors blocks = block_errors(errors);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const auto proven = static_cast<float>(proof.block_error(i));
        if (blocks.at(i) > proven + rounding) {
            return found_text("an error", proven, blocks.at(i));
        }
    }
    return std::nullopt;
}

/// Compares a proof with the vertices inside the tile, which are means of its own samples.
std::optional<std::string> contradiction_of_vertices(const TileTree& tree, TreeTile tile,
                                                     const TileProof& proof,
                                                     const Grid<float>& heights) {
    const float largest =
        proof.low > proof.high ? 0.0F : higher(std::abs(proof.low), std::abs(proof.high));
    const float rounding = largest * rounding_per_level * static_cast<float>(tile.level);
    const glm::ivec2 cells = tree.cells(tile);
    for (int row = 2; row <= cells.y; ++row) {
        for (int col = 2; col <= cells.x; ++col) {
            const float height = heights(col, row);
            if (height < proof.low - rounding || height > proof.high + rounding) {
                return fmt::format("heights from {} to {} m found, but its vertices reach {} m",
                                   proof.low, proof.high, height);
            }
        }
    }
    return std::nullopt;
}

/// Of an error that grows by what each share may grow by.
template <std::size_t count>
std::array<std::uint8_t, count> wider_shares(const std::array<std::uint8_t, count>& shares,
                                             float error, float wider) {
    std::array<float, count> errors{};
    std::transform(shares.begin(), shares.end(), errors.begin(), [error](std::uint8_t share) {
        return error * (static_cast<float>(share) / 255.0F);
    });
    return wider > error ? shares_of(errors, wider - error, wider) : shares;
}

} // namespace

PartShares parts_of(const TileTree& tree, TreeTile tile, const TileProof& proof,
                    const Grid<float>& heights, const Grid<float>& samples) {
    const FoundInSamples found = found_in(tree, tile, heights, samples);
    return shares_of(found.errors, rounding_of(found.proof), proof.error);
}

TileProof with_fill(const TileProof& proof, HeightRange filled, int level) {
    TileProof wider = proof;
    wider.low = std::min(proof.low, std::nextafter(static_cast<float>(filled.low), -infinite));
    wider.high = std::max(proof.high, std::nextafter(static_cast<float>(filled.high), infinite));
    if (level > 0) { // the finest level is the surface
        const float rounding = rounding_of(wider) * static_cast<float>(level + levels_per_chunk);
        wider.error = std::nextafter(proof.error + rounding, infinite);
        wider.block_shares = wider_shares(proof.block_shares, proof.error, wider.error);
    }
    return wider;
}

PartShares parts_of_wider(const PartShares& parts, const TileProof& proof, const TileProof& wider) {
    return wider_shares(parts, proof.error, wider.error);
}

bool are_parts_of(const PartShares& parts, const BlockShares& blocks) {
    BlockShares largest{};
    for (std::size_t i = 0; i < parts.size(); ++i) {
        std::uint8_t& share = largest.at(block_of_part(i));
        share = std::max(share, parts.at(i));
    }
    return largest == blocks;
}

ProofCheck check_proof(const TileTree& tree, TreeTile tile, const TileProof& proof,
                       const Grid<float>& heights, const Grid<float>* samples) {
    const bool is_void = proof.low == infinite && proof.high == -infinite;
    const bool is_range =
        std::isfinite(proof.low) && std::isfinite(proof.high) && proof.low <= proof.high;
    if (!is_void && !is_range) {
        return {fmt::format("heights from {} to {} m found, a range was expected", proof.low,
                            proof.high),
                {}};
    }
    if (!(proof.error >= 0.0F) || std::isinf(proof.error)) {
        return {found_text("an error", proof.error, 0.0), {}};
    }
    if (samples == nullptr && tile.level > 0) {
        return {contradiction_of_vertices(tree, tile, proof, heights), {}};
    }
    const FoundInSamples found =
        found_in(tree, tile, heights, samples != nullptr ? *samples : heights);
    return {contradiction_of_samples(proof, found),
            shares_of(found.errors, rounding_of(found.proof), proof.error)};
}

} // namespace reljef::terrain
