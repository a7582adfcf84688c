#include "engine/io/tile_set.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/io/gdal_dataset.h"
#include "engine/io/georeferencing.h"
#include "engine/io/tile_placing.h"
#include "engine/io/tile_set_state.h"

namespace reljef::io {
namespace {

constexpr double near_sample = 1e-6; // of a sample: rounding of coordinates of a million metres

/// x and y of all samples, in the coordinate system of the layers.
struct CrsBox {
    glm::dvec2 low{std::numeric_limits<double>::infinity()};
    glm::dvec2 high{-std::numeric_limits<double>::infinity()};

    void add(glm::dvec2 point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
};

CrsBox box_of_layers(std::span<const TileLayer> layers) {
    CrsBox box;
    for (const TileLayer& layer : layers) {
        for (const int i : {0, layer.cols - 1}) {
            for (const int j : {0, layer.rows - 1}) {
                box.add(layer.crs_from_lattice.crs_from_pixel(glm::dvec2(i, j)));
            }
        }
    }
    return box;
}

int count_of(double low, double high, double step) {
    const double steps = std::floor((high - low) / step + near_sample);
    return static_cast<int>(std::min(steps, 2e9)) + 1;
}

/// On the samples of the finest layer where it is not turned, else with its step.
TileGrid grid_in_shared_crs(std::span<const TileLayer> layers) {
    const geo::PixelAffine& finest = layers.front().crs_from_lattice;
    const CrsBox box = box_of_layers(layers);
    TileGrid grid;
    const double step_x = std::hypot(finest.x_col, finest.y_col);
    const double step_y = std::hypot(finest.x_row, finest.y_row);
    grid.step = {step_x, -step_y};
    const glm::dvec2 steps(std::floor((finest.x0 - box.low.x) / step_x + near_sample),
                           std::floor((box.high.y - finest.y0) / step_y + near_sample));
    grid.first = {finest.x0 - steps.x * step_x, finest.y0 + steps.y * step_y};
    grid.cols = count_of(grid.first.x, box.high.x, step_x);
    grid.rows = count_of(box.low.y, grid.first.y, step_y);
    return grid;
}

/// Degrees, in steps of the finest spacing at the middle.
TileGrid grid_in_degrees(std::span<const TileLayer> layers, const DegreeBox& box) {
    const auto& [west, south, east, north] = box;
    const double middle = std::clamp(0.5 * (south + north), -89.0, 89.0);
    const glm::dvec2 metres = geo::metres_per_degree(middle);
    const double spacing = std::min(layers.front().spacing.x, layers.front().spacing.y);
    const glm::dvec2 step = spacing / metres;
    return {{west, north},
            {step.x, -step.y},
            count_of(west, east, step.x),
            count_of(south, north, step.y)};
}

DegreeBox box_around(std::span<const TileLayer> layers) {
    DegreeBox box = layers.front().box;
    for (const TileLayer& layer : layers) {
        box = {std::min(box[0], layer.box[0]), std::min(box[1], layer.box[1]),
               std::max(box[2], layer.box[2]), std::max(box[3], layer.box[3])};
    }
    return box;
}

std::vector<TileFile> files_of(std::span<const TileLayer> layers,
                               std::span<const PlacedFile> placed,
                               std::span<const IndexedFile> indexed,
                               const std::filesystem::path& folder) {
    std::map<int, const PlacedFile*> place_of_file;
    for (const PlacedFile& file : placed) {
        place_of_file.emplace(file.file, &file);
    }
    std::vector<TileFile> files;
    for (const TileLayer& layer : layers) {
        const std::string crs_name = words_of(crs_from_text(layer.crs)).name;
        for (const LayerTile& tile : layer.tiles) {
            const PlacedFile& place = *place_of_file.at(tile.file);
            const IndexedFile& file = indexed[static_cast<std::size_t>(tile.file)];
            const auto& [west, south, east, north] = place.box;
            files.push_back({folder / file.path, file.cols, file.rows, file.format, file.type,
                             crs_name, place.spacing, south, west, north, east,
                             file.declares_voids});
        }
    }
    return files;
}

std::string shared_vertical_datum(std::span<const TileLayer> layers,
                                  std::span<const IndexedFile> indexed,
                                  std::vector<std::string>& notes) {
    std::set<std::string> datums;
    for (const TileLayer& layer : layers) {
        for (const LayerTile& tile : layer.tiles) {
            datums.insert(indexed[static_cast<std::size_t>(tile.file)].vertical_datum);
        }
    }
    if (datums.size() == 1) {
        return *datums.begin();
    }
    datums.erase("");
    notes.push_back(fmt::format("the tiles' heights count from different zeros ({}{}): they are "
                                "taken as they are",
                                fmt::join(datums, ", "), datums.size() == 1 ? ", unknown" : ""));
    return "";
}

void note_pictures(const TileIndex& index, std::vector<std::string>& notes) {
    const auto pictures =
        std::count_if(index.files.begin(), index.files.end(),
                      [](const IndexedFile& file) { return file.use == TileUse::picture; });
    if (pictures > 0) {
        notes.push_back(fmt::format("{} {} in colour: not taken for heights (--imagery drapes one)",
                                    pictures, pictures == 1 ? "picture" : "pictures"));
    }
}

Error nothing_usable(const std::string& name, std::span<const TileFault> faults) {
    return {faults.empty()
                ? fmt::format("{}: holds no raster of heights, at least one was expected", name)
                : fmt::format("{}: none of its {} rasters can be used, at least one was expected; "
                              "the first: {}",
                              name, faults.size(), faults.front().message)};
}

/// From the layers' point of view: where the samples of a grid lie.
class LayerPoints {
public:
    /// Absent where PROJ knows no way between the two coordinate systems.
    static std::optional<LayerPoints> create(const std::string& grid_crs, const TileGrid& grid,
                                             const TileLayer& layer) {
        LayerPoints points(grid, layer);
        if (layer.crs == grid_crs) {
            return points;
        }
        const auto transform = CrsTransform::create(grid_crs, layer.crs, layer.box);
        if (!transform) {
            return std::nullopt;
        }
        points.controls_ = Grid<glm::dvec2>((grid.cols + control_step - 1) / control_step + 1,
                                            (grid.rows + control_step - 1) / control_step + 1);
        points.fill_controls(*transform);
        return points;
    }

    /// In the layer's lattice; NaN where there is no such place.
    [[nodiscard]] glm::dvec2 at(int col, int row) const {
        if (controls_.empty()) {
            return layer_->lattice_from_crs(grid_.first + grid_.step * glm::dvec2(col, row));
        }
        const int i = col / control_step;
        const int j = row / control_step;
        const double u = static_cast<double>(col % control_step) / control_step;
        const double v = static_cast<double>(row % control_step) / control_step;
        const int i1 = std::min(i + 1, controls_.cols() - 1);
        const int j1 = std::min(j + 1, controls_.rows() - 1);
        return glm::mix(glm::mix(controls_(i, j), controls_(i1, j), u),
                        glm::mix(controls_(i, j1), controls_(i1, j1), u), v);
    }

private:
    // Over s samples of spacing d a straight line leaves a projection's curve by (s·d)²/8R with the
    // Earth's radius R: for 8 samples a millionth of a sample for each metre of spacing.
    static constexpr int control_step = 8;

    LayerPoints(const TileGrid& grid, const TileLayer& layer) : grid_(grid), layer_(&layer) {}

    void fill_controls(const CrsTransform& transform) {
        for (int j = 0; j < controls_.rows(); ++j) {
            for (int i = 0; i < controls_.cols(); ++i) {
                controls_(i, j) =
                    grid_.first + grid_.step * glm::dvec2(i, j) * static_cast<double>(control_step);
            }
        }
        transform.apply(controls_.samples());
        for (glm::dvec2& point : controls_.samples()) {
            point = layer_->lattice_from_turned(point);
        }
    }

    TileGrid grid_;
    const TileLayer* layer_;
    Grid<glm::dvec2> controls_;
};

/// Samples of the layer in a step of the grid, at least 1.
int reduction_for(const LayerPoints& points, const TileGrid& grid) {
    const int col = grid.cols / 2;
    const int row = grid.rows / 2;
    const glm::dvec2 at = points.at(col, row);
    const double across = glm::distance(points.at(col + (col + 1 < grid.cols ? 1 : -1), row), at);
    const double down = glm::distance(points.at(col, row + (row + 1 < grid.rows ? 1 : -1)), at);
    const double least = std::min(across, down);
    return least >= 2.0 - near_sample ? static_cast<int>(std::min(least + near_sample, 1e6)) : 1;
}

/// The cells that the samples of a grid need, within the layer; empty where there are none.
CellWindow window_for(const LayerPoints& points, const TileGrid& grid, const TileLayer& layer) {
    CellWindow window;
    window.reduction = reduction_for(points, grid);
    const glm::dvec2 begin = points.at(0, 0) - 0.5 * (window.reduction - 1);
    const glm::dvec2 anchor = begin - static_cast<double>(window.reduction) *
                                          glm::floor(begin / static_cast<double>(window.reduction));
    window.anchor = glm::all(glm::lessThan(glm::abs(anchor), glm::dvec2(1e9)))
                        ? glm::ivec2(glm::round(anchor))
                        : glm::ivec2(0);
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high = -low;
    for (int row = 0; row < grid.rows; ++row) {
        for (int col = 0; col < grid.cols; ++col) {
            const glm::dvec2 cell = window.cell_from_lattice(points.at(col, row));
            if (!std::isnan(cell.x)) {
                low = glm::min(low, cell);
                high = glm::max(high, cell);
            }
        }
    }
    const glm::dvec2 first = window.cell_from_lattice(glm::dvec2(0.0)) - 1.0;
    const glm::dvec2 last =
        window.cell_from_lattice(glm::dvec2(layer.cols - 1, layer.rows - 1)) + 1.0;
    low = glm::max(glm::floor(low), glm::floor(first));
    high = glm::min(glm::ceil(high), glm::ceil(last));
    if (low.x <= high.x && low.y <= high.y) {
        window.first = glm::ivec2(low);
        window.cols = static_cast<int>(high.x - low.x) + 1;
        window.rows = static_cast<int>(high.y - low.y) + 1;
    }
    return window;
}

/// A height, and whether all the cells that it rests on have one.
struct HeightBetween {
    double height = std::numeric_limits<double>::quiet_NaN();
    bool whole = false;
};

/// Bilinear between the cells that have a height, where the nearest one has; exact on a cell.
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

/// `edges` are heights for where no layer has all the cells around: half a cell from a tile's edge.
void fill_from(const TileLayer& layer, const LayerPoints& points, const TileReading& reading,
               const TileGrid& grid, TileWindow& result, Grid<double>& edges) {
    const CellWindow window = window_for(points, grid, layer);
    if (window.cols == 0) {
        return;
    }
    const Grid<double> cells = read_cells(layer, window, reading, result.faults);
    for (int row = 0; row < grid.rows; ++row) {
        for (int col = 0; col < grid.cols; ++col) {
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

void fill_from_edges(const Grid<double>& edges, Grid<double>& heights) {
    for (std::size_t i = 0; i < heights.size(); ++i) {
        double& height = heights.samples()[i];
        height = std::isnan(height) ? edges.samples()[i] : height;
    }
}

bool on_a_tile(const TileLayer& layer, glm::dvec2 point) {
    return std::any_of(layer.tiles.begin(), layer.tiles.end(), [&](const LayerTile& tile) {
        const glm::dvec2 inside = point - glm::dvec2(tile.col, tile.row);
        return inside.x >= -0.5 && inside.y >= -0.5 && inside.x <= tile.cols - 0.5 &&
               inside.y <= tile.rows - 0.5;
    });
}

/// 0 m where no tile lies; voids of tiles stay voids.
void fill_sea(std::span<const TileLayer> layers, std::span<const std::optional<LayerPoints>> points,
              Grid<double>& heights) {
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            if (!std::isnan(heights(col, row))) {
                continue;
            }
            bool covered = false;
            for (std::size_t i = 0; i < layers.size() && !covered; ++i) {
                covered = points[i] && on_a_tile(layers[i], points[i]->at(col, row));
            }
            heights(col, row) = covered ? heights(col, row) : 0.0;
        }
    }
}

/// The outline of an area, longitude and latitude.
std::vector<glm::dvec2> outline_of(const GeodeticArea& area) {
    constexpr int steps = 32;
    std::vector<glm::dvec2> points;
    for (int i = 0; i <= steps; ++i) {
        const double t = static_cast<double>(i) / steps;
        const double x = glm::mix(area.west, area.east, t);
        const double y = glm::mix(area.south, area.north, t);
        points.insert(points.end(),
                      {{x, area.south}, {x, area.north}, {area.west, y}, {area.east, y}});
    }
    return points;
}

} // namespace

void keep_each_once(std::vector<TileFault>& faults) {
    const auto by_file = [](const TileFault& a, const TileFault& b) { return a.file < b.file; };
    std::stable_sort(faults.begin(), faults.end(), by_file);
    const auto same = [](const TileFault& a, const TileFault& b) { return a.file == b.file; };
    faults.erase(std::unique(faults.begin(), faults.end(), same), faults.end());
}

TileReading TileSet::State::reading(const std::stop_token& stop) const {
    TileReading reading{indexed, folder, {}};
    reading.options.height_scale = options.height_scale;
    reading.options.height_offset = options.height_offset;
    reading.options.stop = stop;
    return reading;
}

Result<TileSet> TileSet::open(const std::filesystem::path& path, const TileSetOptions& options) {
    auto state = std::make_shared<State>();
    state->name = path.string();
    state->options = options;
    auto index = index_tiles(path, options, state->notes);
    if (!index) {
        return index.error();
    }
    std::error_code ignored;
    state->folder = std::filesystem::is_directory(path, ignored) ? path : std::filesystem::path();
    const GdalMessages unheard; // what is wrong is told as a fault
    const std::vector<PlacedFile> placed = place_files(*index, state->folder, state->faults);
    if (placed.empty()) {
        return nothing_usable(state->name, state->faults);
    }
    note_pictures(*index, state->notes);
    state->indexed = std::move(index->files);
    state->layers = layers_of(placed, state->indexed);
    state->files = files_of(state->layers, placed, state->indexed, state->folder);
    state->vertical_datum = shared_vertical_datum(state->layers, state->indexed, state->notes);
    state->box = box_around(state->layers);
    const bool shared =
        std::all_of(state->layers.begin(), state->layers.end(),
                    [&](const TileLayer& layer) { return layer.crs == state->layers.front().crs; });
    state->crs = shared ? state->layers.front().crs : wgs84_degrees;
    state->crs_name = words_of(crs_from_text(state->crs)).name;
    state->grid =
        shared ? grid_in_shared_crs(state->layers) : grid_in_degrees(state->layers, state->box);
    return TileSet(std::move(state));
}

const std::string& TileSet::name() const {
    return state_->name;
}
std::span<const TileFile> TileSet::files() const {
    return state_->files;
}
std::span<const TileFault> TileSet::faults() const {
    return state_->faults;
}
std::span<const std::string> TileSet::notes() const {
    return state_->notes;
}
const std::string& TileSet::crs_name() const {
    return state_->crs_name;
}
TileGrid TileSet::grid() const {
    return state_->grid;
}

Result<TileGrid> TileSet::part(const TileGrid& grid, const GeodeticArea& area) const {
    const auto nothing = [&] {
        return Error{fmt::format("{}: has nothing from {} to {} north, {} to {} east, an area that "
                                 "overlaps its tiles was expected",
                                 state_->name, area.south, area.north, area.west, area.east)};
    };
    const GdalMessages unheard;
    std::vector<glm::dvec2> points = outline_of(area);
    const double middle = 0.5 * (state_->box[0] + state_->box[2]);
    const double turns = std::round((middle - 0.5 * (area.west + area.east)) / 360.0);
    for (glm::dvec2& point : points) {
        point.x += 360.0 * turns;
    }
    if (state_->crs != wgs84_degrees) {
        const auto transform = CrsTransform::create(wgs84_degrees, state_->crs, state_->box);
        if (!transform) {
            return nothing();
        }
        transform->apply(points);
        const TileLayer& layer = state_->layers.front();
        for (glm::dvec2& point : points) {
            point = layer.crs_from_lattice.crs_from_pixel(layer.lattice_from_turned(point));
        }
    }
    CrsBox box;
    for (const glm::dvec2 point : points) {
        box.add((point - grid.first) / grid.step);
    }
    const glm::dvec2 last(grid.cols - 1, grid.rows - 1);
    const glm::dvec2 low = glm::clamp(glm::floor(box.low + near_sample), glm::dvec2(0.0), last);
    const glm::dvec2 high = glm::clamp(glm::ceil(box.high - near_sample), glm::dvec2(0.0), last);
    if (!(high.x - low.x >= 1.0 && high.y - low.y >= 1.0)) {
        return nothing();
    }
    return TileGrid{grid.first + grid.step * low, grid.step, static_cast<int>(high.x - low.x) + 1,
                    static_cast<int>(high.y - low.y) + 1};
}

TileGrid TileSet::reduced(const TileGrid& grid, int reduction) {
    check(reduction >= 1, "TileSet::reduced needs a reduction of at least 1");
    const double k = reduction;
    return {grid.first + 0.5 * (k - 1.0) * grid.step, k * grid.step,
            std::max(1, grid.cols / reduction), std::max(1, grid.rows / reduction)};
}

TileWindow TileSet::read(const TileGrid& grid, Gaps gaps, std::stop_token stop) const {
    check(grid.cols >= 1 && grid.rows >= 1, "TileSet::read of an empty grid");
    Grid<double> edges(grid.cols, grid.rows, std::numeric_limits<double>::quiet_NaN());
    TileWindow result{edges, {}};
    const GdalMessages unheard; // of places that a projection does not have
    const TileReading reading = state_->reading(stop);
    std::vector<std::optional<LayerPoints>> points;
    for (const TileLayer& layer : state_->layers) {
        points.push_back(LayerPoints::create(state_->crs, grid, layer));
        if (points.back() && has_gaps(result.heights)) {
            fill_from(layer, *points.back(), reading, grid, result, edges);
        }
    }
    fill_from_edges(edges, result.heights);
    if (gaps == Gaps::sea && has_gaps(result.heights)) {
        fill_sea(state_->layers, points, result.heights);
    }
    keep_each_once(result.faults);
    return result;
}

} // namespace reljef::io
