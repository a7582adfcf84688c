#include "engine/io/raster/sample_reader.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "engine/io/raster/sample_decoder.h"

namespace reljef::io {
namespace {

constexpr int max_taps = 4; // stored samples a side that are averaged into one
// Stored values read at a time: of a whole raster, by one thread, in rows as long as they come; of
// a window, by many.
constexpr int samples_of_raster = 1 << 21;
constexpr int samples_of_window = 1 << 18;

/// A part of the result, in its own samples.
struct Tile {
    int col = 0;
    int row = 0;
    int cols = 0;
    int rows = 0;
};

std::vector<Tile> tiles_of(const SampleGrid& grid, int taps, int tile_samples) {
    const int cols = std::clamp(tile_samples / (taps * taps), 1, grid.cols);
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
    GDALRasterBand* mask = nullptr; ///< null: none but a declared value
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

/// Reads tiles of stored values, `taps` of every `plan.reduction` a side.
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
        return band.RasterIO(GF_Read, plan_.col + tile.col * k, plan_.row + tile.row * k,
                             tile.cols * k, tile.rows * k, into, tile.cols * taps_,
                             tile.rows * taps_, type, 0, 0, nullptr) == CE_None;
    }

    Source source_;
    ReadPlan plan_;
    int taps_;
    std::size_t count_ = 0;
    std::vector<double> values_;
    std::vector<unsigned char> mask_;
};

/// The mean of the taps that are no voids; void_value when there is none.
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

/// Calls store(col, row, height) for every sample of the tile; void_value at voids.
template <class Store>
void store_tile(const Tile& tile, std::span<const double> values, int taps, const Store& store) {
    const int cols = tile.cols * taps;
    const GridView<const double> stored(values.data(), cols, tile.rows * taps, cols);
    for (int row = 0; row < tile.rows; ++row) {
        for (int col = 0; col < tile.cols; ++col) {
            store(tile.col + col, tile.row + row,
                  mean_of(stored.window(col * taps, row * taps, taps, taps)));
        }
    }
}

Error reading_failed(const std::string& name, const Tile& tile, const ReadPlan& plan,
                     const GdalMessages& messages) {
    return {fmt::format("{}: cannot be read at row {}{}, a whole file was expected", name,
                        plan.row + tile.row * plan.reduction, messages.reason())};
}

/// Reads and decodes all of a plan, so many stored values at a time; store(col, row, height) gets
/// each sample.
template <class Store>
Result<void> read_plan(GDALDataset& dataset, const ReadPlan& plan, int at_a_time,
                       SampleDecoder& decoder, const std::string& name,
                       const RasterOptions& options, const GdalMessages& messages,
                       const Store& store) {
    TileContentReader reader(source_of(dataset, plan, decoder.bands()), plan);
    const std::vector<Tile> tiles = tiles_of(plan.grid, reader.taps(), at_a_time);
    const std::size_t errors = messages.errors();
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        if (options.stop.stop_requested()) {
            return Error{fmt::format("{}: reading was stopped", name)};
        }
        if (!reader.read(tiles[i]) || messages.errors() > errors || messages.has_lost_blocks()) {
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
    if (auto read =
            read_plan(dataset, plan, samples_of_raster, *decoder, name, options, messages, store);
        !read) {
        return read.error();
    }
    for (std::string note : {decoder->undeclared_voids_note(), decoder->doubtful_heights_note()}) {
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
    if (auto read =
            read_plan(dataset, plan, samples_of_window, *decoder, name, options, messages, store);
        !read) {
        return read.error();
    }
    for (std::string& words : decoder->found_words()) {
        notes.push_back(std::move(words));
    }
    return heights;
}

} // namespace reljef::io
