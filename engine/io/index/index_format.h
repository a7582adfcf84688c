#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/terrain/tree/tile_error.h"

// The blocks of an index, and their checksums. Private to error_index.cpp.

namespace reljef::io {

inline constexpr std::uint32_t index_version = 6; // increase when heights or errors change

struct IndexHeader {
    std::array<char, 8> magic{'r', 'e', 'l', 'i', 'n', 'd', 'e', 'x'};
    std::uint32_t version = index_version;
    std::uint32_t endian = 0x01020304;
    std::int32_t cells_of_tile = terrain::tree_tile_cells;
    std::int32_t cols = 0;
    std::int32_t rows = 0;
    std::uint32_t is_complete = 0;
    std::uint64_t source = 0;
    std::uint64_t seal = 0;
};
static_assert(sizeof(IndexHeader) == 48 && std::is_trivially_copyable_v<IndexHeader>);

inline constexpr int side_of_heights = terrain::tree_tile_cells + 3;
inline constexpr std::size_t floats_of_heights = std::size_t{side_of_heights} * side_of_heights;
inline constexpr std::size_t bytes_of_parts = sizeof(terrain::PartShares);
inline constexpr std::size_t floats_of_tile = floats_of_heights + bytes_of_parts / sizeof(float);
inline constexpr int side_of_residuals = terrain::chunk_cells >> terrain::levels_per_chunk;
inline constexpr std::size_t floats_of_residuals =
    std::size_t{2} * side_of_residuals * side_of_residuals;

constexpr std::size_t bytes_of_block(std::size_t floats) {
    return floats * sizeof(float) + sizeof(std::uint64_t);
}

/// Checksum; `source`: the fingerprint. `place`: of the floats in the file.
std::uint64_t seal_of(std::span<const float> floats, std::uint64_t place, std::uint64_t source);

// Row after row of `count`.
std::size_t index_in(glm::ivec2 count, int col, int row);
std::size_t count_of(glm::ivec2 count);

// Between a grid and rows of `stride` floats.
void copy_into(const Grid<float>& grid, std::span<float> floats, int stride);
Grid<float> grid_from(std::span<const float> floats, glm::ivec2 size, int stride);

} // namespace reljef::io
