#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/tree/tile_tree.h"

// The heights of a tree's levels, and a proven bound of how far each tile is from the samples.
//
// A vertex has the mean of the vertices of the level below around it, weighted (1 2 1)/4 along each
// axis, without voids; beyond the raster its border repeats. It depends on samples less than a step
// away, so that a piece of the raster needs only a narrow border.
//
// Lattices are nested: the difference of two levels is bilinear in each cell of the finer one, and
// extreme at its vertices. Each cell of the first three levels has the exact range of the
// difference of its samples from the surface. The next three levels move the ranges of the third by
// the range of the difference of the two levels over each of its cells, and so on. Voids are filled
// (level_fill.h), and what fills them counts as samples do.

namespace reljef::terrain {

/// Blocks along a side of a tile, each with an error of its own.
inline constexpr int error_blocks = 4;
inline constexpr int cells_per_error_block = tree_tile_cells / error_blocks;
/// The error of each block in 255ths of the tile's error, row after row.
using BlockShares = std::array<std::uint8_t, error_blocks * error_blocks>;
inline constexpr BlockShares whole_shares = [] {
    BlockShares shares{};
    shares.fill(255);
    return shares;
}();
/// The error of a block as a share of the tile's, 0 … 1.
inline double share_of(const BlockShares& shares, std::size_t block) {
    return shares[block] / 255.0;
}
/// The block with a cell.
inline std::size_t block_at(glm::ivec2 cell) {
    const glm::ivec2 block = cell / cells_per_error_block;
    return static_cast<std::size_t>(block.y) * error_blocks + static_cast<std::size_t>(block.x);
}

/// Parts along a side of a tile: finer blocks, for tiles that are loaded.
inline constexpr int error_parts = 16;
inline constexpr int cells_per_error_part = tree_tile_cells / error_parts;
/// The error of each part in 255ths of the tile's error, row after row.
using PartShares = std::array<std::uint8_t, error_parts * error_parts>;

/// What is proven of a tile, true metres.
struct TileProof {
    /// Lowest and highest sample that is no void; low > high: there is none.
    float low = std::numeric_limits<float>::infinity();
    float high = -std::numeric_limits<float>::infinity();
    /// No sample, and nothing that fills voids, is farther above or below the tile's bilinear
    /// surface.
    float error = 0.0F;
    /// Whether there are voids. What fills them may be outside of the heights.
    bool has_voids = false;
    BlockShares block_shares = whole_shares;
    /// `low` and `high` may be this much farther apart on either side, metres.
    float range_step = 0.0F;

    /// As `error`, for the samples of a block.
    [[nodiscard]] double block_error(std::size_t block) const {
        return error * share_of(block_shares, block);
    }

    friend bool operator==(const TileProof&, const TileProof&) = default;
};

/// Per cell, the range of samples minus surface, metres; low > high: outside the raster.
struct Residuals {
    Grid<float> low;
    Grid<float> high;
};

/// A chunk adds this many levels above its base level.
inline constexpr int levels_per_chunk = 3;
/// Base cells along a chunk's side.
inline constexpr int chunk_cells = 1024;
static_assert(chunk_cells % (tree_tile_cells << levels_per_chunk) == 0);
/// Base vertices around a chunk that its levels need, for one step around them.
inline constexpr int chunk_border = (2 << levels_per_chunk) - 1;

struct Chunk {
    int base = 0; ///< level
    int col = 0;  ///< in chunks
    int row = 0;
};

/// Cells and tiles of a level.
glm::ivec2 level_cells(const TileTree& tree, int level);
glm::ivec2 level_tiles(const TileTree& tree, int level);
/// Chunks with this base.
glm::ivec2 level_chunks(const TileTree& tree, int base);

/// First base vertex of a chunk, and its base cells, rounded up to cells of its highest level.
glm::ivec2 first_vertex(Chunk chunk);
glm::ivec2 chunk_size(const TileTree& tree, Chunk chunk);

/// Fills a row of base vertices (NaN: void) with its border; row 0 is chunk_border above the chunk.
/// Repeats the raster's border outside of it. Called for each row once, in order.
using VertexRows = std::function<void(int row, std::span<float> heights)>;

struct ChunkInput {
    VertexRows heights;
    /// Of the base level's cells and tiles; null at level 0.
    const Residuals* residuals = nullptr;
    const Grid<TileProof>* tiles = nullptr;
};

struct ChunkLevel {
    int border = 0;      ///< vertices around the chunk in `heights`
    Grid<float> heights; ///< NaN: void
    Residuals residuals; ///< of the cells
    Grid<TileProof> tiles;
    Grid<PartShares> parts; ///< of the tiles
};

struct ChunkProof {
    Grid<TileProof> base; ///< tiles of level 0; empty above
    std::array<ChunkLevel, levels_per_chunk> levels;
};

/// The levels of a chunk above its base. Errors include all rounding.
ChunkProof prove_chunk(const TileTree& tree, Chunk chunk, const ChunkInput& input);

/// Samples around a tile that its heights depend on, with one step around it.
int sample_border(int level);

/// Heights at the vertices of a tile and one step around them, from its samples and sample_border()
/// samples around them; both repeat the raster's border.
Grid<float> heights_from_samples(const TileTree& tree, TreeTile tile, Grid<float> samples);

/// The parts of a tile whose voids are filled. `heights`, `samples`: as for check_proof, filled.
PartShares parts_of(const TileTree& tree, TreeTile tile, const TileProof& proof,
                    const Grid<float>& heights, const Grid<float>& samples);

/// The proof of a tile with voids: its range contains what fills them, from `filled.low` to
/// `filled.high` metres, and its error what floats round of that.
TileProof with_fill(const TileProof& proof, HeightRange filled, int level);
/// The parts of a proof for the same one with a larger error.
PartShares parts_of_wider(const PartShares& parts, const TileProof& proof, const TileProof& wider);

/// Whether the largest shares of the parts of each block are those of the blocks.
bool are_parts_of(const PartShares& parts, const BlockShares& blocks);

/// What the heights of a tile say of its proof.
struct ProofCheck {
    /// Why it is not that of the tile; absent if nothing contradicts it.
    std::optional<std::string> contradiction;
    /// Of the proof's error, from the samples; absent without them.
    std::optional<PartShares> parts;
};
/// `heights`: at the tile's vertices and one step around them. `samples`: as for
/// heights_from_samples, or null.
ProofCheck check_proof(const TileTree& tree, TreeTile tile, const TileProof& proof,
                       const Grid<float>& heights, const Grid<float>* samples = nullptr);

} // namespace reljef::terrain
