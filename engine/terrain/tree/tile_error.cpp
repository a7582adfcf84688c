#include "engine/terrain/tree/tile_error.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "engine/core/check.h"

namespace reljef::terrain {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

// NaN never wins if the first argument is none.
float lower(float a, float b) {
    return b < a ? b : a;
}
float higher(float a, float b) {
    return b > a ? b : a;
}

/// A row of vertices, apart by their place: loops over contiguous floats become vector code.
struct SplitRow {
    std::vector<float> on;      ///< at the coarser vertices
    std::vector<float> between; ///< around them: one more

    explicit SplitRow(std::size_t coarse) : on(coarse), between(coarse + 1) {}
};

// The loops below run over plain pointers, and what they write overlaps nothing else: otherwise
// checks of bounds and of overlaps keep them from becoming vector code.
using Output = float* __restrict;

void split(std::span<const float> row, SplitRow& into) {
    const std::size_t count = into.on.size();
    const float* const from = row.data();
    const Output between = into.between.data();
    const Output on = into.on.data();
    for (std::size_t i = 0; i < count; ++i) {
        between[i] = from[2 * i];
        on[i] = from[2 * i + 1];
    }
    between[count] = from[2 * count];
}

float mean_without_voids(const std::array<const SplitRow*, 3>& rows, std::size_t i) {
    float sum = 0.0F;
    float weights = 0.0F;
    const auto add = [&](float height, float weight) {
        sum += std::isnan(height) ? 0.0F : weight * height;
        weights += std::isnan(height) ? 0.0F : weight;
    };
    for (std::size_t j = 0; j < rows.size(); ++j) {
        const float weight = j == 1 ? 2.0F : 1.0F;
        add(rows.at(j)->between[i], weight);
        add(rows.at(j)->on[i], 2.0F * weight);
        add(rows.at(j)->between[i + 1], weight);
    }
    return weights > 0.0F ? sum / weights : std::numeric_limits<float>::quiet_NaN();
}

void add_weighted(const std::vector<float>& above, const std::vector<float>& on,
                  const std::vector<float>& below, std::vector<float>& sums) {
    const float* const a = above.data();
    const float* const b = on.data();
    const float* const c = below.data();
    const Output sum = sums.data();
    for (std::size_t i = 0; i < sums.size(); ++i) {
        sum[i] = a[i] + c[i] + 2.0F * b[i];
    }
}

/// A row of the coarser level from the rows above, on and below it.
void coarsen(const std::array<const SplitRow*, 3>& rows, SplitRow& sums, std::span<float> coarse) {
    const auto [above, on, below] = rows;
    add_weighted(above->on, on->on, below->on, sums.on);
    add_weighted(above->between, on->between, below->between, sums.between);
    const float* const sum_on = sums.on.data();
    const float* const sum_between = sums.between.data();
    const Output means = coarse.data();
    int voids = 0;
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        const float mean = (sum_between[i] + sum_between[i + 1] + 2.0F * sum_on[i]) * 0.0625F;
        means[i] = mean;
        voids |= mean != mean ? 1 : 0;
    }
    for (std::size_t i = 0; voids != 0 && i < coarse.size(); ++i) {
        coarse[i] = std::isnan(coarse[i]) ? mean_without_voids(rows, i) : coarse[i];
    }
}

/// Copies the outermost vertices of a level (0 and `last`) to those outside; `first`: of the grid.
void repeat_border(Grid<float>& heights, glm::ivec2 first, glm::ivec2 last) {
    const glm::ivec2 end = first + glm::ivec2(heights.cols(), heights.rows()) - 1;
    if (first.x >= 0 && first.y >= 0 && end.x <= last.x && end.y <= last.y) {
        return;
    }
    const Grid<float> before = heights;
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            heights(col, row) = before(std::clamp(first.x + col, 0, last.x) - first.x,
                                       std::clamp(first.y + row, 0, last.y) - first.y);
        }
    }
}

/// Along an axis: where the finer vertex between the last two coarser ones lies, because the
/// raster's end cuts their cell.
struct LastCell {
    int cell = -1;      ///< its index; -1: none is cut
    double share = 0.5; ///< of the cell
};

LastCell last_cell(int last_sample, int level, int first_cell, int cells) {
    const int step = 1 << level;
    const int cut = (last_sample - 1) / step;
    const int width = last_sample - cut * step;
    const bool is_here = cut >= first_cell && cut < first_cell + cells && width < step;
    return is_here ? LastCell{cut - first_cell, std::min(1.0, 0.5 * step / width)} : LastCell{};
}

/// Between two heights; one that has no share may be a void.
float mixed(float a, float b, double share) {
    return share == 1.0 ? b : static_cast<float>(glm::mix<double>(a, b, share));
}

/// Finer vertices of a row minus the coarser surface. Voids: low is ∞, high is -∞.
struct Differences {
    SplitRow low;
    SplitRow high;

    explicit Differences(std::size_t coarse) : low(coarse), high(coarse) {}

    /// `coarse`: the surface at the row; `cut`: index of a cut cell, as its left vertex.
    void set(const SplitRow& row, std::span<const float> coarse, LastCell cut) {
        const std::size_t count = coarse.size();
        const float* const surface = coarse.data();
        set_on(row.on.data(), surface, count);
        set_between(row.between.data() + 1, surface, count - 1);
        if (cut.cell >= 0) {
            const auto i = static_cast<std::size_t>(cut.cell) + 1;
            const float difference = row.between[i] - mixed(coarse[i - 1], coarse[i], cut.share);
            low.between[i] = lower(infinite, difference);
            high.between[i] = higher(-infinite, difference);
        }
    }

private:
    void set_on(const float* heights, const float* surface, std::size_t count) {
        const Output low_on = low.on.data();
        const Output high_on = high.on.data();
        for (std::size_t i = 0; i < count; ++i) {
            const float difference = heights[i] - surface[i];
            low_on[i] = lower(infinite, difference);
            high_on[i] = higher(-infinite, difference);
        }
    }
    void set_between(const float* heights, const float* surface, std::size_t count) {
        const Output low_between = low.between.data() + 1;
        const Output high_between = high.between.data() + 1;
        for (std::size_t i = 0; i < count; ++i) {
            const float difference = heights[i] - 0.5F * (surface[i] + surface[i + 1]);
            low_between[i] = lower(infinite, difference);
            high_between[i] = higher(-infinite, difference);
        }
    }
};

struct Lower {
    float operator()(float a, float b) const { return lower(a, b); }
};
struct Higher {
    float operator()(float a, float b) const { return higher(a, b); }
};

using SplitRows = std::array<const SplitRow*, 3>;

/// The extremes of three rows of differences; cell 0 is right of vertex `first`.
template <class Extreme>
void extremes_of(const SplitRows& rows, std::size_t first, Extreme extreme, SplitRow& into) {
    const std::size_t cells = into.on.size() - 1;
    const Output on = into.on.data();
    const Output between = into.between.data();
    const auto [a, b, c] = rows;
    const float* const on_a = a->on.data() + first;
    const float* const on_b = b->on.data() + first;
    const float* const on_c = c->on.data() + first;
    for (std::size_t i = 0; i <= cells; ++i) {
        on[i] = extreme(extreme(on_a[i], on_b[i]), on_c[i]);
    }
    const float* const between_a = a->between.data() + first + 1;
    const float* const between_b = b->between.data() + first + 1;
    const float* const between_c = c->between.data() + first + 1;
    for (std::size_t i = 0; i < cells; ++i) {
        between[i] = extreme(extreme(between_a[i], between_b[i]), between_c[i]);
    }
}

/// The extreme in each cell.
template <class Extreme>
void join_vertices(const SplitRow& vertices, Extreme extreme, std::span<float> cells) {
    const float* const on = vertices.on.data();
    const float* const between = vertices.between.data();
    const Output into = cells.data();
    for (std::size_t i = 0; i < cells.size(); ++i) {
        into[i] = extreme(extreme(on[i], on[i + 1]), between[i]);
    }
}

/// The extreme in each cell of its two finer cells' own extremes, moved by those of the vertices.
template <class Extreme>
void join_cells(const SplitRow& vertices, std::span<const float> finer, Extreme extreme,
                std::span<float> cells) {
    const float* const on = vertices.on.data();
    const float* const between = vertices.between.data();
    const float* const own = finer.data();
    const Output into = cells.data();
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const float left = own[2 * i] + extreme(on[i], between[i]);
        const float right = own[2 * i + 1] + extreme(on[i + 1], between[i]);
        into[i] = extreme(into[i], extreme(left, right));
    }
}

/// The finer level of a step upwards.
struct FinerLevel {
    VertexRows rows;
    glm::ivec2 vertices{0}; ///< odd
    const Residuals* residuals = nullptr;
};

/// Computes a level of a chunk from the finer one, row by row.
class LevelStep {
public:
    /// `cells`: of the chunk at the coarser level; `inside`: those on the raster.
    LevelStep(const FinerLevel& finer, glm::ivec2 cells, glm::ivec2 inside,
              const std::array<LastCell, 2>& cuts)
        : finer_(finer), count_(static_cast<std::size_t>(finer.vertices.x / 2)), inside_(inside),
          cut_cols_(cuts[0]), cut_rows_(cuts[1]), line_(2 * count_ + 1), sums_(count_),
          middle_(count_), extremes_(static_cast<std::size_t>(inside.x) + 1),
          rows_(4, SplitRow(count_)), differences_(3, Differences(count_)) {
        const int rows = finer.vertices.y / 2;
        level_.heights = Grid<float>(static_cast<int>(count_), rows);
        level_.border = (rows - cells.y - 1) / 2;
        cut_cols_.cell += cut_cols_.cell >= 0 ? level_.border : 0;
        level_.residuals = {Grid<float>(cells.x, cells.y, infinite),
                            Grid<float>(cells.x, cells.y, -infinite)};
    }

    ChunkLevel run() && {
        load(0);
        for (int row = 0; row < level_.heights.rows(); ++row) {
            load(2 * row + 1);
            load(2 * row + 2);
            coarsen({&finer(2 * row), &finer(2 * row + 1), &finer(2 * row + 2)}, sums_,
                    level_.heights.row(row));
            differences_at(2 * row + 1).set(finer(2 * row + 1), level_.heights.row(row), cut_cols_);
            const int cell = row - 1 - level_.border;
            if (cell >= 0 && cell < inside_.y) {
                set_middle(row, cell);
                add_cell_row(row, cell);
            }
        }
        return std::move(level_);
    }

private:
    void load(int row) {
        finer_.rows(row, line_);
        split(line_, finer(row));
    }
    SplitRow& finer(int row) { return rows_[static_cast<std::size_t>(row % 4)]; }
    Differences& differences_at(int row) { return differences_[static_cast<std::size_t>(row % 3)]; }

    /// Differences of the finer row between the coarser rows `row` - 1 and `row`.
    void set_middle(int row, int cell) {
        const auto above = level_.heights.row(row - 1);
        const auto below = level_.heights.row(row);
        const float* const a = above.data();
        const float* const b = below.data();
        const Output middle = middle_.data();
        for (std::size_t i = 0; i < count_; ++i) {
            middle[i] = 0.5F * (a[i] + b[i]);
        }
        for (std::size_t i = 0; cell == cut_rows_.cell && i < count_; ++i) {
            middle_[i] = mixed(above[i], below[i], cut_rows_.share);
        }
        differences_at(2 * row).set(finer(2 * row), middle_, cut_cols_);
    }

    void add_cell_row(int row, int cell) {
        const auto cols = static_cast<std::size_t>(inside_.x);
        const auto low = level_.residuals.low.row(cell).first(cols);
        const auto high = level_.residuals.high.row(cell).first(cols);
        const std::array rows{&differences_at(2 * row - 1), &differences_at(2 * row),
                              &differences_at(2 * row + 1)};
        const Residuals* const finer = finer_.residuals;
        add_extremes({&rows[0]->low, &rows[1]->low, &rows[2]->low}, cell, Lower(), low,
                     finer != nullptr ? &finer->low : nullptr);
        add_extremes({&rows[0]->high, &rows[1]->high, &rows[2]->high}, cell, Higher(), high,
                     finer != nullptr ? &finer->high : nullptr);
    }

    template <class Extreme>
    void add_extremes(const SplitRows& rows, int cell, Extreme extreme, std::span<float> cells,
                      const Grid<float>* finer) {
        const auto first = static_cast<std::size_t>(level_.border);
        if (finer == nullptr) {
            extremes_of(rows, first, extreme, extremes_);
            join_vertices(extremes_, extreme, cells);
            return;
        }
        extremes_of({rows[0], rows[1], rows[1]}, first, extreme, extremes_);
        join_cells(extremes_, finer->row(2 * cell), extreme, cells);
        extremes_of({rows[1], rows[2], rows[2]}, first, extreme, extremes_);
        join_cells(extremes_, finer->row(2 * cell + 1), extreme, cells);
    }

    const FinerLevel& finer_;
    std::size_t count_; // coarser vertices of a row
    glm::ivec2 inside_;
    LastCell cut_cols_; // index of its left vertex
    LastCell cut_rows_;
    std::vector<float> line_;
    SplitRow sums_;
    std::vector<float> middle_;
    SplitRow extremes_;                    // of a row of cells
    std::vector<SplitRow> rows_;           // by row modulo 4
    std::vector<Differences> differences_; // by row modulo 3
    ChunkLevel level_;
};

/// Ranges of the base level's heights: of each tile, and the largest of all.
class BaseRanges {
public:
    BaseRanges(glm::ivec2 tiles, int cols)
        : tiles_(tiles.x, tiles.y), low_(static_cast<std::size_t>(cols), infinite),
          high_(low_.size(), -infinite) {}

    /// Rows in order, with the chunk's border.
    void add(int row, std::span<const float> heights, bool is_last) {
        join(heights);
        const int vertex = row - chunk_border;
        if (is_last || (vertex >= 0 && vertex % tile_cells == 0)) {
            close(vertex > 0 ? (vertex - 1) / tile_cells : -1);
            join(heights);
        }
    }
    [[nodiscard]] float largest() const { return largest_; }
    [[nodiscard]] Grid<TileProof>& tiles() { return tiles_; }

private:
    void join(std::span<const float> heights) {
        const float* const more = heights.data();
        const Output low = low_.data();
        const Output high = high_.data();
        for (std::size_t i = 0; i < heights.size(); ++i) {
            low[i] = lower(low[i], more[i]);
            high[i] = higher(high[i], more[i]);
        }
    }
    /// Ends a row of tiles; rows outside the chunk have none.
    void close(int row) {
        for (int col = 0; row >= 0 && row < tiles_.rows() && col < tiles_.cols(); ++col) {
            const auto first = static_cast<std::size_t>(chunk_border + col * tile_cells);
            const std::size_t end = std::min(first + tile_cells + 1, low_.size());
            TileProof& tile = tiles_(col, row);
            for (std::size_t i = first; i < end; ++i) {
                tile.low = lower(tile.low, low_[i]);
                tile.high = higher(tile.high, high_[i]);
            }
        }
        for (std::size_t i = 0; i < low_.size(); ++i) {
            largest_ = higher(higher(largest_, high_[i]), -low_[i]);
        }
        std::fill(low_.begin(), low_.end(), infinite);
        std::fill(high_.begin(), high_.end(), -infinite);
    }

    Grid<TileProof> tiles_;
    std::vector<float> low_; // of the vertices of a column, so far in a row of tiles
    std::vector<float> high_;
    float largest_ = 0.0F;
};

/// Tiles of a level from the tiles below it and from its residuals. `rounding`: metres.
Grid<TileProof> tiles_of(const Grid<TileProof>& below, const Residuals& residuals, float rounding) {
    Grid<TileProof> tiles((below.cols() + 1) / 2, (below.rows() + 1) / 2);
    for (int row = 0; row < below.rows(); ++row) {
        for (int col = 0; col < below.cols(); ++col) {
            TileProof& tile = tiles(col / 2, row / 2);
            tile.low = lower(tile.low, below(col, row).low);
            tile.high = higher(tile.high, below(col, row).high);
        }
    }
    std::vector<float> errors(static_cast<std::size_t>(residuals.low.cols()));
    for (int row = 0; row < residuals.low.rows(); ++row) {
        const float* const low = residuals.low.row(row).data();
        const float* const high = residuals.high.row(row).data();
        const Output error = errors.data();
        for (std::size_t i = 0; i < errors.size(); ++i) {
            error[i] = higher(higher(error[i], -low[i]), high[i]);
        }
        if (row % tile_cells == tile_cells - 1 || row == residuals.low.rows() - 1) {
            for (std::size_t i = 0; i < errors.size(); ++i) {
                float& largest = tiles(static_cast<int>(i) / tile_cells, row / tile_cells).error;
                largest = higher(largest, errors[i]);
            }
            std::fill(errors.begin(), errors.end(), 0.0F);
        }
    }
    for (TileProof& tile : tiles.samples()) {
        const bool is_flat = tile.low >= tile.high; // means of equal heights are exact
        tile.error =
            is_flat && tile.error == 0.0F ? 0.0F : std::nextafter(tile.error + rounding, infinite);
    }
    return tiles;
}

void widen(Residuals& residuals, float rounding) {
    for (std::size_t i = 0; i < residuals.low.size(); ++i) {
        residuals.low.samples()[i] -= rounding; // ∞ stays ∞
        residuals.high.samples()[i] += rounding;
    }
}

VertexRows rows_of(const Grid<float>& heights) {
    return [&heights](int row, std::span<float> into) {
        std::copy(heights.row(row).begin(), heights.row(row).end(), into.begin());
    };
}

// Rounding of a step upwards, in units of the largest height: 2^-24 for each of three means (of two
// heights, and of two such means), twice that for the difference of heights, and four times for the
// sum of two differences.
constexpr float rounding_per_level = 9.0F / 16777216.0F;

} // namespace

glm::ivec2 level_cells(const TileTree& tree, int level) {
    const int step = 1 << level;
    return (glm::ivec2(tree.cols(), tree.rows()) - 2 + step) / step;
}

glm::ivec2 level_tiles(const TileTree& tree, int level) {
    return (level_cells(tree, level) + tile_cells - 1) / tile_cells;
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
    const glm::ivec2 last(tree.cols() - 1, tree.rows() - 1);
    const glm::ivec2 size = chunk_size(tree, chunk);
    const glm::ivec2 vertices = size + 1 + 2 * chunk_border;
    const glm::ivec2 base_tiles =
        glm::min(level_tiles(tree, chunk.base) - first_vertex(chunk) / tile_cells,
                 glm::ivec2(chunk_cells / tile_cells));
    BaseRanges ranges(base_tiles, vertices.x);
    ChunkProof proof;
    FinerLevel finer{[&](int row, std::span<float> heights) {
                         input.heights(row, heights);
                         ranges.add(row, heights, row == vertices.y - 1);
                     },
                     vertices, input.residuals};
    for (int i = 0; i < levels_per_chunk; ++i) {
        const int level = chunk.base + i + 1;
        const glm::ivec2 first = first_vertex(chunk) / (2 << i);
        const glm::ivec2 cells = size / (2 << i);
        const glm::ivec2 end = level_cells(tree, level);
        const std::array cuts{last_cell(last.x, level, first.x, cells.x),
                              last_cell(last.y, level, first.y, cells.y)};
        ChunkLevel& made = proof.levels.at(static_cast<std::size_t>(i));
        made = LevelStep(finer, cells, glm::min(cells, end - first), cuts).run();
        repeat_border(made.heights, first - made.border, end);
        finer = {
            rows_of(made.heights), {made.heights.cols(), made.heights.rows()}, &made.residuals};
    }
    const Grid<TileProof>* below = input.tiles != nullptr ? input.tiles : &ranges.tiles();
    float largest = ranges.largest();
    for (const TileProof& tile : below->samples()) {
        largest = higher(higher(largest, tile.high), -tile.low);
    }
    for (int i = 0; i < levels_per_chunk; ++i) {
        ChunkLevel& made = proof.levels.at(static_cast<std::size_t>(i));
        const float rounding = largest * rounding_per_level * static_cast<float>(i + 1);
        made.tiles = tiles_of(*below, made.residuals, rounding);
        below = &made.tiles;
    }
    widen(proof.levels.back().residuals, largest * rounding_per_level * levels_per_chunk);
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
        const glm::ivec2 coarse((samples.cols() - 1) / 2, (samples.rows() - 1) / 2);
        Grid<float> heights(coarse.x, coarse.y);
        SplitRow sums(static_cast<std::size_t>(coarse.x));
        std::vector<SplitRow> rows(3, sums);
        const auto at = [&](int row) { return &rows[static_cast<std::size_t>(row % 3)]; };
        split(samples.row(0), *at(0));
        for (int row = 0; row < coarse.y; ++row) {
            split(samples.row(2 * row + 1), *at(2 * row + 1));
            split(samples.row(2 * row + 2), *at(2 * row + 2));
            coarsen({at(2 * row), at(2 * row + 1), at(2 * row + 2)}, sums, heights.row(row));
        }
        const glm::ivec2 first = TileTree::first(tile) / (1 << level) - (border >> level);
        repeat_border(heights, first, level_cells(tree, level));
        samples = std::move(heights);
    }
    return samples;
}

namespace {

/// Bilinear on a tile; vertices without a share may be voids.
float surface_at(const TileTree& tree, TreeTile tile, const Grid<float>& heights,
                 glm::ivec2 sample) {
    const glm::ivec2 cell =
        glm::min((sample - TileTree::first(tile)) / TileTree::step(tile), tree.cells(tile) - 1);
    const glm::dvec2 low(tree.sample(tile, cell));
    const glm::dvec2 share =
        (glm::dvec2(sample) - low) / (glm::dvec2(tree.sample(tile, cell + 1)) - low);
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

/// Compares a proof with all samples of the tile.
std::optional<std::string> contradiction_of_samples(const TileTree& tree, TreeTile tile,
                                                    const TileProof& proof,
                                                    const Grid<float>& heights,
                                                    const Grid<float>& samples) {
    const int border = sample_border(tile.level);
    const glm::ivec2 first = TileTree::first(tile);
    const glm::ivec2 last = tree.sample(tile, tree.cells(tile));
    TileProof found;
    for (int row = first.y; row <= last.y; ++row) {
        for (int col = first.x; col <= last.x; ++col) {
            const float height = samples(col - first.x + border, row - first.y + border);
            if (!std::isnan(height)) {
                const float difference = height - surface_at(tree, tile, heights, {col, row});
                found.low = lower(found.low, height);
                found.high = higher(found.high, height);
                found.error = higher(found.error, std::abs(difference));
            }
        }
    }
    if (found.low != proof.low || found.high != proof.high) {
        return found.low != proof.low ? found_text("a lowest height", proof.low, found.low)
                                      : found_text("a highest height", proof.high, found.high);
    }
    const float rounding = rounding_per_level * higher(std::abs(found.low), std::abs(found.high));
    return found.error > proof.error + rounding
               ? std::optional(found_text("an error", proof.error, found.error))
               : std::nullopt;
}

} // namespace

std::optional<std::string> contradiction(const TileTree& tree, TreeTile tile,
                                         const TileProof& proof, const Grid<float>& heights,
                                         const Grid<float>* samples) {
    const bool is_void = proof.low == infinite && proof.high == -infinite;
    const bool is_range =
        std::isfinite(proof.low) && std::isfinite(proof.high) && proof.low <= proof.high;
    if (!is_void && !is_range) {
        return fmt::format("heights from {} to {} m found, a range was expected", proof.low,
                           proof.high);
    }
    if (!(proof.error >= 0.0F) || std::isinf(proof.error)) {
        return found_text("an error", proof.error, 0.0);
    }
    if (samples != nullptr || tile.level == 0) {
        return contradiction_of_samples(tree, tile, proof, heights,
                                        samples != nullptr ? *samples : heights);
    }
    // Vertices inside the tile are means of its own samples.
    const float largest = is_void ? 0.0F : higher(std::abs(proof.low), std::abs(proof.high));
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

} // namespace reljef::terrain
