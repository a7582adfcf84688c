#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "engine/core/check.h"
#include "engine/terrain/tree/column_ranges.h"
#include "engine/terrain/tree/level_step.h"
#include "engine/terrain/tree/part_errors.h"
#include "engine/terrain/tree/tile_error.h"

// Proofs beside the samples and heights of their tiles.

namespace reljef::terrain {
namespace {

std::string found_text(const char* what, double found, double expected) {
    return fmt::format("{} of {} m found, {} m was expected", what, found, expected);
}

/// What a proof claims, as found in all samples of a tile.
struct FoundInSamples {
    TileProof proof; // without errors
    PartErrors errors{};
};

/// The place of a sample along an axis of its tile: between a cell's first vertex and the next one.
struct CellPlace {
    int cell = 0;
    double share = 0.0; ///< of the next vertex
};

std::vector<CellPlace> places_along(const TileTree& tree, TreeTile tile, int axis) {
    const glm::ivec2 first = TileTree::first(tile);
    const int count = tree.sample(tile, tree.cells(tile))[axis] - first[axis] + 1;
    std::vector<CellPlace> places(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        const int cell = std::min(i / TileTree::step(tile), tree.cells(tile)[axis] - 1);
        const double low = tree.place(tree.sample(tile, glm::ivec2(cell)))[axis];
        const double next = tree.place(tree.sample(tile, glm::ivec2(cell + 1)))[axis];
        places[static_cast<std::size_t>(i)] = {cell,
                                               (tree.place(first + i)[axis] - low) / (next - low)};
    }
    return places;
}

/// Between two heights; one that has no share may be a void.
float mixed(float a, float b, double share) {
    if (share == 0.0 || share == 1.0) {
        return share == 0.0 ? a : b;
    }
    return static_cast<float>(glm::mix<double>(a, b, share));
}

/// The bilinear surface of a tile at all its samples, row by row.
class SurfaceRows {
public:
    /// `cols`: the places of the samples along a row.
    SurfaceRows(const Grid<float>& heights, std::span<const CellPlace> cols)
        : heights_(heights), cols_(cols), upper_(cols.size()), lower_(cols.size()),
          surface_(cols.size()) {}

    /// Valid until the next call.
    [[nodiscard]] std::span<const float> at(const CellPlace& row) {
        if (row.cell != cell_) {
            cell_ = row.cell;
            set_row(cell_ + 1, upper_);
            set_row(cell_ + 2, lower_);
        }
        if (row.share == 0.0 || row.share == 1.0) {
            return row.share == 0.0 ? upper_ : lower_;
        }
        const float* const upper = upper_.data();
        const float* const lower = lower_.data();
        float* __restrict const surface = surface_.data();
        for (std::size_t i = 0; i < surface_.size(); ++i) {
            surface[i] = static_cast<float>(glm::mix<double>(upper[i], lower[i], row.share));
        }
        return surface_;
    }

private:
    // `row`: of the heights, which have a vertex more on each side.
    void set_row(int row, std::vector<float>& along) const {
        const auto vertices = heights_.row(row);
        for (std::size_t i = 0; i < along.size(); ++i) {
            const auto first = static_cast<std::size_t>(cols_[i].cell) + 1;
            along[i] = mixed(vertices[first], vertices[first + 1], cols_[i].share);
        }
    }

    const Grid<float>& heights_;
    std::span<const CellPlace> cols_;
    int cell_ = -1;
    std::vector<float> upper_; // at the first vertices of the row of cells
    std::vector<float> lower_; // at the next ones
    std::vector<float> surface_;
};

/// The rows of a tile's samples, joined in each column by itself.
class SampleColumns {
public:
    explicit SampleColumns(std::size_t cols) : ranges_(cols), errors_(cols) {}

    /// As many heights as columns, and the surface there.
    void add(std::span<const float> row, std::span<const float> surface_row) {
        ranges_.add(row);
        const float* const heights = row.data();
        const float* const surface = surface_row.data();
        float* __restrict const errors = errors_.data();
        for (std::size_t i = 0; i < errors_.size(); ++i) {
            errors[i] = higher(errors[i], std::abs(heights[i] - surface[i]));
        }
    }
    /// The largest error of each column, of the rows since forget_errors().
    [[nodiscard]] std::span<const float> errors() const { return errors_; }
    void forget_errors() { std::fill(errors_.begin(), errors_.end(), 0.0F); }
    [[nodiscard]] TileProof proof() const {
        TileProof proof;
        ranges_.join_with(proof, 0, ranges_.cols());
        return proof;
    }

private:
    ColumnRanges ranges_;
    std::vector<float> errors_;
};

std::size_t part_of(const CellPlace& place) {
    return static_cast<std::size_t>(place.cell / cells_per_error_part);
}

/// `row`: of parts. A sample between cells belongs to both.
void add_errors(std::span<const float> errors, std::span<const CellPlace> cols, std::size_t row,
                PartErrors& parts) {
    for (std::size_t col = 0; col < errors.size(); ++col) {
        for (const std::size_t beside : {col - (col > 0 ? 1 : 0), col}) {
            float& largest = parts.at(row * error_parts + part_of(cols[beside]));
            largest = higher(largest, errors[col]);
        }
    }
}

FoundInSamples found_in(const TileTree& tree, TreeTile tile, const Grid<float>& heights,
                        const Grid<float>& samples) {
    const int border = sample_border(tile.level);
    const std::vector<CellPlace> cols = places_along(tree, tile, 0);
    const std::vector<CellPlace> rows = places_along(tree, tile, 1);
    SurfaceRows surface(heights, cols);
    SampleColumns columns(cols.size());
    PartErrors errors{};
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const auto in_row = samples.row(static_cast<int>(row) + border)
                                .subspan(static_cast<std::size_t>(border), cols.size());
        const std::span<const float> on_surface = surface.at(rows[row]);
        columns.add(in_row, on_surface);
        const bool is_last = row + 1 == rows.size();
        const std::size_t part = part_of(rows[row > 0 ? row - 1 : row]);
        if (!is_last && part == part_of(rows[row])) {
            continue;
        }
        add_errors(columns.errors(), cols, part, errors);
        columns.forget_errors();
        columns.add(in_row, on_surface); // a row between parts belongs to both
        if (is_last) {
            add_errors(columns.errors(), cols, part_of(rows[row]), errors);
        }
    }
    return {columns.proof(), errors};
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

/// Whether vertices inside the tile may be means with a void pole: the last cell may be so short
/// that those before it reach the pole. The first row is reached by none.
bool may_mix_void_pole(const TileTree& tree, TreeTile tile, const TileProof& proof) {
    const bool is_last = tree.sample(tile, tree.cells(tile)).y == tree.rows() - 1;
    return proof.has_voids && tree.wrap().ends_at_pole && is_last;
}

/// The end of the columns of heights whose vertices are means of the tile's own samples. At the
/// seam of a globe, the last cell may be so short that those before it reach beyond.
int end_of_own_cols(const TileTree& tree, TreeTile tile) {
    const int cells = tree.cells(tile).x;
    const bool is_at_seam =
        tree.wrap().around && tree.sample(tile, tree.cells(tile)).x == tree.cols() - 1;
    return is_at_seam ? cells : cells + 1;
}

/// Compares a proof with the vertices inside the tile, which are means of its own samples, and of
/// what stands for a void pole.
std::optional<std::string> contradiction_of_vertices(const TileTree& tree, TreeTile tile,
                                                     const TileProof& proof,
                                                     const Grid<float>& heights) {
    const float largest =
        proof.low > proof.high ? 0.0F : higher(std::abs(proof.low), std::abs(proof.high));
    const float rounding = largest * rounding_per_level * static_cast<float>(tile.level);
    const bool has_pole = may_mix_void_pole(tree, tile, proof);
    const float low = has_pole ? lower(proof.low, height_of_void_pole) : proof.low;
    const float high = has_pole ? higher(proof.high, height_of_void_pole) : proof.high;
    const int last_row = tree.cells(tile).y;
    const int end_col = end_of_own_cols(tree, tile);
    for (int row = 2; row <= last_row; ++row) {
        for (int col = 2; col < end_col; ++col) {
            const float height = heights(col, row);
            if (height < low - rounding || height > high + rounding) {
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
