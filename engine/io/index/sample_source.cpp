#include "engine/io/index/sample_source.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "engine/io/index/column_runs.h"
#include "engine/io/remote/read_scope.h"

namespace reljef::io {
namespace {

constexpr int code_count = 1 << 16;

double value_of(int code, GDALDataType type) {
    return type == GDT_Int16 && code >= code_count / 2 ? code - code_count : code;
}

/// Values that are voids wherever they are.
bool is_void_anywhere(double value, GDALRasterBand& band) {
    int has = 0;
    const double declared = band.GetNoDataValue(&has);
    return (has != 0 && value == declared) || value == -32768.0 || value == -32767.0;
}

bool is_readable(GDALDataset& dataset, const IndexSource& source) {
    GDALRasterBand& band = *dataset.GetRasterBand(1);
    const GDALDataType type = band.GetRasterDataType();
    const TileFile& file = source.tiles.files().front();
    return (type == GDT_Byte || type == GDT_Int16 || type == GDT_UInt16 || type == GDT_Float32) &&
           kind_of_values(dataset) == ValueKind::plain &&
           (band.GetMaskFlags() & GMF_PER_DATASET) == 0 &&
           height_encoding_of(file.path.string()) == HeightEncoding::none &&
           dataset.GetRasterXSize() == file.cols && dataset.GetRasterYSize() == file.rows;
}

} // namespace

void SampleWindow::Part::copy_row(int row, std::span<float> into) const {
    const auto count = static_cast<std::size_t>(size.x);
    const std::size_t begin = static_cast<std::size_t>(row) * count;
    if (height_of_code != nullptr) { // plain pointers: checks of bounds would take half of the time
        const std::uint16_t* const from = codes.get() + begin;
        const float* const table = height_of_code->data();
        float* const to = into.data();
        for (std::size_t i = 0; i < count; ++i) {
            to[i] = table[from[i]];
        }
    } else if (floats != nullptr) {
        std::copy_n(floats.get() + begin, count, into.begin());
    } else {
        const auto from = heights.row(row);
        std::transform(from.begin(), from.end(), into.begin(),
                       [](double height) { return static_cast<float>(height); });
    }
}

SampleWindow::SampleWindow(const IndexSource& source, glm::ivec2 first, glm::ivec2 size)
    : first_row_(first.y), last_row_(source.tree.rows() - 1) {
    const geo::GlobalWrap& wrap = source.tree.wrap();
    north_ = wrap.north > 0.0 ? std::optional(source.north_height) : std::nullopt;
    south_ = wrap.south > 0.0 ? std::optional(source.south_height) : std::nullopt;
    const int begin = std::clamp(first.y - wrap.north_rows(), 0, source.grid.rows - 1);
    const int last = std::clamp(first.y + size.y - 1 - wrap.north_rows(), 0, source.grid.rows - 1);
    rows_before_ = wrap.north_rows() + begin;
    const ColumnRange range{source.grid.cols, wrap.around ? source.tree.cols() - 1 : 0};
    for (const ColumnRun& run : column_runs(first.x, size.x, range)) {
        parts_.push_back(
            {.at = run.at, .first = {run.first, begin}, .size = {run.count, last - begin + 1}});
    }
}

void SampleWindow::read(const IndexSource& source, Part& part, const std::stop_token& stop) {
    const TileGrid& grid = source.grid;
    TileWindow read = source.tiles.read(
        {grid.first + grid.step * glm::dvec2(part.first), grid.step, part.size.x, part.size.y},
        source.gaps, stop);
    part.heights = std::move(read.heights);
    part.codes.reset();
    part.floats.reset();
    errors_.insert(errors_.end(), read.errors.begin(), read.errors.end());
    bytes_read_ += read.bytes_read;
}

void SampleWindow::copy_row(int row, std::span<float> heights) const {
    const int closed = std::clamp(first_row_ + row, 0, last_row_);
    if (const auto pole = closed == 0 ? north_ : closed == last_row_ ? south_ : std::nullopt) {
        std::fill(heights.begin(), heights.end(), *pole);
        return;
    }
    const int inside = std::clamp(closed - rows_before_, 0, parts_.front().size.y - 1);
    for (const Part& part : parts_) {
        part.copy_row(inside, heights.subspan(static_cast<std::size_t>(part.at)));
    }
    const auto begin = static_cast<std::size_t>(parts_.front().at);
    const auto end =
        static_cast<std::size_t>(parts_.back().at) + static_cast<std::size_t>(parts_.back().size.x);
    std::fill_n(heights.begin(), begin, heights[begin]);
    std::fill(heights.begin() + static_cast<std::ptrdiff_t>(end), heights.end(), heights[end - 1]);
}

SampleWindow read_sample_window(const IndexSource& source, glm::ivec2 first, glm::ivec2 size,
                                const std::stop_token& stop) {
    SampleWindow window(source, first, size);
    for (SampleWindow::Part& part : window.parts_) {
        window.read(source, part, stop);
    }
    return window;
}

SampleSource::SampleSource(const IndexSource& source)
    : source_(source), direct_(open_direct(source)) {}

std::optional<SampleSource::Direct> SampleSource::open_direct(const IndexSource& source) {
    const auto first_pixel = source.tiles.first_pixel(source.grid);
    if (!first_pixel) {
        return std::nullopt;
    }
    const GdalMessages messages;
    const std::filesystem::path& path = source.tiles.files().front().path;
    auto dataset = open_raster(path, messages);
    if (!dataset || !is_readable(**dataset, source)) {
        return std::nullopt;
    }
    RasterOptions options;
    options.height_scale = source.tiles.options().height_scale;
    options.height_offset = source.tiles.options().height_offset;
    std::vector<std::string> ignored_notes;
    auto decoder = SampleDecoder::create(**dataset, path.string(), options, ignored_notes);
    if (!decoder) {
        return std::nullopt;
    }
    const GDALDataType type = (*dataset)->GetRasterBand(1)->GetRasterDataType();
    Direct direct{std::move(*dataset), *first_pixel, std::move(*decoder),
                  type == GDT_Byte ? GDT_UInt16 : type};
    if (type != GDT_Float32) {
        add_codes(direct);
    }
    constexpr std::size_t max_contextual_codes = 2; // each is searched in all samples
    return direct.contextual_codes.size() <= max_contextual_codes ? std::optional(std::move(direct))
                                                                  : std::nullopt;
}

void SampleSource::add_codes(Direct& direct) {
    GDALRasterBand& band = *direct.dataset->GetRasterBand(1);
    std::vector<float> heights(code_count);
    for (int code = 0; code < code_count; ++code) {
        double height = value_of(code, direct.type);
        const bool is_void = is_void_anywhere(height, band);
        direct.decoder.decode({&height, 1}, {}, {});
        heights[static_cast<std::size_t>(code)] = static_cast<float>(height);
        if (std::isnan(height) && !is_void) {
            direct.contextual_codes.push_back(static_cast<std::uint16_t>(code));
        }
    }
    direct.height_of_code = std::make_shared<const std::vector<float>>(std::move(heights));
}

bool SampleSource::read_stored(glm::ivec2 first, glm::ivec2 size, void* values,
                               const std::stop_token& stop) const {
    const std::lock_guard lock(mutex_);
    const ReadScope scope(stop);
    const GdalMessages messages;
    const bool read =
        read_window(*direct_->dataset->GetRasterBand(1),
                    {direct_->first_pixel + first, size, values, size, direct_->type});
    return read && messages.errors() == 0 && !messages.has_lost_blocks();
}

// False: the other way tells why.
bool SampleSource::read_direct(SampleWindow::Part& part, const std::stop_token& stop) const {
    if (!direct_) {
        return false;
    }
    const std::size_t count =
        static_cast<std::size_t>(part.size.x) * static_cast<std::size_t>(part.size.y);
    if (direct_->type == GDT_Float32) {
        part.floats = std::make_unique_for_overwrite<float[]>(count);
        return read_stored(part.first, part.size, part.floats.get(), stop) &&
               direct_->decoder.decode_floats({part.floats.get(), count});
    }
    part.codes = std::make_unique_for_overwrite<std::uint16_t[]>(count);
    if (!read_stored(part.first, part.size, part.codes.get(), stop)) {
        return false;
    }
    for (const std::uint16_t code : direct_->contextual_codes) {
        int found = 0;
        const std::uint16_t* const codes = part.codes.get();
        for (std::size_t i = 0; i < count; ++i) {
            found |= codes[i] == code ? 1 : 0;
        }
        if (found != 0) {
            return false;
        }
    }
    part.height_of_code = direct_->height_of_code;
    return true;
}

SampleWindow SampleSource::read(glm::ivec2 first, glm::ivec2 size,
                                const std::stop_token& stop) const {
    SampleWindow window(source_, first, size);
    for (SampleWindow::Part& part : window.parts_) {
        if (!read_direct(part, stop)) {
            window.read(source_, part, stop);
        }
    }
    return window;
}

} // namespace reljef::io
