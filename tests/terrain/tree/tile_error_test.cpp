#include "engine/terrain/tree/tile_error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/release_only.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/tree/rough_terrain.h"

namespace reljef::terrain {
namespace {

/// A height of a level; beyond it those of the other side of a globe, or of the border.
float height_around(const TileTree& tree, const Grid<float>& heights, glm::ivec2 at) {
    const int turn = heights.cols() - 1;
    const bool is_beyond = at.x < 0 || at.x > turn;
    const int col = tree.wrap().around && is_beyond ? (at.x % turn + turn) % turn : at.x;
    return heights.clamped(col, at.y);
}

/// Rows of a window around `heights`.
VertexRows rows_around(const TileTree& tree, const Grid<float>& heights, glm::ivec2 first) {
    return [&tree, &heights, first](int row, std::span<float> into) {
        for (std::size_t i = 0; i < into.size(); ++i) {
            into[i] = height_around(tree, heights, first + glm::ivec2(static_cast<int>(i), row));
        }
    };
}

/// All levels of a terrain by prove_chunk, chunk by chunk.
struct Proven {
    std::vector<Grid<float>> heights; ///< by level, without border
    std::map<TreeTile, TileProof> tiles;
    std::map<TreeTile, PartShares> parts; ///< above level 0
};

struct LevelState {
    Grid<float> heights;
    Residuals residuals;
    Grid<TileProof> tiles;
    Grid<PartShares> parts;
};

Grid<float> part_of(const Grid<float>& grid, glm::ivec2 first, glm::ivec2 size, float beyond) {
    Grid<float> part(size.x, size.y, beyond);
    for (int row = 0; row < std::min(size.y, grid.rows() - first.y); ++row) {
        for (int col = 0; col < std::min(size.x, grid.cols() - first.x); ++col) {
            part(col, row) = grid(first.x + col, first.y + row);
        }
    }
    return part;
}

template <class T> void put(const Grid<T>& part, glm::ivec2 first, Grid<T>& grid) {
    for (int row = 0; row < std::min(part.rows(), grid.rows() - first.y); ++row) {
        for (int col = 0; col < std::min(part.cols(), grid.cols() - first.x); ++col) {
            grid(first.x + col, first.y + row) = part(col, row);
        }
    }
}

ChunkProof prove(const TileTree& tree, Chunk chunk, const LevelState& base) {
    const glm::ivec2 first = first_vertex(chunk);
    const glm::ivec2 size = chunk_size(tree, chunk);
    ChunkInput input{rows_around(tree, base.heights, first - chunk_border)};
    Residuals residuals;
    Grid<TileProof> tiles;
    if (chunk.base > 0) {
        constexpr float infinite = std::numeric_limits<float>::infinity();
        residuals = {part_of(base.residuals.low, first, size, infinite),
                     part_of(base.residuals.high, first, size, -infinite)};
        const glm::ivec2 first_tile = first / tree_tile_cells;
        const glm::ivec2 count =
            glm::min(level_tiles(tree, chunk.base) - first_tile, chunk_cells / tree_tile_cells);
        tiles = Grid<TileProof>(count.x, count.y);
        for (int row = 0; row < count.y; ++row) {
            for (int col = 0; col < count.x; ++col) {
                tiles(col, row) = base.tiles(first_tile.x + col, first_tile.y + row);
            }
        }
        input.residuals = &residuals;
        input.tiles = &tiles;
    }
    return prove_chunk(tree, chunk, input);
}

LevelState empty_level(const TileTree& tree, int level) {
    const glm::ivec2 cells = level_cells(tree, level);
    const glm::ivec2 tiles = level_tiles(tree, level);
    return {Grid<float>(cells.x + 1, cells.y + 1),
            {Grid<float>(cells.x, cells.y), Grid<float>(cells.x, cells.y)},
            Grid<TileProof>(tiles.x, tiles.y),
            Grid<PartShares>(tiles.x, tiles.y)};
}

/// Puts what is proven of a chunk into the levels above its base.
void store(const ChunkProof& proof, Chunk chunk, std::vector<LevelState>& levels) {
    const glm::ivec2 first = first_vertex(chunk);
    const auto base = static_cast<std::size_t>(chunk.base);
    if (chunk.base == 0) {
        put(proof.base, first / tree_tile_cells, levels[base].tiles);
    }
    for (std::size_t i = 0; i < proof.levels.size(); ++i) {
        const ChunkLevel& made = proof.levels.at(i);
        LevelState& level = levels[base + i + 1];
        const glm::ivec2 corner = first / (2 << i);
        put(part_of(made.heights, glm::ivec2(made.border),
                    {made.residuals.low.cols() + 1, made.residuals.low.rows() + 1}, no_height),
            corner, level.heights);
        put(made.residuals.low, corner, level.residuals.low);
        put(made.residuals.high, corner, level.residuals.high);
        put(made.tiles, corner / tree_tile_cells, level.tiles);
        put(made.parts, corner / tree_tile_cells, level.parts);
    }
}

std::vector<LevelState> proven_levels(const TileTree& tree, const Grid<float>& samples) {
    std::vector<LevelState> levels{empty_level(tree, 0)};
    levels[0].heights = samples;
    for (int base = 0; base <= tree.root().level; base += levels_per_chunk) {
        for (int i = 1; i <= levels_per_chunk; ++i) {
            levels.push_back(empty_level(tree, base + i));
        }
        const glm::ivec2 chunks = level_chunks(tree, base);
        for (int n = 0; n < chunks.x * chunks.y; ++n) {
            const Chunk chunk{base, n % chunks.x, n / chunks.x};
            store(prove(tree, chunk, levels[static_cast<std::size_t>(base)]), chunk, levels);
        }
    }
    return levels;
}

Proven prove_all(const TileTree& tree, const Grid<float>& samples) {
    Proven proven;
    int number = 0;
    for (LevelState& level : proven_levels(tree, samples)) {
        for (int row = 0; row < level.tiles.rows(); ++row) {
            for (int col = 0; col < level.tiles.cols(); ++col) {
                proven.tiles[{number, col, row}] = level.tiles(col, row);
                proven.parts[{number, col, row}] = level.parts(col, row);
            }
        }
        proven.heights.push_back(std::move(level.heights));
        ++number;
    }
    return proven;
}

bool is_at_pole(const TileTree& tree, const Grid<float>& finer, int row) {
    return (tree.wrap().begins_at_pole && row == 0) ||
           (tree.wrap().ends_at_pole && 2 * row >= finer.rows() - 1);
}

/// A vertex by its definition, from the level below: the mean without voids. On a globe, the last
/// column is the first one, and a row on a pole has no others around it.
float mean_around(const TileTree& tree, const Grid<float>& finer, int col, int row) {
    double sum = 0.0;
    double weights = 0.0;
    const glm::ivec2 center(std::min(2 * col, finer.cols() - (tree.wrap().around ? 1 : 0)),
                            std::min(2 * row, finer.rows()));
    const int rows_apart = is_at_pole(tree, finer, row) ? 0 : 1;
    for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
            const double weight = (2 - std::abs(dx)) * (2 - std::abs(dy));
            const float height =
                height_around(tree, finer, center + glm::ivec2(dx, dy * rows_apart));
            sum += std::isnan(height) ? 0.0 : weight * height;
            weights += std::isnan(height) ? 0.0 : weight;
        }
    }
    const float of_void = rows_apart == 0 ? 0.0F : no_height; // a void pole lies at sea level
    return weights > 0.0 ? static_cast<float>(sum / weights) : of_void;
}

/// Bilinear in the level's cells, the cut ones too; in double precision.
double surface_at(const TileTree& tree, const Grid<float>& level, int number, int col, int row) {
    const int step = 1 << number;
    const auto axis = [&](int sample, int last, const auto& place) {
        const int cell = std::min(sample / step, (last - 1) / step);
        const double first = place(cell * step);
        const double width = place(std::min(cell * step + step, last)) - first;
        return std::pair(cell, (place(sample) - first) / width);
    };
    const geo::GlobalWrap& wrap = tree.wrap();
    const int last = tree.rows() - 1;
    const auto latitude = [&](int at) { // in rows
        return at == 0 && wrap.north > 0.0      ? 1.0 - wrap.north
               : at == last && wrap.south > 0.0 ? last - 1.0 + wrap.south
                                                : static_cast<double>(at);
    };
    const auto [x, u] = axis(col, tree.cols() - 1, [](int at) { return static_cast<double>(at); });
    const auto [y, v] = axis(row, last, latitude);
    double sum = 0.0;
    for (const auto& [i, j, share] :
         {std::tuple(0, 0, (1 - u) * (1 - v)), std::tuple(1, 0, u * (1 - v)),
          std::tuple(0, 1, (1 - u) * v), std::tuple(1, 1, u * v)}) {
        sum += share == 0.0 ? 0.0 : share * level(x + i, y + j);
    }
    return sum;
}

struct ExactProof : TileProof {
    std::array<double, error_blocks * error_blocks> block_errors{};
    std::array<double, error_parts * error_parts> part_errors{};
};

void raise(double& largest, double value) {
    largest = std::max(largest, value);
}

/// Levels without voids: what fills a void is the next coarser surface, in double precision.
/// `top`: what fills the coarsest level.
std::vector<Grid<float>> filled_levels(const TileTree& tree, std::vector<Grid<float>> levels,
                                       float top) {
    for (int number = static_cast<int>(levels.size()) - 1; number >= 0; --number) {
        Grid<float>& level = levels[static_cast<std::size_t>(number)];
        for (int row = 0; row < level.rows(); ++row) {
            for (int col = 0; col < level.cols(); ++col) {
                if (!std::isnan(level(col, row))) {
                    continue;
                }
                const bool is_top = static_cast<std::size_t>(number) + 1 == levels.size();
                level(col, row) = is_top ? top
                                         : static_cast<float>(surface_at(
                                               tree, levels[static_cast<std::size_t>(number) + 1],
                                               number + 1, std::min(col << number, tree.cols() - 1),
                                               std::min(row << number, tree.rows() - 1)));
            }
        }
    }
    return levels;
}

/// The exact figures of a tile, from all of its samples. `filled`: levels without voids.
ExactProof exact_proof(const TileTree& tree, TreeTile tile, const Grid<float>& samples,
                       const std::vector<Grid<float>>& filled) {
    const Grid<float>& level = filled[static_cast<std::size_t>(tile.level)];
    ExactProof proof;
    const glm::ivec2 first = TileTree::first(tile);
    const glm::ivec2 last = tree.sample(tile, tree.cells(tile));
    double error = 0.0;
    for (int row = first.y; row <= last.y; ++row) {
        for (int col = first.x; col <= last.x; ++col) {
            const float height = filled.front()(col, row);
            if (std::isnan(samples(col, row))) {
                proof.has_voids = true;
            } else {
                proof.low = std::min(proof.low, height);
                proof.high = std::max(proof.high, height);
            }
            {
                const double surface = surface_at(tree, level, tile.level, col, row);
                error = std::max(error, std::abs(height - surface));
                const glm::ivec2 cell =
                    glm::min((glm::ivec2(col, row) - first) >> tile.level, tree.cells(tile) - 1);
                const glm::ivec2 block = cell / cells_per_error_block;
                raise(proof.block_errors.at(
                          static_cast<std::size_t>(block.y * error_blocks + block.x)),
                      std::abs(height - surface));
                // A sample on a line between parts belongs to both.
                const glm::ivec2 before =
                    glm::max((glm::ivec2(col, row) - first - 1) >> tile.level, glm::ivec2(0));
                for (const int part_row : {before.y, cell.y}) {
                    for (const int part_col : {before.x, cell.x}) {
                        const int part = part_row / cells_per_error_part * error_parts +
                                         part_col / cells_per_error_part;
                        raise(proof.part_errors.at(static_cast<std::size_t>(part)),
                              std::abs(height - surface));
                    }
                }
            }
        }
    }
    proof.error = static_cast<float>(error);
    return proof;
}

/// Checks all tiles of a terrain; returns bound over exact error of the coarser ones.
std::vector<double> expect_proven(const Grid<float>& samples, const geo::GlobalWrap& wrap = {},
                                  float any_height = 100.0F) {
    const TileTree tree(samples.cols(), samples.rows(), wrap);
    const Proven proven = prove_all(tree, samples);
    // What fills the coarsest level does not change errors.
    const auto filled = filled_levels(tree, proven.heights, any_height);
    std::vector<double> ratios;
    for (const auto& [tile, proof] : proven.tiles) {
        const ExactProof exact = exact_proof(tree, tile, samples, filled);
        EXPECT_EQ(proof.low, exact.low);
        EXPECT_EQ(proof.high, exact.high);
        EXPECT_EQ(proof.has_voids, exact.has_voids);
        EXPECT_GE(proof.error, exact.error) << tile.level << " " << tile.col << " " << tile.row;
        for (std::size_t i = 0; i < exact.block_errors.size(); ++i) {
            EXPECT_GE(proof.block_error(i), exact.block_errors[i]) << i;
            EXPECT_LE(proof.block_error(i), proof.error);
        }
        const PartShares& parts = proven.parts.at(tile);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            EXPECT_GE(parts.at(i) / 255.0 * proof.error, exact.part_errors.at(i)) << i;
        }
        EXPECT_TRUE(tile.level == 0 || are_parts_of(parts, proof.block_shares));
        if (tile.level > 0 && exact.error > 0.0F) {
            ratios.push_back(static_cast<double>(proof.error) / exact.error);
        }
    }
    return ratios;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

TEST(TileError, IsNeverBelowTheExactOneAndTightInTheMedian) {
    RELJEF_RELEASE_ONLY("millions of samples by the lines of the next tests");
    test::Chance chance(20);
    std::vector<double> ratios;
    for (int n = 0; n < 24; ++n) {
        Grid<float> samples = made_terrain(chance, chance.whole(2, 1500), chance.whole(2, 700));
        if (chance.one_in(3)) {
            add_voids(chance, samples);
        }
        const auto found = expect_proven(samples);
        ratios.insert(ratios.end(), found.begin(), found.end());
    }
    EXPECT_GT(ratios.size(), 200U);
    EXPECT_LE(median(ratios), 1.1); // exact in the first three levels
    RecordProperty("median", std::to_string(median(ratios)));
    RecordProperty("tiles", std::to_string(ratios.size()));
}

TEST(TileError, HoldsInCellsThatTheRastersEndCuts) {
    test::Chance chance(7);
    for (int n = 0; n < 300; ++n) {
        Grid<float> samples(chance.whole(2, 40), chance.whole(2, 40));
        for (int row = 0; row < samples.rows(); ++row) {
            for (int col = 0; col < samples.cols(); ++col) {
                const bool at_end = col > samples.cols() - 4 || row > samples.rows() - 4;
                samples(col, row) = at_end ? static_cast<float>(chance.between(0.0, 90.0)) : 0.0F;
            }
        }
        expect_proven(samples);
    }
}

geo::GlobalWrap made_wrap(test::Chance& chance) {
    geo::GlobalWrap wrap{.around = true, .east = chance.one_in(2)};
    const auto added = [&] {
        const std::array distances{0.0, 0.5, 1.0, chance.between(0.01, 1.0)};
        return distances.at(static_cast<std::size_t>(chance.whole(0, 3)));
    };
    wrap.north = added();
    wrap.south = added();
    wrap.begins_at_pole = wrap.north > 0.0 || chance.one_in(2);
    wrap.ends_at_pole = wrap.south > 0.0 || chance.one_in(2);
    return wrap;
}

/// Closes a terrain at the seam and the poles.
Grid<float> made_globe(test::Chance& chance, glm::ivec2 size, const geo::GlobalWrap& wrap) {
    Grid<float> samples = made_terrain(chance, size.x, size.y);
    if (chance.one_in(3)) {
        add_voids(chance, samples);
    }
    const float pole = samples(0, 0);
    for (int col = 0; col < size.x; ++col) {
        samples(col, 0) = wrap.begins_at_pole ? pole : samples(col, 0);
        samples(col, size.y - 1) = wrap.ends_at_pole ? -pole : samples(col, size.y - 1);
    }
    for (int row = 0; row < size.y; ++row) {
        samples(size.x - 1, row) = samples(0, row);
    }
    return samples;
}

bool are_equal(float a, float b) {
    return a == b || (std::isnan(a) && std::isnan(b));
}

void expect_closed(const Proven& proven, const geo::GlobalWrap& wrap) {
    for (const Grid<float>& heights : proven.heights) {
        const int last_col = heights.cols() - 1;
        const int last_row = heights.rows() - 1;
        for (int row = 0; row <= last_row; ++row) {
            ASSERT_TRUE(are_equal(heights(0, row), heights(last_col, row))) << row;
        }
        for (int col = 0; col <= last_col; ++col) {
            ASSERT_TRUE(!wrap.begins_at_pole || are_equal(heights(col, 0), heights(0, 0)));
            ASSERT_TRUE(!wrap.ends_at_pole ||
                        are_equal(heights(col, last_row), heights(0, last_row)));
        }
    }
}

void expect_means(const TileTree& tree, const Proven& proven) {
    for (std::size_t level = 1; level < proven.heights.size(); ++level) {
        const Grid<float>& heights = proven.heights[level];
        for (int row = 0; row < heights.rows(); ++row) {
            for (int col = 0; col < heights.cols(); ++col) {
                const float expected = mean_around(tree, proven.heights[level - 1], col, row);
                ASSERT_EQ(std::isnan(heights(col, row)), std::isnan(expected))
                    << level << ": " << col << "," << row;
                if (!std::isnan(expected)) {
                    ASSERT_NEAR(heights(col, row), expected, 1e-2)
                        << level << ": " << col << "," << row;
                }
            }
        }
    }
}

TEST(TileError, HoldsOnGlobesWhichStayClosedAtAllLevels) {
    test::Chance chance(90);
    for (int n = 0; n < test::rounds(60, 12); ++n) {
        const geo::GlobalWrap wrap = made_wrap(chance);
        const int around = n % 20 == 0 ? chance.whole(1025, 2200) : chance.whole(4, 400);
        const Grid<float> samples = made_globe(chance, {around + 1, chance.whole(2, 300)}, wrap);
        const TileTree tree(samples.cols(), samples.rows(), wrap);
        const Proven proven = prove_all(tree, samples);
        expect_closed(proven, wrap);
        expect_means(tree, proven);
        expect_proven(samples, wrap);
    }
}

TEST(TileError, HeightsAreTheWeightedMeansAcrossChunks) {
    test::Chance chance(3);
    Grid<float> samples = made_terrain(chance, 2077, 300);
    add_voids(chance, samples);
    const TileTree tree(samples.cols(), samples.rows());
    expect_means(tree, prove_all(tree, samples));
}

/// The samples of a tile as heights_from_samples() expects them.
Grid<float> samples_around(const TileTree& tree, TreeTile tile, const Grid<float>& samples) {
    const int border = sample_border(tile.level);
    const glm::ivec2 first = TileTree::first(tile) - border;
    const glm::ivec2 size = tree.cells(tile) * TileTree::step(tile) + 1 + 2 * border;
    Grid<float> around(size.x, size.y);
    for (int row = 0; row < size.y; ++row) {
        for (int col = 0; col < size.x; ++col) {
            around(col, row) = height_around(tree, samples, first + glm::ivec2(col, row));
        }
    }
    return around;
}

/// Each claims something that the samples contradict.
std::vector<TileProof> wrong_proofs(const TileProof& proof) {
    std::vector<TileProof> wrong(4, proof);
    wrong[0].error *= 0.9F;
    wrong[1].low += 1.0F;
    wrong[2].high -= 1.0F;
    wrong[3].has_voids = !proof.has_voids;
    return wrong;
}

void expect_parts_from_samples(const TileTree& tree, const Grid<float>& samples) {
    const Proven proven = prove_all(tree, samples);
    for (const auto& [tile, proof] : proven.tiles) {
        if (tile.level == 0 || tile.level > tree.root().level) {
            continue;
        }
        const Grid<float> around = samples_around(tree, tile, samples);
        const Grid<float> heights = heights_from_samples(tree, tile, around);
        const ProofCheck check = check_proof(tree, tile, proof, heights, &around);
        EXPECT_EQ(check.contradiction, std::nullopt);
        ASSERT_TRUE(check.parts);
        const ExactProof exact =
            exact_proof(tree, tile, samples, filled_levels(tree, proven.heights, 0.0F));
        const double rounding = 14.0 / (1 << 24) * std::max(std::abs(proof.low), proof.high);
        for (std::size_t i = 0; i < check.parts->size(); ++i) {
            const double error = check.parts->at(i) / 255.0 * proof.error;
            EXPECT_GE(error, exact.part_errors.at(i));
            EXPECT_LE(error, exact.part_errors.at(i) + rounding + 2.01 * proof.error / 255.0);
        }
        EXPECT_FALSE(check_proof(tree, tile, proof, heights).parts);
        for (const TileProof& wrong : wrong_proofs(proof)) {
            EXPECT_TRUE(check_proof(tree, tile, wrong, heights, &around).contradiction);
        }
    }
}

TEST(CheckProof, TellsThePartsOfATileFromItsSamples) {
    test::Chance chance(31);
    const Grid<float> samples = made_terrain(chance, 400, 290);
    expect_parts_from_samples({400, 290}, samples);
}

TEST(CheckProof, TellsThemOnGlobes) {
    test::Chance chance(32);
    const geo::GlobalWrap wrap = made_wrap(chance);
    expect_parts_from_samples({397, 290, wrap}, made_globe(chance, {397, 290}, wrap));
}

} // namespace
} // namespace reljef::terrain
