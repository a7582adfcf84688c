#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include <fmt/format.h>

#include "engine/io/imagery/imagery.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/globe.h"
#include "engine/io/raster/sample_reader.h"
#include "engine/io/raster/web_tiles.h"
#include "engine/io/remote/read_scope.h"
#include "engine/io/tile_set_state.h"

namespace reljef::io {
namespace {

// Samples per side of a read, without and with averaging.
constexpr int read_block = 512;
constexpr int reduced_block = 256;

/// The last component of a path, which may end with a slash.
std::string name_of(const std::filesystem::path& path) {
    return (path.has_filename() ? path : path.parent_path()).filename().string();
}

double samples_of(const TileGrid& grid) {
    return static_cast<double>(grid.cols) * grid.rows;
}

/// The smallest divisor of `around` in [reduction, 2·reduction]; else `reduction`.
int dividing_reduction(int around, int reduction) {
    for (int divisor = reduction; divisor - reduction <= reduction; ++divisor) {
        if (around % divisor == 0) {
            return divisor;
        }
    }
    return reduction;
}

/// `around`: samples per 360 degrees of a global grid, a multiple of the result; else 0.
Result<int> fitting_reduction(const TileGrid& grid, int around, const std::string& name,
                              std::size_t budget) {
    const double max_samples = static_cast<double>(budget) / bytes_per_sample;
    // The smallest that makes one sample of all.
    const int max_reduction = std::max(grid.cols, grid.rows);
    int reduction = clamped_int(std::sqrt(samples_of(grid) / max_samples), 1, max_reduction);
    while (reduction < max_reduction &&
           samples_of(TileSet::reduced(grid, reduction)) > max_samples) {
        ++reduction;
    }
    reduction = dividing_reduction(around, reduction);
    if (grid.cols / reduction < 2 || grid.rows / reduction < 2) {
        return Error{fmt::format("{}: {}×{} samples do not fit {} of memory, at least 2×2 of them "
                                 "were expected to",
                                 name, grid.cols, grid.rows,
                                 size_text(static_cast<double>(budget)))};
    }
    return reduction;
}

/// A raster without bands at the grid's place.
Dataset frame_of(const TileGrid& grid, const std::string& crs) {
    auto* driver = GetGDALDriverManager()->GetDriverByName("MEM");
    Dataset frame(driver->Create("", grid.cols, grid.rows, 0, GDT_Float32, nullptr));
    if (frame != nullptr) {
        const OGRSpatialReference system = crs_from_text(crs);
        place_raster(*frame, outer_affine_of(grid), &system);
    }
    return frame;
}

/// A part of a grid.
struct GridBlock {
    int col = 0;
    int row = 0;
    TileGrid grid;
};

std::vector<GridBlock> blocks_of_grid(const TileGrid& grid, int side) {
    std::vector<GridBlock> blocks;
    for (int row = 0; row < grid.rows; row += side) {
        for (int col = 0; col < grid.cols; col += side) {
            blocks.push_back({col,
                              row,
                              {grid.first + grid.step * glm::dvec2(col, row), grid.step,
                               std::min(side, grid.cols - col), std::min(side, grid.rows - row)}});
        }
    }
    return blocks;
}

void store_block(const GridBlock& block, const Grid<double>& heights, Samples& samples) {
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            const double height = heights(col, row);
            const bool is_void = std::isnan(height);
            samples.heights(block.col + col, block.row + row) =
                is_void ? 0.0F : static_cast<float>(height);
            samples.void_mask(block.col + col, block.row + row) = is_void ? 1 : 0;
        }
    }
}

/// The place of a grid's samples. Adds notes.
Result<Place> place_of_samples(const TileSet& tiles, const TileGrid& grid,
                               const TileTerrainOptions& options, std::vector<std::string>& notes) {
    const SampleGrid samples{glm::dvec2(0.5), glm::dvec2(1.0), grid.cols, grid.rows,
                             grid.to_middle};
    if (tiles.is_on_plane()) {
        Place place;
        place.grid = samples;
        place.spacing = glm::abs(grid.step);
        return place;
    }
    RasterOptions placing = options.raster;
    placing.spacing = {};
    const Dataset frame = frame_of(grid, tiles.crs());
    return place_of(*frame, samples, tiles.name(), placing, notes);
}

/// In the pixels of a raster whose affine has the axes of the grid.
SampleGrid in_pixels(const TileGrid& grid, const geo::PixelAffine& affine) {
    const glm::dvec2 step(affine.x_col, affine.y_row);
    return {(grid.first - glm::dvec2(affine.x0, affine.y0)) / step, grid.step / step, grid.cols,
            grid.rows};
}

terrain::HeightRange range_of_numbers(std::span<const double> heights) {
    terrain::HeightRange range{std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity()};
    for (const double height : heights) { // false for NaN
        range.low = height < range.low ? height : range.low;
        range.high = height > range.high ? height : range.high;
    }
    return range;
}

struct SetSamples {
    Samples samples;
    std::vector<FileError> errors;
};

std::vector<GridBlock> quarters_of(const GridBlock& block) {
    const int half = (std::max(block.grid.cols, block.grid.rows) + 1) / 2;
    std::vector<GridBlock> quarters = blocks_of_grid(block.grid, half);
    for (GridBlock& quarter : quarters) {
        quarter.col += block.col;
        quarter.row += block.row;
    }
    return quarters;
}

// A file that cannot be read at one place loses only what is around that place: a block with an
// error is read again in quarters, and so are these.
class BlockReader {
public:
    BlockReader(const TileSet& tiles, const TileTerrainOptions& options, Samples& samples)
        : tiles_(tiles), options_(options), samples_(samples) {}

    [[nodiscard]] std::vector<FileError> read(const GridBlock& block) const {
        std::vector<FileError> errors = read_once(block);
        return is_worth_quarters(block, errors, 0) ? read_quarters(block, 0) : std::move(errors);
    }

private:
    [[nodiscard]] std::vector<FileError> read_once(const GridBlock& block) const {
        TileWindow window = tiles_.read(block.grid, options_.gaps, options_.raster.stop);
        store_block(block, window.heights, samples_);
        return std::move(window.errors);
    }

    // `vain`: how often in turn no quarter could be read.
    [[nodiscard]] bool is_worth_quarters(const GridBlock& block,
                                         const std::vector<FileError>& errors, int vain) const {
        constexpr int smallest = 8; // samples a side
        constexpr int max_vain = 3; // then it is the file that cannot be read
        return !errors.empty() && vain < max_vain && !options_.raster.stop.stop_requested() &&
               std::max(block.grid.cols, block.grid.rows) > smallest;
    }

    [[nodiscard]] std::vector<FileError> read_quarters(const GridBlock& block, int vain) const {
        const std::vector<GridBlock> quarters = quarters_of(block);
        std::vector<std::vector<FileError>> found;
        std::transform(quarters.begin(), quarters.end(), std::back_inserter(found),
                       [&](const GridBlock& quarter) { return read_once(quarter); });
        const bool is_vain = std::none_of(found.begin(), found.end(),
                                          [](const auto& errors) { return errors.empty(); });
        const int vain_below = is_vain ? vain + 1 : 0;
        std::vector<FileError> all;
        for (std::size_t i = 0; i < quarters.size(); ++i) {
            if (is_worth_quarters(quarters[i], found[i], vain_below)) {
                found[i] = read_quarters(quarters[i], vain_below);
            }
            all.insert(all.end(), found[i].begin(), found[i].end());
        }
        keep_each_once(all);
        return all;
    }

    const TileSet& tiles_;
    const TileTerrainOptions& options_;
    Samples& samples_;
};

Result<SetSamples> read_all(const TileSet& tiles, const TileGrid& grid, int reduction,
                            const TileTerrainOptions& options) {
    SetSamples result;
    result.samples.heights = Grid<float>(grid.cols, grid.rows);
    result.samples.void_mask = Grid<std::uint8_t>(grid.cols, grid.rows);
    const std::vector<GridBlock> blocks =
        blocks_of_grid(grid, reduction > 1 ? reduced_block : read_block);
    const BlockReader reader(tiles, options, result.samples);
    std::mutex mutex;
    const auto read_one = [&](int number) {
        const GridBlock& block = blocks[static_cast<std::size_t>(number)];
        const auto errors = reader.read(block);
        const std::lock_guard lock(mutex);
        result.errors.insert(result.errors.end(), errors.begin(), errors.end());
    };
    if (!parallel_for(static_cast<int>(blocks.size()), read_one,
                      {.threads = options.threads,
                       .stop = options.raster.stop,
                       .progress = options.raster.progress})) {
        return Error{fmt::format("{}: reading was stopped", tiles.name())};
    }
    keep_each_once(result.errors);
    auto& mask = result.samples.void_mask;
    result.samples.void_count = static_cast<std::size_t>(
        std::count(mask.samples().begin(), mask.samples().end(), std::uint8_t{1}));
    if (result.samples.void_count == 0) {
        mask = {};
    }
    return result;
}

// Of all samples, so that it does not depend on the memory.
Result<terrain::HeightRange> range_of(const TileSet& tiles, const TileGrid& grid,
                                      const TileTerrainOptions& options) {
    const std::vector<GridBlock> blocks = blocks_of_grid(grid, read_block);
    terrain::HeightRange range{std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity()};
    std::mutex mutex;
    const auto add_block = [&](int number) {
        const TileWindow window = tiles.read(blocks[static_cast<std::size_t>(number)].grid,
                                             options.gaps, options.raster.stop);
        terrain::HeightRange of_block = range_of_numbers(window.heights.samples());
        const std::lock_guard lock(mutex);
        range.low = std::min(range.low, of_block.low);
        range.high = std::max(range.high, of_block.high);
    };
    const bool is_whole = parallel_for(static_cast<int>(blocks.size()), add_block,
                                       {.threads = options.threads,
                                        .stop = options.raster.stop,
                                        .progress = options.raster.progress});
    return is_whole ? Result<terrain::HeightRange>(range)
                    : Error{fmt::format("{}: reading was stopped", tiles.name())};
}

// Adds a note to the terrain of the plan.
Result<double> assumed_spacing_of(const TileSet& tiles, const TileSet::TerrainPlan& plan,
                                  const TileTerrainOptions& options, terrain::Terrain& terrain) {
    const auto range = plan.reduction == 1 ? Result<terrain::HeightRange>(terrain.heightfield.range)
                                           : range_of(tiles, plan.grid, options);
    const glm::dvec2 steps(plan.grid.cols - 1, plan.grid.rows - 1);
    return range ? Result<double>(assumed_spacing(*range, steps, terrain.notes)) : range.error();
}

Error all_voids(const TileSet& tiles, const TileGrid& grid, const terrain::Terrain& terrain) {
    return {fmt::format("{}: all {}×{} samples are voids, at least one height was expected{}{}",
                        tiles.name(), grid.cols, grid.rows,
                        is_web_tiles(tiles.name()) ? "; no tile was found at its level" : "",
                        terrain.errors.empty() ? "" : "; " + terrain.errors.front())};
}

std::string text_of_tiles(const TileSet& tiles, const std::optional<geo::GeodeticArea>& area) {
    const auto counts = [&](const TileFile& file) { return !area || reaches_into(file, *area); };
    const auto count = std::count_if(tiles.files().begin(), tiles.files().end(), counts);
    return count == 1 ? "1 tile" : fmt::format("{} tiles drawn as one", count);
}

void note_grid(const TileSet& tiles, const TileGrid& grid, int reduction, glm::dvec2 spacing,
               const std::optional<geo::GeodeticArea>& area, std::vector<std::string>& notes) {
    const std::string where = tiles.is_on_plane() ? "on a plane" : "in " + tiles.crs_name();
    notes.push_back(fmt::format("{} {}, {}×{} samples {:.4g} × {:.4g} m apart{}",
                                text_of_tiles(tiles, area), where, grid.cols, grid.rows, spacing.x,
                                spacing.y,
                                reduction == 1 ? ""
                                               : fmt::format(": 1/{} of the finest tiles', to fit "
                                                             "the memory",
                                                             reduction)));
}

void note_errors(const TileSet& tiles, std::span<const FileError> errors,
                 terrain::Terrain& terrain) {
    for (const auto& some : {tiles.errors(), errors}) {
        for (const FileError& error : some) {
            terrain.errors.push_back(error.message);
        }
    }
}

} // namespace

Result<TileSet::TerrainPlan> TileSet::plan(const TileTerrainOptions& options) const {
    const auto whole = options.area ? part(grid(), *options.area) : Result<TileGrid>(grid());
    if (!whole) {
        return whole.error();
    }
    const int around = samples_around(crs_from_text(crs()), affine_of(*whole));
    const bool is_whole = whole->cols == around || whole->cols == around + 1;
    const auto reduction =
        fitting_reduction(*whole, is_whole ? around : 0, name(), options.raster.memory_budget);
    return reduction ? Result<TerrainPlan>({*whole, *reduction}) : reduction.error();
}

Result<terrain::Terrain> TileSet::terrain(const TileTerrainOptions& options) const {
    const ReadScope scope(options.raster.stop);
    const auto planned = plan(options);
    if (!planned) {
        return planned.error();
    }
    const TileGrid samples_grid = TileSet::reduced(planned->grid, planned->reduction);
    terrain::Terrain result;
    result.name = name_of(name());
    result.notes.assign(notes().begin(), notes().end());
    const GdalMessages messages;
    auto place = place_of_samples(*this, samples_grid, options, result.notes);
    if (!place) {
        return place.error();
    }
    if (place->georeference) {
        place->georeference->vertical_datum = state_->vertical_datum;
    }
    auto read = read_all(*this, samples_grid, planned->reduction, options);
    if (!read) {
        return read.error();
    }
    note_errors(*this, read->errors, result);
    for (std::string& note : take_new_notes()) {
        result.notes.push_back(std::move(note));
    }
    if (read->samples.void_count == read->samples.heights.size()) {
        return all_voids(*this, planned->grid, result);
    }
    result.heightfield = heightfield_of(std::move(read->samples), *place, planned->reduction);
    if (state_->is_spacing_assumed) {
        const auto spacing = assumed_spacing_of(*this, *planned, options, result);
        if (!spacing) {
            return spacing.error();
        }
        result.heightfield.spacing *= *spacing;
    }
    note_grid(*this, samples_grid, planned->reduction, result.heightfield.spacing, options.area,
              result.notes);
    if (!options.raster.imagery.empty()) {
        // Images without a place are stretched over all samples, also those that the reduction
        // leaves out.
        const ImageryGround ground = imagery_ground(planned->grid);
        place->grid = in_pixels(samples_grid, ground.affine);
        auto color = read_imagery(ground, *place, options.raster, result.notes, result.errors);
        if (!color) {
            return color.error();
        }
        result.color = std::move(*color);
    }
    return result;
}

} // namespace reljef::io
