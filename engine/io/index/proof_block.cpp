#include "engine/io/index/proof_block.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include <glm/common.hpp>

#include "engine/core/check.h"
#include "engine/io/index/index_format.h"

namespace reljef::io {
namespace {

using terrain::Chunk;
using terrain::levels_per_chunk;
using terrain::TileProof;
using terrain::TreeTile;

constexpr std::uint16_t max_code = 0x7FFF;
constexpr std::uint16_t void_flag = 0x8000;

/// Of a tile, in steps. Without samples: from max_code to 0.
struct RangeCodes {
    std::uint16_t low = max_code; // may have void_flag
    std::uint16_t high = 0;
};
/// Follows the codes above level 0.
struct ErrorRecord {
    float error = 0.0F;
    terrain::BlockShares shares = terrain::whole_shares;
};
static_assert(sizeof(RangeCodes) == 4 && sizeof(ErrorRecord) == 20);

template <class T> constexpr std::size_t floats_in = sizeof(T) / sizeof(float);

template <class T> T from_floats(std::span<const float> floats) {
    std::array<float, floats_in<T>> bits{};
    std::copy_n(floats.begin(), bits.size(), bits.begin());
    return std::bit_cast<T>(bits);
}
template <class T> void put_floats(const T& value, std::span<float> floats) {
    const auto bits = std::bit_cast<std::array<float, floats_in<T>>>(value);
    std::copy_n(bits.begin(), bits.size(), floats.begin());
}

constexpr std::size_t floats_of_record(int level) {
    return floats_in<RangeCodes> + (level > 0 ? floats_in<ErrorRecord> : 0);
}

/// The heights of codes: multiples of `step` from `first` on, metres. A block begins with them.
struct HeightSteps {
    float first = 0.0F;
    float step = 1.0F;

    [[nodiscard]] float height(int code) const {
        return static_cast<float>(double{first} + double{step} * code);
    }
    [[nodiscard]] std::uint16_t code_below(float height) const {
        return static_cast<std::uint16_t>(std::floor((double{height} - first) / step));
    }
    [[nodiscard]] std::uint16_t code_above(float height) const {
        return static_cast<std::uint16_t>(std::ceil((double{height} - first) / step));
    }
};

/// Steps for heights from `low` to `high`. They are no finer than floats of the larger one, so the
/// heights of all codes are floats.
HeightSteps steps_between(float low, float high) {
    const float largest = std::max({std::abs(low), std::abs(high), 1.0F});
    double step = double{largest} - std::nextafter(largest, 0.0F); // a power of two
    while (std::ceil(high / step) - std::floor(low / step) > max_code) {
        step *= 2.0;
    }
    return {static_cast<float>(std::floor(low / step) * step), static_cast<float>(step)};
}

const Grid<TileProof>& tiles_of(const terrain::ChunkProof& proof, int level, int base) {
    return level == base ? proof.base
                         : proof.levels.at(static_cast<std::size_t>(level - base - 1)).tiles;
}

std::size_t floats_of(const TileRange& tiles) {
    return count_of(tiles.count) * floats_of_record(tiles.level);
}

HeightSteps steps_of(const Grid<TileProof>& tiles) {
    TileProof all;
    for (const TileProof& tile : tiles.samples()) {
        all.low = std::min(all.low, tile.low);
        all.high = std::max(all.high, tile.high);
    }
    return all.low <= all.high ? steps_between(all.low, all.high) : HeightSteps();
}

RangeCodes codes_of(const TileProof& tile, const HeightSteps& steps) {
    RangeCodes codes;
    if (tile.low <= tile.high) {
        codes = {steps.code_below(tile.low), steps.code_above(tile.high)};
    }
    codes.low = static_cast<std::uint16_t>(codes.low | (tile.has_voids ? void_flag : 0));
    return codes;
}

void pack(const TileProof& tile, int level, const HeightSteps& steps, std::span<float> record) {
    put_floats(codes_of(tile, steps), record);
    if (level > 0) {
        put_floats(ErrorRecord{tile.error, tile.block_shares},
                   record.subspan(floats_in<RangeCodes>));
    }
}

TileProof unpacked(std::span<const float> record, int level, const HeightSteps& steps) {
    const auto codes = from_floats<RangeCodes>(record);
    TileProof tile;
    tile.has_voids = (codes.low & void_flag) != 0;
    if (const int low = codes.low & max_code; low <= codes.high) {
        tile.low = steps.height(low);
        tile.high = steps.height(codes.high);
        tile.range_step = steps.step;
    }
    if (level > 0) {
        const auto error = from_floats<ErrorRecord>(record.subspan(floats_in<RangeCodes>));
        tile.error = error.error;
        tile.block_shares = error.shares;
    }
    return tile;
}

} // namespace

Chunk chunk_with_proof(TreeTile tile) {
    const int base = std::max(0, tile.level - 1) / levels_per_chunk * levels_per_chunk;
    const int side = terrain::chunk_cells / terrain::tree_tile_cells >> (tile.level - base);
    return {base, tile.col / side, tile.row / side};
}

std::vector<TileRange> tiles_with_proof(const terrain::TileTree& tree, Chunk chunk) {
    std::vector<TileRange> levels;
    const int last = std::min(chunk.base + levels_per_chunk, tree.root().level);
    for (int level = chunk.base == 0 ? 0 : chunk.base + 1; level <= last; ++level) {
        const int side = terrain::chunk_cells / terrain::tree_tile_cells >> (level - chunk.base);
        const glm::ivec2 first = glm::ivec2(chunk.col, chunk.row) * side;
        levels.push_back(
            {level, first, glm::min(level_tiles(tree, level) - first, glm::ivec2(side))});
    }
    return levels;
}

std::size_t floats_of_proofs(std::span<const TileRange> levels) {
    std::size_t floats = floats_in<HeightSteps>;
    for (const TileRange& tiles : levels) {
        floats += floats_of(tiles);
    }
    return floats;
}

std::vector<float> packed_proofs(std::span<const TileRange> levels,
                                 const terrain::ChunkProof& proof) {
    const int base = levels.front().level - (proof.base.empty() ? 1 : 0);
    const HeightSteps steps = steps_of(tiles_of(proof, levels.back().level, base));
    std::vector<float> block(floats_of_proofs(levels));
    put_floats(steps, block);
    std::span<float> rest = std::span(block).subspan(floats_in<HeightSteps>);
    for (const TileRange& range : levels) {
        const Grid<TileProof>& tiles = tiles_of(proof, range.level, base);
        check(tiles.cols() == range.count.x && tiles.rows() == range.count.y,
              "proofs of another chunk");
        for (const TileProof& tile : tiles.samples()) {
            pack(tile, range.level, steps, rest);
            rest = rest.subspan(floats_of_record(range.level));
        }
    }
    return block;
}

TileProof unpacked_proof(std::span<const TileRange> levels, std::span<const float> block,
                         TreeTile tile) {
    const auto steps = from_floats<HeightSteps>(block);
    std::span<const float> rest = block.subspan(floats_in<HeightSteps>);
    for (const TileRange& range : levels) {
        if (range.level == tile.level) {
            const glm::ivec2 at = glm::ivec2(tile.col, tile.row) - range.first;
            const std::size_t place =
                index_in(range.count, at.x, at.y) * floats_of_record(range.level);
            return unpacked(rest.subspan(place), range.level, steps);
        }
        rest = rest.subspan(floats_of(range));
    }
    abort_with("a tile of another chunk");
}

} // namespace reljef::io
