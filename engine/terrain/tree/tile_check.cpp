#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "engine/core/check.h"
#include "engine/terrain/tree/part_errors.h"
#include "engine/terrain/tree/tile_error.h"

// Proofs beside the samples and heights of their tiles.

namespace reljef::terrain {
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
