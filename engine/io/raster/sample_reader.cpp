#include "engine/io/raster/sample_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "engine/io/raster/globe.h"
#include "engine/io/raster/sample_decoder.h"
#include "engine/io/remote/read_scope.h"

namespace reljef::io {
namespace {

constexpr int max_taps = 4;                // stored samples per side that are averaged into one
constexpr int samples_at_a_time = 1 << 18; // stored values per read

/// A part of the result.
using Tile = RasterOptions::Window;

// The widest tile whose blocks stay in GDAL's cache from one row of stored values to the next, with
// reads of several threads; wider ones decode each block once a row.
int max_cols_within_cache(GDALRasterBand& band, int reduction) {
    constexpr GIntBig reads_at_once = 8;
    int cols = 0;
    int rows = 0;
    band.GetBlockSize(&cols, &rows);
    const GIntBig bytes = GIntBig{cols} * rows * GDALGetDataTypeSizeBytes(band.GetRasterDataType());
    const GIntBig blocks =
        std::max<GIntBig>(GDALGetCacheMax64() / reads_at_once / std::max<GIntBig>(bytes, 1), 1);
    constexpr GIntBig any = std::numeric_limits<int>::max();
    return static_cast<int>(std::clamp<GIntBig>(blocks * cols / reduction, 1, any));
}

std::vector<Tile> tiles_of(const SampleGrid& grid, int taps, int tile_samples, int max_cols) {
    const int cols = std::clamp(tile_samples / (taps * taps), 1, std::min(grid.cols, max_cols));
    const int rows = std::clamp(tile_samples / (taps * taps) / cols, 1, grid.rows);
    std::vector<Tile> tiles;
    for (int row = 0; row < grid.rows; row += rows) {
        for (int col = 0; col < grid.cols; col += cols) {
            tiles.push_back(
                {col, row, std::min(cols, grid.cols - col), std::min(rows, grid.rows - row)});
        }
    }
    return tiles;
}

/// The bands and the mask at the planned resolution.
struct Source {
    std::vector<GDALRasterBand*> bands;
    GDALRasterBand* mask = nullptr; ///< null: only a declared void
};

GDALRasterBand* at_level(GDALRasterBand* band, int overview) {
    return overview < 0 ? band : band->GetOverview(overview);
}

Source source_of(GDALDataset& dataset, const ReadPlan& plan, int bands) {
    Source source;
    for (int i = 1; i <= bands; ++i) {
        source.bands.push_back(at_level(dataset.GetRasterBand(i), plan.overview));
    }
    if ((source.bands.front()->GetMaskFlags() & GMF_PER_DATASET) != 0) {
        source.mask = source.bands.front()->GetMaskBand();
    }
    return source;
}

/// Reads tiles of stored values, `taps` of `plan.reduction` per side.
class TileContentReader {
public:
    TileContentReader(Source source, const ReadPlan& plan)
        : source_(std::move(source)), plan_(plan), taps_(std::min(plan.reduction, max_taps)) {}

    [[nodiscard]] int taps() const { return taps_; }
    [[nodiscard]] std::span<double> first() { return std::span(values_).first(count_); }
    [[nodiscard]] std::span<const double> others() const {
        return std::span(values_).subspan(count_);
    }
    [[nodiscard]] std::span<const unsigned char> mask() const { return mask_; }

    bool read(const Tile& tile) {
        count_ = static_cast<std::size_t>(tile.cols) * static_cast<std::size_t>(tile.rows) *
                 static_cast<std::size_t>(taps_ * taps_);
        values_.resize(count_ * source_.bands.size());
        for (std::size_t i = 0; i < source_.bands.size(); ++i) {
            if (!read_band(*source_.bands[i], tile, values_.data() + i * count_, GDT_Float64)) {
                return false;
            }
        }
        if (source_.mask == nullptr) {
            return true;
        }
        mask_.resize(count_);
        return read_band(*source_.mask, tile, mask_.data(), GDT_Byte);
    }

private:
    bool read_band(GDALRasterBand& band, const Tile& tile, void* into, GDALDataType type) const {
        const int k = plan_.reduction;
        return read_window(band, {{plan_.col + tile.col * k, plan_.row + tile.row * k},
                                  {tile.cols * k, tile.rows * k},
                                  into,
                                  {tile.cols * taps_, tile.rows * taps_},
                                  type});
    }

    Source source_;
    ReadPlan plan_;
    int taps_;
    std::size_t count_ = 0;
    std::vector<double> values_;
    std::vector<unsigned char> mask_;
};

/// Mean of the taps without voids; void_value if all are voids.
double mean_of(GridView<const double> taps) {
    double sum = 0.0;
    int count = 0;
    for (int row = 0; row < taps.rows(); ++row) {
        for (const double value : taps.row(row)) {
            if (!std::isnan(value)) {
                sum += value;
                ++count;
            }
        }
    }
    return count == 0 ? void_value : sum / count;
}

/// Calls store(col, row, height) for every sample of a tile.
template <class Store>
void store_tile(const Tile& tile, std::span<const double> values, int taps, const Store& store) {
    const int cols = tile.cols * taps;
    const GridView<const double> stored(values.data(), cols, tile.rows * taps, cols);
    const auto height_at = [&](int col, int row) {
        return taps == 1 ? stored(col, row)
                         : mean_of(stored.window(col * taps, row * taps, taps, taps));
    };
    for (int row = 0; row < tile.rows; ++row) {
        for (int col = 0; col < tile.cols; ++col) {
            store(tile.col + col, tile.row + row, height_at(col, row));
        }
    }
}

Error reading_failed(const std::string& name, const Tile& tile, const ReadPlan& plan,
                     const GdalMessages& messages) {
    return {fmt::format("{}: cannot be read at row {}{}, a whole file was expected", name,
                        plan.row + tile.row * plan.reduction, messages.reason())};
}

/// Reads and decodes a plan in blocks; see store_tile.
template <class Store>
Result<void> read_plan(GDALDataset& dataset, const ReadPlan& plan, SampleDecoder& decoder,
                       const std::string& name, const RasterOptions& options,
                       const GdalMessages& messages, const Store& store) {
    Source source = source_of(dataset, plan, decoder.bands());
    const int max_cols = max_cols_within_cache(*source.bands.front(), plan.reduction);
    TileContentReader reader(std::move(source), plan);
    const std::vector<Tile> tiles = tiles_of(plan.grid, reader.taps(), samples_at_a_time, max_cols);
    const std::size_t errors = messages.errors();
    const ReadScope scope(options.stop);
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const bool read = reader.read(tiles[i]);
        if (options.stop.stop_requested()) {
            return Error{fmt::format("{}: reading was stopped", name)};
        }
        if (!read || messages.errors() > errors || messages.has_lost_blocks()) {
            return reading_failed(name, tiles[i], plan, messages);
        }
        if (!decoder.fits(reader.first(), reader.others())) {
            return Error{
                fmt::format("{}: is grey, heights in red, green and blue were expected", name)};
        }
        decoder.decode(reader.first(), reader.others(), reader.mask());
        store_tile(tiles[i], reader.first(), reader.taps(), store);
        if (options.progress) {
            options.progress(static_cast<double>(i + 1) / static_cast<double>(tiles.size()));
        }
    }
    return {};
}

template <class T> void flip(Grid<T>& grid, const Place& place) {
    if (place.flipped_rows) {
        for (int row = 0; row < grid.rows() / 2; ++row) {
            std::swap_ranges(grid.row(row).begin(), grid.row(row).end(),
                             grid.row(grid.rows() - 1 - row).begin());
        }
    }
    for (int row = 0; place.flipped_cols && row < grid.rows(); ++row) {
        std::reverse(grid.row(row).begin(), grid.row(row).end());
    }
}

template <class T> Grid<T> with_closing_samples(const Grid<T>& grid, const geo::GlobalWrap& wrap) {
    Grid<T> result(grid.cols() + wrap.cols(), grid.rows() + wrap.rows());
    for (int row = 0; row < grid.rows(); ++row) {
        const auto target = result.row(row + wrap.north_rows());
        std::copy(grid.row(row).begin(), grid.row(row).end(), target.begin());
        if (wrap.east) {
            target[target.size() - 1] = target[0];
        }
    }
    return result;
}

template <class T> void fill_row(Grid<T>& grid, int row, T value) {
    std::fill(grid.row(row).begin(), grid.row(row).end(), value);
}

/// Mean height of the first `cols` samples of a row without its voids.
struct RowMean {
    float height = 0.0F;
    bool is_void = false;
};

RowMean mean_of_row(const Grid<float>& heights, const Grid<std::uint8_t>& voids, int row,
                    int cols) {
    double sum = 0.0;
    double filled = 0.0;
    int count = 0;
    for (int col = 0; col < cols; ++col) {
        filled += heights(col, row);
        if (voids.empty() || voids(col, row) == 0) {
            sum += heights(col, row);
            ++count;
        }
    }
    return {static_cast<float>(count > 0 ? sum / count : filled / cols), count == 0};
}

void close_pole(Grid<float>& heights, Grid<std::uint8_t>& voids, int pole_row, int outermost,
                int cols) {
    const RowMean mean = mean_of_row(heights, voids, outermost, cols);
    fill_row(heights, pole_row, mean.height);
    if (!voids.empty()) {
        fill_row(voids, pole_row, static_cast<std::uint8_t>(mean.is_void ? 1 : 0));
    }
}

/// Adds the samples of a wrap. A pole gets the mean of its row, and is a void if the row is.
void close_samples(Grid<float>& heights, Grid<std::uint8_t>& void_mask,
                   const geo::GlobalWrap& wrap) {
    if (wrap.cols() == 0 && wrap.rows() == 0) {
        return;
    }
    const int cols = heights.cols();
    heights = with_closing_samples(heights, wrap);
    void_mask = void_mask.empty() ? std::move(void_mask) : with_closing_samples(void_mask, wrap);
    if (wrap.north > 0.0) {
        close_pole(heights, void_mask, 0, 1, cols);
    }
    if (wrap.south > 0.0) {
        close_pole(heights, void_mask, heights.rows() - 1, heights.rows() - 2, cols);
    }
}

} // namespace

Result<Samples> read_samples(GDALDataset& dataset, const ReadPlan& plan, const std::string& name,
                             const RasterOptions& options, const GdalMessages& messages,
                             std::vector<std::string>& notes) {
    auto decoder = SampleDecoder::create(dataset, name, options, notes);
    if (!decoder) {
        return decoder.error();
    }
    Samples samples{Grid<float>(plan.grid.cols, plan.grid.rows),
                    Grid<std::uint8_t>(plan.grid.cols, plan.grid.rows), 0};
    const auto store = [&](int col, int row, double height) {
        const bool is_void = std::isnan(height);
        samples.heights(col, row) = is_void ? 0.0F : static_cast<float>(height);
        samples.void_mask(col, row) = is_void ? 1 : 0;
        samples.void_count += is_void ? 1 : 0;
    };
    if (auto read = read_plan(dataset, plan, *decoder, name, options, messages, store); !read) {
        return read.error();
    }
    for (std::string note :
         {decoder->undeclared_voids_note(name), decoder->doubtful_heights_note(name)}) {
        if (!note.empty()) {
            notes.push_back(std::move(note));
        }
    }
    if (samples.void_count == 0) {
        samples.void_mask = {};
    }
    return samples;
}

Result<Grid<double>> read_heights(GDALDataset& dataset, const ReadPlan& plan,
                                  const std::string& name, const RasterOptions& options,
                                  const GdalMessages& messages, std::vector<std::string>& notes) {
    std::vector<std::string> ignored;
    auto decoder = SampleDecoder::create(dataset, name, options, ignored);
    if (!decoder) {
        return decoder.error();
    }
    Grid<double> heights(plan.grid.cols, plan.grid.rows);
    const auto store = [&](int col, int row, double height) { heights(col, row) = height; };
    if (auto read = read_plan(dataset, plan, *decoder, name, options, messages, store); !read) {
        return read.error();
    }
    for (std::string& words : decoder->found_notes()) {
        notes.push_back(std::move(words));
    }
    return heights;
}

// A column that closes the globe is as far from the last one as one of the source's: nearer than
// the others are. Rows with poles are even about the equator.
glm::dvec2 to_middle_of(const Place& place, double reduction) {
    const double closing = place.wrap.east ? 0.5 * (1.0 - reduction) / reduction : 0.0;
    return {place.grid.to_middle.x + closing, place.wrap.rows() > 0 ? 0.0 : place.grid.to_middle.y};
}

terrain::Heightfield heightfield_of(Samples samples, Place& place, double reduction) {
    flip(samples.heights, place);
    flip(samples.void_mask, place);
    terrain::Heightfield result;
    result.range = terrain::height_range(samples.heights, samples.void_mask);
    terrain::fill_voids(samples.heights, samples.void_mask);
    close_samples(samples.heights, samples.void_mask, place.wrap);
    result.heights = std::move(samples.heights);
    result.void_mask = std::move(samples.void_mask);
    result.void_count = static_cast<std::size_t>(std::count(
        result.void_mask.samples().begin(), result.void_mask.samples().end(), std::uint8_t{1}));
    result.spacing = place.spacing;
    result.reduction = reduction;
    result.to_middle = to_middle_of(place, reduction);
    result.georeference = std::move(place.georeference);
    return result;
}

double assumed_spacing(const terrain::HeightRange& range, glm::dvec2 steps,
                       std::vector<std::string>& notes) {
    const double relief = range.high - range.low;
    const double width = std::max(steps.x, steps.y);
    if (relief <= 0.5 * width) {
        notes.emplace_back("no coordinate system: 1 m spacing assumed");
        return 1.0;
    }
    const double exact = 10.0 * relief / width;
    const double digit = std::pow(10.0, std::floor(std::log10(exact)) - 1.0);
    const double spacing = digit * std::round(exact / digit);
    notes.push_back(fmt::format("no coordinate system: {:.6g} m spacing assumed, which makes the "
                                "relief of {:.6g} m a tenth of the width",
                                spacing, relief));
    return spacing;
}

} // namespace reljef::io
