#include "engine/io/tile_layer.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <glm/matrix.hpp>

#include "engine/io/files/tile_grid.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/sample_decoder.h"
#include "engine/io/raster/sample_reader.h"
#include "engine/terrain/tree/tile_tree.h"

namespace reljef::io {
namespace {

constexpr double same_phase = 1e-2; // samples; for tile corners written with few digits
// Samples over a whole tile: error of pixel sizes written with 12 digits.
constexpr double same_step = 1e-5;
constexpr int min_taps = 4;            // values per cell and side
constexpr double closing_share = 0.75; // of a cell: then older tiles do not add to it

glm::dmat2 steps_matrix(const geo::PixelAffine& affine) {
    return {affine.x_col, affine.y_col, affine.x_row, affine.y_row};
}

/// A layer under construction; its lattice starts at the first tile.
struct GrowingLayer {
    TileLayer layer;
    PointBounds bounds; ///< lattice points, whole numbers that may exceed int
};

/// A file's first sample on a layer's lattice.
glm::dvec2 origin_in(const TileLayer& layer, const PlacedFile& file) {
    return layer.lattice_from_crs(file.crs_from_sample.crs_from_pixel(glm::dvec2(0.0)));
}

bool on_lattice(const TileLayer& layer, const PlacedFile& file, const IndexedFile& indexed) {
    if (layer.crs != file.crs) {
        return false;
    }
    const glm::dmat2 in_steps = layer.lattice_steps * steps_matrix(file.crs_from_sample);
    const double side = std::max(indexed.cols, indexed.rows);
    const glm::dmat2 drift = (in_steps - glm::dmat2(1.0)) * side;
    const glm::dvec2 origin = origin_in(layer, file);
    const glm::dvec2 phase = origin - glm::round(origin);
    const double max_drift = std::max(
        {std::abs(drift[0].x), std::abs(drift[0].y), std::abs(drift[1].x), std::abs(drift[1].y)});
    return max_drift <= same_step && std::abs(phase.x) <= same_phase &&
           std::abs(phase.y) <= same_phase;
}

PointBounds bounds_with(const GrowingLayer& growing, const PlacedFile& file,
                        const IndexedFile& indexed) {
    const glm::dvec2 first = glm::round(origin_in(growing.layer, file));
    PointBounds bounds = growing.bounds;
    bounds.add(first);
    bounds.add(first + glm::dvec2(indexed.cols, indexed.rows)); // exclusive
    return bounds;
}

/// Tiles farther apart than max_tree_samples belong to different layers.
bool belongs_to(const GrowingLayer& growing, const PlacedFile& file, const IndexedFile& indexed) {
    if (!on_lattice(growing.layer, file, indexed)) {
        return false;
    }
    const PointBounds bounds = bounds_with(growing, file, indexed);
    const glm::dvec2 size = bounds.high - bounds.low;
    return std::max(size.x, size.y) <= terrain::max_tree_samples;
}

void add_to(GrowingLayer& growing, const PlacedFile& file, const IndexedFile& indexed) {
    TileLayer& layer = growing.layer;
    const glm::dvec2 origin = origin_in(layer, file);
    const glm::ivec2 first(glm::round(origin));
    growing.bounds = bounds_with(growing, file, indexed);
    layer.tiles.push_back(
        {file.file, first.x, first.y, indexed.cols, indexed.rows, origin - glm::dvec2(first)});
    layer.modified = std::max(layer.modified, indexed.modified);
    layer.box = united(layer.box, file.box);
}

GrowingLayer layer_from(const PlacedFile& file, const IndexedFile& indexed) {
    GrowingLayer growing;
    TileLayer& layer = growing.layer;
    layer.crs = file.crs;
    layer.crs_from_lattice = file.crs_from_sample;
    layer.lattice_steps = glm::inverse(steps_matrix(file.crs_from_sample));
    layer.spacing = file.spacing;
    layer.box = file.box;
    layer.period = file.period;
    add_to(growing, file, indexed);
    return growing;
}

/// The number of columns if the layer spans 360 degrees; else 0. Two turns fit an int.
int global_cols(const TileLayer& layer) {
    const double step = std::abs(layer.crs_from_lattice.x_col);
    const double miss = std::abs(layer.period / step - layer.cols);
    return layer.period > 0.0 && layer.crs_from_lattice.x_row == 0.0 && miss <= same_phase &&
                   layer.cols < terrain::max_tree_samples / 2
               ? layer.cols
               : 0;
}

/// Repeats tiles of a global layer on both sides.
void add_wrapped_tiles(TileLayer& layer) {
    const int turn = global_cols(layer);
    const std::size_t count = turn > 0 ? layer.tiles.size() : 0;
    for (std::size_t i = 0; i < count; ++i) {
        LayerTile tile = layer.tiles[i];
        tile.is_wrapped = true;
        const int first = tile.col;
        for (const bool eastward : {true, false}) {
            const bool near = eastward ? 2 * first < turn : 2 * (first + tile.cols) > turn;
            tile.col = first + (eastward ? turn : -turn);
            if (near) {
                layer.tiles.push_back(tile);
            }
        }
    }
}

/// Moves the lattice's origin to the first sample and sorts the tiles.
TileLayer finished(GrowingLayer growing, std::span<const IndexedFile> files) {
    TileLayer& layer = growing.layer;
    const glm::ivec2 low(growing.bounds.low);
    const glm::ivec2 size(growing.bounds.high - growing.bounds.low);
    const glm::dvec2 origin = layer.crs_from_lattice.crs_from_pixel(growing.bounds.low);
    layer.crs_from_lattice.x0 = origin.x;
    layer.crs_from_lattice.y0 = origin.y;
    layer.cols = size.x;
    layer.rows = size.y;
    for (LayerTile& tile : layer.tiles) {
        tile.col -= low.x;
        tile.row -= low.y;
    }
    add_wrapped_tiles(layer);
    std::stable_sort(layer.tiles.begin(), layer.tiles.end(),
                     [&](const LayerTile& a, const LayerTile& b) {
                         return files[static_cast<std::size_t>(a.file)].modified >
                                files[static_cast<std::size_t>(b.file)].modified;
                     });
    return std::move(growing.layer);
}

/// A half-open rectangle of lattice points.
struct Rectangle {
    glm::ivec2 low{0};
    glm::ivec2 high{0};
    [[nodiscard]] bool empty() const { return low.x >= high.x || low.y >= high.y; }
};

Rectangle overlap(const LayerTile& tile, const CellWindow& window) {
    const glm::ivec2 low = window.anchor + window.first * window.reduction;
    const glm::ivec2 high = low + glm::ivec2(window.cols, window.rows) * window.reduction;
    const glm::ivec2 corner(tile.col, tile.row);
    return {glm::max(low, corner), glm::min(high, corner + glm::ivec2(tile.cols, tile.rows))};
}

/// Sums and sample counts of cells.
class CellSums {
public:
    explicit CellSums(const CellWindow& window)
        : window_(window), sum_(window.cols, window.rows), weight_(window.cols, window.rows),
          closed_(window.cols, window.rows) {}

    /// `values` are at plan.grid in the tile's pixels.
    void add(const LayerTile& tile, const ReadPlan& plan, const Grid<double>& values) {
        const double weight = plan.grid.step.x * plan.grid.step.y;
        const glm::dvec2 corner(tile.col, tile.row);
        if (window_.reduction == 1 && plan.grid.step == glm::dvec2(1.0)) {
            add_samples(cell_of(corner + plan.grid.origin - 0.5), values);
            return;
        }
        for (int row = 0; row < values.rows(); ++row) {
            for (int col = 0; col < values.cols(); ++col) {
                const double value = values(col, row);
                const glm::dvec2 pixel = plan.grid.pixel_from_sample(glm::dvec2(col, row));
                const glm::ivec2 cell = cell_of(corner + pixel - 0.5);
                if (!std::isnan(value) && inside(cell) && closed_(cell.x, cell.y) == 0) {
                    sum_(cell.x, cell.y) += weight * value;
                    weight_(cell.x, cell.y) += weight;
                }
            }
        }
    }
    /// One sample a cell; `first`: the cell of the first one.
    void add_samples(glm::ivec2 first, const Grid<double>& values) {
        const glm::ivec2 low = glm::max(-first, glm::ivec2(0));
        const glm::ivec2 high = glm::min(glm::ivec2(values.cols(), values.rows()),
                                         glm::ivec2(window_.cols, window_.rows) - first);
        for (int row = low.y; row < high.y && low.x < high.x; ++row) {
            const glm::ivec2 cell = first + glm::ivec2(low.x, row);
            const double* const from = values.row(row).data() + low.x;
            const std::uint8_t* const closed = closed_.row(cell.y).data() + cell.x;
            double* __restrict const sums = sum_.row(cell.y).data() + cell.x;
            double* __restrict const weights = weight_.row(cell.y).data() + cell.x;
            for (int i = 0; i < high.x - low.x; ++i) { // no branches: vector code
                const bool counts = !std::isnan(from[i]) && closed[i] == 0;
                sums[i] += counts ? from[i] : 0.0;
                weights[i] += counts ? 1.0 : 0.0;
            }
        }
    }
    /// Closes well-covered cells to further tiles.
    void close_covered() {
        const double full = static_cast<double>(window_.reduction) * window_.reduction;
        for (std::size_t i = 0; i < weight_.size(); ++i) {
            closed_.samples()[i] = weight_.samples()[i] >= closing_share * full ? 1 : 0;
        }
    }
    [[nodiscard]] Grid<double> averages() && {
        for (std::size_t i = 0; i < sum_.size(); ++i) {
            const double weight = weight_.samples()[i];
            sum_.samples()[i] = weight > 0.0 ? sum_.samples()[i] / weight : void_value;
        }
        return std::move(sum_);
    }

private:
    [[nodiscard]] glm::ivec2 cell_of(glm::dvec2 point) const {
        const glm::dvec2 from_first = point + 0.5 - glm::dvec2(window_.anchor) -
                                      glm::dvec2(window_.first * window_.reduction);
        return glm::ivec2(glm::floor(from_first / static_cast<double>(window_.reduction)));
    }
    [[nodiscard]] bool inside(glm::ivec2 cell) const {
        return cell.x >= 0 && cell.y >= 0 && cell.x < window_.cols && cell.y < window_.rows;
    }

    CellWindow window_;
    Grid<double> sum_;
    Grid<double> weight_;
    Grid<std::uint8_t> closed_;
};

std::filesystem::path path_of(const LayerTile& tile, const LayerReading& reading) {
    return reading.folder / reading.files[static_cast<std::size_t>(tile.file)].path;
}

constexpr std::chrono::seconds max_response_time{5}; // longer: the server hangs

/// Opens a tile as in the index. Skips remote files that fail repeatedly.
Result<DatasetPool::Loan> borrow(const LayerTile& tile, const LayerReading& reading,
                                 const GdalMessages& messages) {
    const std::filesystem::path path = path_of(tile, reading);
    if (auto wrong = reading.failing->skip_reason(path)) {
        return Error{std::move(*wrong)};
    }
    const IndexedFile& file = reading.files[static_cast<std::size_t>(tile.file)];
    bool is_noted = false;
    const auto match_index = [&](Dataset opened) -> Result<Dataset> {
        const std::string& crs = reading.crs[static_cast<std::size_t>(file.crs)];
        auto now = as_indexed(std::move(opened), file, crs, path.string());
        if (now && now->note) {
            reading.new_notes->add(*now->note);
            is_noted = true;
        }
        return now ? Result<Dataset>(std::move(now->dataset)) : now.error();
    };
    auto dataset = reading.pool->borrow(path, messages, match_index);
    if (!dataset && is_remote(path)) {
        reading.failing->note(path, dataset.error().message);
    }
    if (dataset && dataset->found_change() && !is_noted) {
        reading.new_notes->add(path, changed_note);
    }
    return dataset;
}

struct TileValues {
    ReadPlan plan;
    Grid<double> values;
};

/// Reads a part of a tile, in lattice points.
Result<TileValues> read_part(const LayerTile& tile, const Rectangle& part, int reduction,
                             const LayerReading& reading) {
    const std::filesystem::path path = path_of(tile, reading);
    GdalMessages messages;
    auto dataset = borrow(tile, reading, messages);
    if (!dataset) {
        return dataset.error();
    }
    const RasterOptions::Window window{part.low.x - tile.col, part.low.y - tile.row,
                                       part.high.x - part.low.x, part.high.y - part.low.y};
    TileValues result;
    result.plan = plan_window(**dataset, window, std::max(1, reduction / min_taps));
    RasterOptions options = reading.options;
    options.undeclared_voids = reading.rasters->undeclared_voids(path);
    std::vector<std::string> found;
    auto values = read_heights(**dataset, result.plan, path.string(), options, messages, found);
    if (!values) {
        if (!reading.options.stop.stop_requested() && !is_web_tiles(path)) {
            dataset->discard();
            if (is_remote(path)) {
                reading.failing->note(path, values.error().message);
            }
        }
        return values.error();
    }
    reading.failing->forget(path);
    for (const std::string& note : found) {
        reading.new_notes->add(path, note);
    }
    result.values = std::move(*values);
    // Counts all samples, because blocks are read as a whole.
    const auto reduction_of_plan = static_cast<std::size_t>(result.plan.reduction);
    *reading.bytes_read += result.values.size() * reduction_of_plan * reduction_of_plan *
                           static_cast<std::size_t>(GDALGetDataTypeSizeBytes(
                               (*dataset)->GetRasterBand(1)->GetRasterDataType()));
    return result;
}

/// Finest samples along a web tile of the level to read.
int web_tile_side(int reduction) {
    return web_tiles_side << std::max(0, std::ilogb(std::max(1, reduction / min_taps)));
}

/// Reads web tiles one by one to skip damaged ones only.
void add_web_tiles(const LayerTile& tile, const Rectangle& part, int reduction,
                   const LayerReading& reading, CellSums& sums, std::vector<FileError>& errors) {
    const int side = web_tile_side(reduction);
    const glm::ivec2 corner(tile.col, tile.row);
    const glm::ivec2 first = (part.low - corner) / side;
    const glm::ivec2 last = (part.high - 1 - corner) / side;
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            const glm::ivec2 low = corner + glm::ivec2(x, y) * side;
            const Rectangle one{glm::max(part.low, low), glm::min(part.high, low + side)};
            const auto read = read_part(tile, one, reduction, reading);
            if (read) {
                sums.add(tile, read->plan, read->values);
            } else if (!reading.options.stop.stop_requested()) {
                const int level = std::ilogb(tile.cols / side);
                errors.push_back(web_tiles_error(path_of(tile, reading), {x, y}, level));
            }
        }
    }
}

/// Adds a part of a tile to the sums, or adds its errors.
void add_part(const LayerTile& tile, const Rectangle& part, int reduction,
              const LayerReading& reading, CellSums& sums, std::vector<FileError>& errors) {
    const auto begin = BackOff::Clock::now();
    const auto read = read_part(tile, part, reduction, reading);
    const std::filesystem::path path = path_of(tile, reading);
    if (read) {
        sums.add(tile, read->plan, read->values);
        return;
    }
    if (!is_web_tiles(path) || reading.options.stop.stop_requested()) {
        errors.push_back({path, read.error().message});
        return;
    }
    // Does not request single tiles from a server that hangs.
    if (BackOff::Clock::now() - begin > max_response_time) {
        reading.failing->note(path, read.error().message);
    }
    if (reading.failing->has_failed(path)) {
        errors.push_back({path, read.error().message});
    } else {
        add_web_tiles(tile, part, reduction, reading, sums, errors);
    }
}

} // namespace

glm::dvec2 TileLayer::lattice_from_wrapped(glm::dvec2 point) const {
    if (period > 0.0) {
        const double middle =
            crs_from_lattice.crs_from_pixel(0.5 * glm::dvec2(cols - 1, rows - 1)).x;
        point.x -= period * std::round((point.x - middle) / period);
    }
    return lattice_from_crs(point);
}

std::vector<TileLayer> layers_of(std::span<const PlacedFile> placed,
                                 std::span<const IndexedFile> files) {
    std::vector<GrowingLayer> growing;
    for (const PlacedFile& file : placed) {
        const IndexedFile& indexed = files[static_cast<std::size_t>(file.file)];
        const auto found =
            std::find_if(growing.begin(), growing.end(), [&](const GrowingLayer& layer) {
                return belongs_to(layer, file, indexed);
            });
        if (found == growing.end()) {
            growing.push_back(layer_from(file, indexed));
        } else {
            add_to(*found, file, indexed);
        }
    }
    std::vector<TileLayer> layers;
    layers.reserve(growing.size());
    for (GrowingLayer& layer : growing) {
        layers.push_back(finished(std::move(layer), files));
    }
    std::stable_sort(layers.begin(), layers.end(), [](const TileLayer& a, const TileLayer& b) {
        const double fine_a = resolution(a.spacing);
        const double fine_b = resolution(b.spacing);
        return fine_a != fine_b ? fine_a < fine_b : a.modified > b.modified;
    });
    return layers;
}

Grid<double> read_cells(const TileLayer& layer, const CellWindow& window,
                        const LayerReading& reading, std::vector<FileError>& errors) {
    CellSums sums(window);
    for (const LayerTile& tile : layer.tiles) {
        const Rectangle part = overlap(tile, window);
        if (part.empty() || reading.options.stop.stop_requested()) {
            continue;
        }
        add_part(tile, part, window.reduction, reading, sums, errors);
        sums.close_covered();
    }
    return std::move(sums).averages();
}

} // namespace reljef::io
