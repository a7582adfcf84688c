#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/terrain/tree/tile_error.h"

// The proofs of a chunk's tiles, as an index stores them. Private to error_index.cpp.
//
// Ranges of heights are rounded outwards to multiples of a power of two, the same one for all tiles
// of a chunk, and take four bytes. Whole metres stay as they are if the relief of the chunk is less
// than 32,767 m. The range of a tile contains those of the tiles below it, as before.

namespace reljef::io {

/// Tiles of a level, row after row.
struct TileRange {
    int level = 0;
    glm::ivec2 first{0};
    glm::ivec2 count{0};
};
/// The chunk whose block has the proof of a tile.
terrain::Chunk chunk_with_proof(terrain::TreeTile tile);
/// The tiles with a proof in the block of a chunk, the finest level first.
std::vector<TileRange> tiles_with_proof(const terrain::TileTree& tree, terrain::Chunk chunk);

/// Length of a block.
std::size_t floats_of_proofs(std::span<const TileRange> levels);
/// Writes proofs as bits of floats.
std::vector<float> packed_proofs(std::span<const TileRange> levels,
                                 const terrain::ChunkProof& proof);
/// Reads a proof. Precondition: a block of these levels, which have the tile.
terrain::TileProof unpacked_proof(std::span<const TileRange> levels, std::span<const float> block,
                                  terrain::TreeTile tile);

} // namespace reljef::io
