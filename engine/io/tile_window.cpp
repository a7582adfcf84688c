#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/remote/read_scope.h"
#include "engine/io/tile_set_state.h"

namespace reljef::io {
namespace {

constexpr int max_reduction = 1'000'000;
// Of a window, 17 bytes each, and up to 16 values of 8 bytes: 32 cells for each sample of the
// largest grid, 512 a side, as where steps of a degree are narrow near a pole.
constexpr double max_cells = 1 << 23;

/// The samples of a window, and which of the whole set's they are: so that a sample has the same
/// place in all windows, to the last digit.
struct NumberedGrid {
    TileGrid window;
    glm::dvec2 origin{0.0}; ///< of the number (0, 0)
    glm::ivec2 first{0};    ///< number of the window's first sample

    [[nodiscard]] glm::dvec2 place(glm::ivec2 number) const {
        return origin + window.step * glm::dvec2(number);
    }
};

/// Samples that are not of the whole set are numbered from the window's first on.
NumberedGrid numbered(const TileGrid& window, const TileGrid& whole) {
    // Samples: coordinates of 10^7 m are rounded by 2·10^-9 m, and windows begin at samples.
    constexpr double same_place = 1e-3;
    constexpr double max_number = 1e9;
    const glm::dvec2 first = (window.first - whole.first) / whole.step;
    const glm::dvec2 away = glm::abs(first - glm::round(first));
    const bool is_of_whole = window.step == whole.step && std::max(away.x, away.y) < same_place &&
                             std::max(std::abs(first.x), std::abs(first.y)) < max_number;
    return is_of_whole ? NumberedGrid{window, whole.first, glm::ivec2(glm::round(first))}
                       : NumberedGrid{window, window.first, {0, 0}};
}

/// The samples of a grid on a layer's lattice.
class LayerPoints {
public:
    /// Absent if PROJ has no transform between the two systems.
    static std::optional<LayerPoints> create(const std::string& grid_crs, const NumberedGrid& grid,
                                             const TileLayer& layer) {
        LayerPoints points(grid, layer);
        if (layer.crs == grid_crs) {
            return points;
        }
        const auto transform = CrsTransform::create(grid_crs, layer.crs, layer.box);
        if (!transform) {
            return std::nullopt;
        }
        points.fill_controls(*transform);
        return points;
    }

    /// Bounds of all samples on the lattice.
    [[nodiscard]] PointBounds bounds() const {
        PointBounds bounds;
        for (int row = 0; row < grid_.window.rows; ++row) {
            for (int col = 0; col < grid_.window.cols; ++col) {
                bounds.add(at(col, row));
            }
        }
        return bounds;
    }

    /// The sample whose lattice position is nearest to a point.
    [[nodiscard]] glm::ivec2 nearest_to(glm::dvec2 point) const {
        glm::ivec2 nearest(0);
        double min_distance = std::numeric_limits<double>::infinity();
        for (int row = 0; row < grid_.window.rows; ++row) {
            for (int col = 0; col < grid_.window.cols; ++col) {
                if (const double found = glm::distance(at(col, row), point); found < min_distance) {
                    min_distance = found;
                    nearest = {col, row};
                }
            }
        }
        return nearest;
    }

    /// Lattice steps from a sample to the next one across and down.
    [[nodiscard]] glm::dvec2 steps_at(glm::ivec2 sample) const {
        const auto [col, row] = std::pair(sample.x, sample.y);
        const glm::dvec2 here = at(col, row);
        return {glm::distance(at(col + (col + 1 < grid_.window.cols ? 1 : -1), row), here),
                glm::distance(at(col, row + (row + 1 < grid_.window.rows ? 1 : -1)), here)};
    }

    /// Whether all samples lie on the layer's lattice, without a projection.
    [[nodiscard]] bool are_on_lattice() const {
        if (!controls_.empty()) {
            return false;
        }
        const glm::dvec2 first = glm::round(at(0, 0));
        const auto is_near = [&](int col, int row) { // the places are linear
            const glm::dvec2 away = glm::abs(at(col, row) - first - glm::dvec2(col, row));
            return std::max(away.x, away.y) < 0.5 * near_sample;
        };
        return is_near(0, 0) && is_near(grid_.window.cols - 1, 0) &&
               is_near(0, grid_.window.rows - 1) &&
               is_near(grid_.window.cols - 1, grid_.window.rows - 1);
    }

    /// Lattice position of a sample, in whole parts of a step so small that no height changes:
    /// differences of positions are then exact, in all windows. NaN if undefined.
    [[nodiscard]] glm::dvec2 at(int col, int row) const {
        constexpr double parts = 0x1p30;
        return glm::round(parts * exact_at(col, row)) / parts;
    }

private:
    // Over s samples of spacing d a chord deviates from a projection's curve by (s·d)²/8R with the
    // Earth's radius R: for 8 samples 1e-6 samples per metre of spacing.
    static constexpr int control_step = 8;

    LayerPoints(const NumberedGrid& grid, const TileLayer& layer) : grid_(grid), layer_(&layer) {}

    [[nodiscard]] glm::dvec2 exact_at(int col, int row) const {
        if (controls_.empty()) {
            return layer_->lattice_from_crs(grid_.place(grid_.first + glm::ivec2(col, row)));
        }
        const glm::ivec2 from_control = grid_.first + glm::ivec2(col, row) - first_control_;
        const int i = from_control.x / control_step;
        const int j = from_control.y / control_step;
        const double u = static_cast<double>(from_control.x % control_step) / control_step;
        const double v = static_cast<double>(from_control.y % control_step) / control_step;
        const int i1 = std::min(i + 1, controls_.cols() - 1);
        const int j1 = std::min(j + 1, controls_.rows() - 1);
        return glm::mix(glm::mix(controls_(i, j), controls_(i1, j), u),
                        glm::mix(controls_(i, j1), controls_(i1, j1), u), v);
    }

    // At the samples whose numbers are multiples of the step, in all windows.
    void fill_controls(const CrsTransform& transform) {
        const glm::ivec2 phase = ((grid_.first % control_step) + control_step) % control_step;
        first_control_ = grid_.first - phase;
        const glm::ivec2 count =
            (phase + glm::ivec2(grid_.window.cols, grid_.window.rows) + control_step - 1) /
                control_step +
            1;
        controls_ = Grid<glm::dvec2>(count.x, count.y);
        for (int j = 0; j < controls_.rows(); ++j) {
            for (int i = 0; i < controls_.cols(); ++i) {
                controls_(i, j) = grid_.place(first_control_ + control_step * glm::ivec2(i, j));
            }
        }
        transform.apply(controls_.samples());
        for (glm::dvec2& point : controls_.samples()) {
            point = layer_->lattice_from_wrapped(point);
        }
    }

    NumberedGrid grid_;
    const TileLayer* layer_;
    Grid<glm::dvec2> controls_;
    glm::ivec2 first_control_{0}; // number of its sample
};

/// Samples along the longest side of a layer's tiles.
int longest_side(const TileLayer& layer) {
    int longest = 0;
    for (const LayerTile& tile : layer.tiles) {
        longest = std::max({longest, tile.cols, tile.rows});
    }
    return longest;
}

/// Samples of the layer per step of the grid, at least 1: of the shorter step. Tiles smaller than a
/// step could lie between all samples. For them it is √2 times the longer step beside them: such a
/// cell holds a sample of the grid, however the grid is turned.
int reduction_for(const LayerPoints& points, const TileGrid& grid, const TileLayer& layer) {
    constexpr double max_change = 16.0; // of steps in the grid: those in degrees narrow to a pole
    const glm::dvec2 steps = points.steps_at({grid.cols / 2, grid.rows / 2});
    double step = std::min(steps.x, steps.y);
    const double side = longest_side(layer);
    if (!(side > max_change * std::max(steps.x, steps.y))) {
        const glm::dvec2 middle(0.5 * (layer.cols - 1), 0.5 * (layer.rows - 1));
        const glm::dvec2 beside = points.steps_at(points.nearest_to(middle));
        const double longer = std::max(beside.x, beside.y);
        step = side < longer ? std::sqrt(2.0) * longer : step;
    }
    return clamped_int(step + near_sample, 1, max_reduction);
}

/// First lattice point of the cell of a grid's first sample, modulo cells.
int anchor_of(double first, int reduction) {
    const double begin = first - 0.5 * (reduction - 1);
    const double anchor = std::round(begin - reduction * std::floor(begin / reduction));
    return clamped_int(anchor, 0, reduction); // beyond for points so far away that digits are lost
}

/// The layer's cells that a grid needs; may be empty. Cells lie within the layer, by one cell.
CellWindow window_with(int reduction, const LayerPoints& points, const PointBounds& bounds,
                       const TileLayer& layer) {
    CellWindow window;
    window.reduction = reduction;
    const glm::dvec2 begin = points.at(0, 0);
    window.anchor = {anchor_of(begin.x, reduction), anchor_of(begin.y, reduction)};
    const glm::dvec2 first = window.cell_from_lattice(glm::dvec2(0.0)) - 1.0;
    const glm::dvec2 last =
        window.cell_from_lattice(glm::dvec2(layer.cols - 1, layer.rows - 1)) + 1.0;
    const glm::dvec2 low =
        glm::max(glm::floor(window.cell_from_lattice(bounds.low)), glm::floor(first));
    const glm::dvec2 high =
        glm::min(glm::ceil(window.cell_from_lattice(bounds.high)), glm::ceil(last));
    if (low.x <= high.x && low.y <= high.y) {
        window.set_range(low, high);
    }
    return window;
}

/// As window_with; cells grow until they fit max_cells.
CellWindow window_for(const LayerPoints& points, const TileGrid& grid, const TileLayer& layer) {
    const PointBounds bounds = points.bounds();
    int reduction = reduction_for(points, grid, layer);
    CellWindow window = window_with(reduction, points, bounds, layer);
    while (static_cast<double>(window.cols) * window.rows > max_cells) {
        reduction *= 2;
        window = window_with(reduction, points, bounds, layer);
    }
    return window;
}

struct HeightBetween {
    double height = std::numeric_limits<double>::quiet_NaN();
    bool whole = false; ///< all its cells have a height
};

/// Bilinear between cells with a height; NaN if the nearest cell has none; exact on a cell.
HeightBetween height_between(const Grid<double>& cells, glm::dvec2 cell) {
    const glm::dvec2 nearest = glm::round(cell);
    if (glm::all(glm::lessThan(glm::abs(cell - nearest), glm::dvec2(near_sample)))) {
        cell = nearest;
    }
    const auto value = [&](glm::dvec2 at) {
        const bool inside =
            at.x >= 0.0 && at.y >= 0.0 && at.x < cells.cols() && at.y < cells.rows();
        return inside ? cells(static_cast<int>(at.x), static_cast<int>(at.y))
                      : std::numeric_limits<double>::quiet_NaN();
    };
    if (std::isnan(value(nearest)) || cell == nearest) {
        return {value(nearest), cell == nearest};
    }
    const glm::dvec2 low = glm::floor(cell);
    const glm::dvec2 part = cell - low;
    double sum = 0.0;
    double weights = 0.0;
    for (const glm::dvec2 corner :
         {glm::dvec2(0.0, 0.0), glm::dvec2(1.0, 0.0), glm::dvec2(0.0, 1.0), glm::dvec2(1.0, 1.0)}) {
        const glm::dvec2 share = glm::mix(1.0 - part, part, corner);
        const double height = value(low + corner);
        if (share.x * share.y > 0.0 && !std::isnan(height)) {
            sum += share.x * share.y * height;
            weights += share.x * share.y;
        }
    }
    constexpr double rounding = 1e-12; // of weights that sum to 1
    return {sum / weights, weights >= 1.0 - rounding};
}

bool has_gaps(const Grid<double>& heights) {
    return std::any_of(heights.samples().begin(), heights.samples().end(),
                       [](double height) { return std::isnan(height); });
}

/// Fills samples without a height from the cells that they lie on; `first`: of the first sample.
void fill_with(const Grid<double>& cells, glm::ivec2 first, Grid<double>& heights) {
    const glm::ivec2 low = glm::max(-first, glm::ivec2(0));
    const glm::ivec2 high = glm::min(glm::ivec2(heights.cols(), heights.rows()),
                                     glm::ivec2(cells.cols(), cells.rows()) - first);
    for (int row = low.y; row < high.y; ++row) {
        const auto into = heights.row(row);
        for (int col = low.x; col < high.x; ++col) {
            double& height = into[static_cast<std::size_t>(col)];
            height = std::isnan(height) ? cells(first.x + col, first.y + row) : height;
        }
    }
}

/// Fills samples without a height from the cells around them.
void fill_between(const Grid<double>& cells, const CellWindow& window, const LayerPoints& points,
                  TileWindow& result, Grid<double>& edges) {
    for (int row = 0; row < edges.rows(); ++row) {
        for (int col = 0; col < edges.cols(); ++col) {
            const glm::dvec2 cell =
                window.cell_from_lattice(points.at(col, row)) - glm::dvec2(window.first);
            if (!std::isnan(result.heights(col, row)) || std::isnan(cell.x)) {
                continue;
            }
            const HeightBetween found = height_between(cells, cell);
            double& target = found.whole ? result.heights(col, row) : edges(col, row);
            target = std::isnan(target) ? found.height : target;
        }
    }
}

/// `edges`: heights for samples near a tile's edge, where no layer has all surrounding cells.
void fill_from(const TileLayer& layer, const LayerPoints& points, const LayerReading& reading,
               const TileGrid& grid, TileWindow& result, Grid<double>& edges) {
    const CellWindow window = window_for(points, grid, layer);
    if (window.cols == 0) {
        return;
    }
    const Grid<double> cells = read_cells(layer, window, reading, result.errors);
    if (window.reduction == 1 && points.are_on_lattice()) {
        const glm::dvec2 first = window.cell_from_lattice(glm::round(points.at(0, 0)));
        fill_with(cells, glm::ivec2(first) - window.first, result.heights);
    } else {
        fill_between(cells, window, points, result, edges);
    }
}

void fill_from_edges(const Grid<double>& edges, Grid<double>& heights) {
    for (std::size_t i = 0; i < heights.size(); ++i) {
        double& height = heights.samples()[i];
        height = std::isnan(height) ? edges.samples()[i] : height;
    }
}

/// The tiles of a layer that may contain samples of a grid.
class NearTiles {
public:
    NearTiles(const TileLayer& layer, const LayerPoints& points) : points_(points) {
        const auto [low, high] = points.bounds();
        for (const LayerTile& tile : layer.tiles) {
            if (tile.col - 1 <= high.x && tile.row - 1 <= high.y && tile.col + tile.cols >= low.x &&
                tile.row + tile.rows >= low.y) {
                tiles_.push_back(&tile);
            }
        }
    }

    /// Whether a sample lies on a tile, including half a cell at its edge.
    [[nodiscard]] bool cover(int col, int row) const {
        const glm::dvec2 point = points_.at(col, row);
        return std::any_of(tiles_.begin(), tiles_.end(), [&](const LayerTile* tile) {
            const glm::dvec2 inside = point - glm::dvec2(tile->col, tile->row);
            return inside.x >= -0.5 && inside.y >= -0.5 && inside.x <= tile->cols - 0.5 &&
                   inside.y <= tile->rows - 0.5;
        });
    }

private:
    const LayerPoints& points_;
    std::vector<const LayerTile*> tiles_;
};

/// Sets 0 m outside all tiles; voids of tiles stay voids.
void fill_sea(std::span<const TileLayer> layers, std::span<const std::optional<LayerPoints>> points,
              Grid<double>& heights) {
    std::vector<NearTiles> near;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        if (points[i]) {
            near.emplace_back(layers[i], *points[i]);
        }
    }
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            const bool covered = !std::isnan(heights(col, row)) ||
                                 std::any_of(near.begin(), near.end(), [&](const NearTiles& tiles) {
                                     return tiles.cover(col, row);
                                 });
            heights(col, row) = covered ? heights(col, row) : 0.0;
        }
    }
}

/// False only if a layer cannot overlap a grid in degrees.
bool may_meet(const std::string& grid_crs, const TileGrid& grid, const TileLayer& layer) {
    if (grid_crs != wgs84_degrees) {
        return true;
    }
    const glm::dvec2 last = grid.first + grid.step * glm::dvec2(grid.cols - 1, grid.rows - 1);
    const auto& [west, south, east, north] = layer.box;
    // For sides that are curved between the box's nine points, and for cells beyond samples.
    const glm::dvec2 margin =
        0.1 * glm::dvec2(east - west, north - south) + glm::abs(grid.step) + glm::dvec2(1e-3);
    return grid.first.x <= east + margin.x && last.x >= west - margin.x &&
           last.y <= north + margin.y && grid.first.y >= south - margin.y;
}

} // namespace

TileWindow TileSet::read(const TileGrid& grid, Gaps gaps, std::stop_token stop) const {
    check(grid.cols >= 1 && grid.rows >= 1, "TileSet::read of an empty grid");
    const ReadScope scope(stop);
    Grid<double> edges(grid.cols, grid.rows, std::numeric_limits<double>::quiet_NaN());
    TileWindow result{edges, {}, 0};
    const GdalMessages ignored_messages; // projections are undefined at some places
    std::atomic<std::size_t> bytes_read{0};
    const LayerReading reading = state_->reading(bytes_read, stop);
    const NumberedGrid samples = numbered(grid, state_->grid);
    std::vector<std::optional<LayerPoints>> points;
    for (const TileLayer& layer : state_->layers) {
        points.push_back(may_meet(state_->crs, grid, layer)
                             ? LayerPoints::create(state_->crs, samples, layer)
                             : std::nullopt);
        if (points.back() && has_gaps(result.heights)) {
            fill_from(layer, *points.back(), reading, grid, result, edges);
        }
    }
    fill_from_edges(edges, result.heights);
    if (gaps == Gaps::sea && has_gaps(result.heights)) {
        fill_sea(state_->layers, points, result.heights);
    }
    keep_each_once(result.errors);
    result.bytes_read = bytes_read;
    return result;
}

} // namespace reljef::io
