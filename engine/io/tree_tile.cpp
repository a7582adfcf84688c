#include "engine/io/tree_tile.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/mixed_overviews.h"
#include "engine/io/raster/sample_decoder.h"

namespace reljef::io {
namespace {

constexpr int needs_overviews = 8192; // samples per side; smaller files take under a second
constexpr std::size_t max_checked_files = 16;

// Along one axis: the values of a tile and its border that lie on the raster.
struct Inside {
    int first = 0;
    int last = 0;
};

Inside inside_of(int first_sample, int step, int count, int samples) {
    return {first_sample == 0 ? 1 : 0,
            std::min(count - 1, (samples - 1 - first_sample) / step + 1)};
}

void repeat_border(Grid<double>& heights, Inside cols, Inside rows) {
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            heights(col, row) = heights(std::clamp(col, cols.first, cols.last),
                                        std::clamp(row, rows.first, rows.last));
        }
    }
}

/// Adds the errors and bytes of another read.
void add_read(const TileWindow& other, TileWindow& window) {
    window.errors.insert(window.errors.end(), other.errors.begin(), other.errors.end());
    window.bytes_read += other.bytes_read;
}

/// Replaces the columns from `at` on.
void replace_cols(int at, const TileWindow& cols, TileWindow& window) {
    for (int row = 0; row < window.heights.rows(); ++row) {
        for (int col = 0; col < cols.heights.cols(); ++col) {
            window.heights(at + col, row) = cols.heights(col, row);
        }
    }
    add_read(cols, window);
}

/// Interpolates between a pole and the outermost row of the source. `from_pole(row)`: distance of a
/// window's row from the pole, in rows of the source.
template <class FromPole>
void close_pole(const TileWindow& outermost, double pole_height, const FromPole& from_pole,
                TileWindow& window) {
    for (int row = 0; row < window.heights.rows(); ++row) {
        const double share = from_pole(row);
        for (int col = 0; share < 1.0 && col < window.heights.cols(); ++col) {
            window.heights(col, row) =
                share <= 0.0 ? pole_height
                             : glm::mix(pole_height, outermost.heights(col, 0), share);
        }
    }
    add_read(outermost, window);
}

} // namespace

WrappedGrid wrapped_grid(const TileGrid& grid, const geo::GlobalWrap& wrap, int refinement) {
    WrappedGrid result{grid, wrap, refinement};
    result.grid.first.y -= grid.step.y * wrap.north_rows();
    result.grid.step /= static_cast<double>(refinement);
    result.grid.cols = (grid.cols + wrap.cols() - 1) * refinement + 1;
    result.grid.rows = (grid.rows + wrap.rows() - 1) * refinement + 1;
    return result;
}

Result<PoleHeights> pole_heights(const TileSet& tiles, const geo::GlobalWrap& wrap) {
    if (wrap.rows() == 0) {
        return PoleHeights{};
    }
    const auto found = tiles.heights(std::array{glm::dvec2(90.0, 0.0), glm::dvec2(-90.0, 0.0)});
    const auto height_of = [](const HeightSample& answer) {
        return answer.kind == HeightSample::Kind::height ? answer.height : void_value;
    };
    return found.errors.empty() ? Result<PoleHeights>(PoleHeights{height_of(found.answers[0]),
                                                                  height_of(found.answers[1])})
                                : Error{found.errors.front().message};
}

TileWindow read_tree_tile(const TileSet& tiles, const WrappedGrid& ground,
                          const terrain::TileTree& tree, terrain::TreeTile tile, Gaps gaps,
                          std::stop_token stop) {
    const TileGrid& grid = ground.grid;
    check(grid.cols == tree.cols() && grid.rows == tree.rows(), "a tree over another grid");
    const int step = terrain::TileTree::step(tile);
    const glm::ivec2 first = terrain::TileTree::first(tile);
    const glm::ivec2 last = glm::ivec2(grid.cols, grid.rows) - 1;
    const glm::ivec2 end = tree.cells(tile);
    const TileGrid part{grid.first + grid.step * glm::dvec2(first - step),
                        grid.step * static_cast<double>(step), end.x + 3, end.y + 3};
    TileWindow window = tiles.read(part, gaps, stop);
    const Inside cols = inside_of(first.x, step, part.cols, grid.cols);
    repeat_border(window.heights, cols, inside_of(first.y, step, part.rows, grid.rows));
    const auto read_cols = [&](int first_vertex, int count) {
        TileGrid cols = part;
        cols.first.x = grid.first.x + cols.step.x * first_vertex;
        cols.cols = count;
        return tiles.read(cols, gaps, stop);
    };
    if (ground.wrap.around && first.x == 0) {
        const int cells_around = (last.x + step - 1) / step;
        replace_cols(0, read_cols(cells_around - 1, 1), window);
    }
    if (ground.wrap.around && first.x + end.x * step >= last.x) {
        const bool has_sample = !ground.wrap.east && step <= ground.refinement;
        const int seam = has_sample ? 1 : 0; // the first vertex that is not there
        replace_cols(end.x + 1 + seam, read_cols(seam, 2 - seam), window);
    }
    const double refinement = ground.refinement;
    const auto read_row = [&](double y) {
        return tiles.read({{part.first.x, y}, part.step, part.cols, 1}, gaps, stop);
    };
    if (ground.wrap.north > 0.0 && first.y == 0) {
        const double outermost_y = grid.first.y + refinement * grid.step.y;
        close_pole(
            read_row(outermost_y), ground.north_height,
            [&](int row) { return (row - 1) * step / refinement; }, window);
    }
    if (ground.wrap.south > 0.0 && first.y + end.y * step >= last.y) {
        const double outermost_y = grid.first.y + (last.y - refinement) * grid.step.y;
        close_pole(
            read_row(outermost_y), ground.south_height,
            [&](int row) { return (last.y - first.y - (row - 1) * step) / refinement; }, window);
    }
    return window;
}

TileGrid picture_grid(const TileGrid& grid, terrain::TreeTile tile, glm::ivec2 cells,
                      glm::ivec2 size) {
    const glm::dvec2 first = grid.first + grid.step * glm::dvec2(terrain::TileTree::first(tile));
    const glm::dvec2 texels_per_cell = glm::dvec2(size - 1) / glm::dvec2(cells);
    const double step = terrain::TileTree::step(tile);
    return {first, grid.step * step / texels_per_cell, size.x, size.y};
}

std::optional<std::string> missing_overviews(const TileSet& tiles) {
    const GdalMessages messages;
    const std::size_t count = std::min(tiles.files().size(), max_checked_files);
    for (const TileFile& file : tiles.files().first(count)) {
        if (std::max(file.cols, file.rows) < needs_overviews) {
            continue;
        }
        const auto dataset = open_raster(file.path, messages);
        if (dataset && overviews_mix_voids(**dataset, file.path).value_or(false)) {
            return fmt::format("{0}: its overviews are averages of heights and of voids that it "
                               "does not declare, so that views from afar take long; "
                               "'gdal_edit.py -a_nodata VALUE {0}' and then 'gdaladdo -r average "
                               "{0} 4 16 64 256' make them anew",
                               file.path.string());
        }
        if (dataset && (*dataset)->GetRasterBand(1)->GetOverviewCount() == 0) {
            return fmt::format("{0}: {1}×{2} samples without overviews, so that views from afar "
                               "take long; 'gdaladdo -r average {0} 4 16 64 256' adds them, "
                               "'gdal_translate -of COG' writes a copy that has them",
                               file.path.string(), file.cols, file.rows);
        }
    }
    return std::nullopt;
}

} // namespace reljef::io
