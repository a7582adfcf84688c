#include "engine/io/tree_tile.h"

#include <algorithm>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "engine/io/gdal_dataset.h"

namespace reljef::io {
namespace {

// Of a side, samples: below that, all of a file is read in less than a second.
constexpr int needs_overviews = 8192;
constexpr std::size_t most_files_looked_at = 16;

// Along one axis: the values of a tile with one around that lie on the raster.
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

} // namespace

TileWindow read_tree_tile(const TileSet& tiles, const TileGrid& grid, const terrain::TileTree& tree,
                          terrain::TreeTile tile, Gaps gaps, std::stop_token stop) {
    check(grid.cols == tree.cols() && grid.rows == tree.rows(), "a tree over another grid");
    const int step = terrain::TileTree::step(tile);
    const glm::ivec2 first = terrain::TileTree::first(tile);
    const glm::ivec2 count = tree.cells(tile) + 3;
    const TileGrid part{grid.first + grid.step * glm::dvec2(first - step),
                        grid.step * static_cast<double>(step), count.x, count.y};
    TileWindow window = tiles.read(part, gaps, stop);
    repeat_border(window.heights, inside_of(first.x, step, count.x, grid.cols),
                  inside_of(first.y, step, count.y, grid.rows));
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
    const std::size_t count = std::min(tiles.files().size(), most_files_looked_at);
    for (const TileFile& file : tiles.files().first(count)) {
        if (std::max(file.cols, file.rows) < needs_overviews) {
            continue;
        }
        const auto dataset = open_raster(file.path, messages);
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
