#include "engine/io/tile_set.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/common.hpp>

#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/georeferencing.h"
#include "engine/io/raster/globe.h"
#include "engine/io/tile_set_state.h"
#include "engine/terrain/tree/tile_tree.h"

namespace reljef::io {
namespace {

PointBounds bounds_of_layers(std::span<const TileLayer> layers) {
    PointBounds box;
    for (const TileLayer& layer : layers) {
        for (const int i : {0, layer.cols - 1}) {
            for (const int j : {0, layer.rows - 1}) {
                box.add(layer.crs_from_lattice.crs_from_pixel(glm::dvec2(i, j)));
            }
        }
    }
    return box;
}

/// At most terrain::max_tree_samples; see grid_step.
int samples_between(double low, double high, double step) {
    return clamped_int((high - low) / step + near_sample, 0, terrain::max_tree_samples - 1) + 1;
}

/// The finest step, or the smallest multiple with at most max_tree_samples along `extent`.
glm::dvec2 grid_step(glm::dvec2 extent, glm::dvec2 finest, std::vector<std::string>& notes) {
    constexpr double max_samples = terrain::max_tree_samples - 2; // margin for rounding
    const glm::dvec2 samples = extent / finest;
    const double steps = std::ceil(std::max(samples.x, samples.y) / max_samples);
    if (steps > 1.0) {
        notes.push_back(fmt::format("{:.0f}×{:.0f} samples of the finest tile lie along the whole: "
                                    "it is seen in steps of {:.0f}",
                                    samples.x, samples.y, steps));
    }
    return finest * std::max(1.0, steps);
}

/// Aligned to the samples of the finest layer unless it is rotated.
TileGrid grid_in_shared_crs(std::span<const TileLayer> layers, std::vector<std::string>& notes) {
    const geo::PixelAffine& finest = layers.front().crs_from_lattice;
    const PointBounds box = bounds_of_layers(layers);
    TileGrid grid;
    const glm::dvec2 step = grid_step(
        box.high - box.low,
        {std::hypot(finest.x_col, finest.y_col), std::hypot(finest.x_row, finest.y_row)}, notes);
    grid.step = {step.x, -step.y};
    const glm::dvec2 steps(std::floor((finest.x0 - box.low.x) / step.x + near_sample),
                           std::floor((box.high.y - finest.y0) / step.y + near_sample));
    grid.first = {finest.x0 - steps.x * step.x, finest.y0 + steps.y * step.y};
    grid.cols = samples_between(grid.first.x, box.high.x, step.x);
    grid.rows = samples_between(box.low.y, grid.first.y, step.y);
    return grid;
}

/// In degrees; the finest spacing at the middle.
TileGrid grid_in_degrees(std::span<const TileLayer> layers, const DegreeBox& box,
                         std::vector<std::string>& notes) {
    const auto& [west, south, east, north] = box;
    const double middle = std::clamp(0.5 * (south + north), -89.0, 89.0);
    const glm::dvec2 metres = geo::metres_per_degree(middle);
    const double spacing = std::min(layers.front().spacing.x, layers.front().spacing.y);
    const glm::dvec2 step = grid_step({east - west, north - south}, spacing / metres, notes);
    return {{west, north},
            {step.x, -step.y},
            samples_between(west, east, step.x),
            samples_between(south, north, step.y)};
}

DegreeBox box_around(std::span<const TileLayer> layers) {
    DegreeBox box = layers.front().box;
    for (const TileLayer& layer : layers) {
        box = united(box, layer.box);
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
        const std::string crs_name = names_of(crs_from_text(layer.crs)).name;
        for (const LayerTile& tile : layer.tiles) {
            if (tile.is_wrapped) {
                continue;
            }
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

void note_pictures(const FileIndex& index, std::vector<std::string>& notes) {
    const auto pictures =
        std::count_if(index.files.begin(), index.files.end(),
                      [](const IndexedFile& file) { return file.use == FileKind::picture; });
    if (pictures > 0) {
        notes.push_back(fmt::format("{} {} in colour: not taken for heights (--imagery drapes one)",
                                    pictures, pictures == 1 ? "picture" : "pictures"));
    }
}

Error nothing_usable(const std::string& name, std::span<const FileError> errors) {
    if (errors.size() == 1 && errors.front().file == name) {
        return {errors.front().message};
    }
    return {errors.empty()
                ? fmt::format("{}: holds no raster of heights, at least one was expected", name)
                : fmt::format("{}: none of its {} rasters can be used, at least one was expected; "
                              "the first: {}",
                              name, errors.size(), errors.front().message)};
}

/// (longitude, latitude) along the outline of an area.
std::vector<glm::dvec2> outline_of(const geo::GeodeticArea& area) {
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

// Moves an outline by multiples of 360 degrees onto a layer.
void wrap_outline(std::vector<glm::dvec2>& outline, glm::dvec2 centre, const TileLayer& layer) {
    if (layer.period <= 0.0) {
        return;
    }
    constexpr double half_a_turn_stays = 1.0 - 1e-9;
    const double turned =
        layer.crs_from_lattice.crs_from_pixel(layer.lattice_from_wrapped(centre)).x;
    for (glm::dvec2& point : outline) {
        const double from_centre = point.x - centre.x;
        point.x = turned + from_centre -
                  layer.period * std::round(from_centre / layer.period * half_a_turn_stays);
    }
}

} // namespace

bool reaches_into(const TileFile& file, const geo::GeodeticArea& area) {
    const double turn = 360.0 * std::ceil((area.west - file.east) / 360.0);
    const bool beside = file.west + turn >= area.east || file.east + turn <= area.west;
    return !beside && file.south < area.north && file.north > area.south;
}

void keep_each_once(std::vector<FileError>& errors) {
    const auto by_file = [](const FileError& a, const FileError& b) { return a.file < b.file; };
    std::stable_sort(errors.begin(), errors.end(), by_file);
    const auto same = [](const FileError& a, const FileError& b) { return a.file == b.file; };
    errors.erase(std::unique(errors.begin(), errors.end(), same), errors.end());
}

LayerReading TileSet::State::reading(std::atomic<std::size_t>& bytes_read,
                                     const std::stop_token& stop) const {
    LayerReading reading{indexed, indexed_crs, folder,   {},        &bytes_read,
                         &whole,  &pool,       &failing, &new_notes};
    reading.options.height_scale = options.height_scale;
    reading.options.height_offset = options.height_offset;
    reading.options.stop = stop;
    return reading;
}

Result<Dataset> TileSet::State::open_raster_of_set(const std::filesystem::path& path,
                                                   const GdalMessages& messages) const {
    auto raster = whole.open(path, messages);
    if (!raster) {
        return raster.error();
    }
    if (raster->mixed_overviews.value_or(false)) {
        new_notes.add(path, mixed_overviews_note);
    }
    return std::move(raster->dataset);
}

Result<TileSet> TileSet::open(const std::filesystem::path& path, const TileSetOptions& options) {
    auto state = std::make_shared<State>();
    state->name = path.string();
    state->options = options;
    auto index = index_files(path, files_of(options), state->notes);
    if (!index) {
        return index.error();
    }
    std::error_code ignored;
    state->folder = std::filesystem::is_directory(path, ignored) ? path : std::filesystem::path();
    const GdalMessages ignored_messages; // becomes errors
    const std::vector<PlacedFile> placed = place_files(*index, state->folder, state->errors);
    if (placed.empty()) {
        return nothing_usable(state->name, state->errors);
    }
    note_pictures(*index, state->notes);
    state->indexed = std::move(index->files);
    state->indexed_crs = std::move(index->crs);
    state->layers = layers_of(placed, state->indexed);
    state->files = files_of(state->layers, placed, state->indexed, state->folder);
    state->vertical_datum = shared_vertical_datum(state->layers, state->indexed, state->notes);
    state->box = box_around(state->layers);
    const bool shared =
        std::all_of(state->layers.begin(), state->layers.end(),
                    [&](const TileLayer& layer) { return layer.crs == state->layers.front().crs; });
    state->crs = shared ? state->layers.front().crs : wgs84_degrees;
    state->is_on_plane = state->crs == plane_metres;
    state->is_spacing_assumed = index->is_spacing_assumed;
    state->crs_name = names_of(crs_from_text(state->crs)).name;
    state->grid = shared ? grid_in_shared_crs(state->layers, state->notes)
                         : grid_in_degrees(state->layers, state->box, state->notes);
    return TileSet(std::move(state));
}

const std::string& TileSet::name() const {
    return state_->name;
}
std::span<const TileFile> TileSet::files() const {
    return state_->files;
}
std::span<const FileError> TileSet::errors() const {
    return state_->errors;
}
std::span<const std::string> TileSet::notes() const {
    return state_->notes;
}
std::uint64_t TileSet::changes() const {
    return state_->pool.changes();
}

std::vector<std::string> TileSet::take_new_notes() const {
    return state_->new_notes.take();
}
const std::string& TileSet::crs_name() const {
    return state_->crs_name;
}
const std::string& TileSet::crs() const {
    return state_->crs;
}
const TileSetOptions& TileSet::options() const {
    return state_->options;
}
bool TileSet::is_on_plane() const {
    return state_->is_on_plane;
}
TileGrid TileSet::grid() const {
    return state_->grid;
}

Result<TileGrid> TileSet::part(const TileGrid& grid, const geo::GeodeticArea& area) const {
    const auto nothing = [&] {
        return Error{fmt::format("{}: has nothing from {} to {} north, {} to {} east, an area that "
                                 "overlaps its tiles was expected",
                                 state_->name, area.south, area.north, area.west, area.east)};
    };
    const GdalMessages ignored_messages;
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
        const glm::dvec2 centre(0.5 * (area.west + area.east) + 360.0 * turns,
                                0.5 * (area.south + area.north));
        points.push_back(centre);
        transform->apply(points);
        const glm::dvec2 at_centre = points.back();
        points.pop_back();
        wrap_outline(points, at_centre, state_->layers.front());
    }
    PointBounds box;
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

ImageryGround TileSet::imagery_ground(const TileGrid& grid) const {
    if (!is_on_plane()) {
        return {crs(), outer_affine_of(grid), {grid.cols, grid.rows}};
    }
    const IndexedFile& file = state_->indexed.front();
    return {"", file.crs_from_pixel, {file.cols, file.rows}};
}

geo::GlobalWrap TileSet::wrap(const TileGrid& grid) const {
    return closing_of(crs_from_text(state_->crs), affine_of(grid), grid.cols, grid.rows);
}

TileGrid TileSet::reduced(const TileGrid& grid, int reduction) {
    check(reduction >= 1, "TileSet::reduced needs a reduction of at least 1");
    const double k = reduction;
    const int cols = std::max(1, grid.cols / reduction);
    const int rows = std::max(1, grid.rows / reduction);
    const glm::dvec2 left_out(grid.cols - reduction * cols, grid.rows - reduction * rows);
    return {grid.first + 0.5 * (k - 1.0) * grid.step, k * grid.step, cols, rows,
            (0.5 * left_out + grid.to_middle) / k};
}

} // namespace reljef::io
