#include "engine/io/index/sample_source.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

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

void SampleWindow::copy_row(int row, std::span<float> heights) const {
    const int inside = std::clamp(row - before_.y, 0, size_.y - 1);
    const auto begin = static_cast<std::size_t>(before_.x);
    const auto count = static_cast<std::size_t>(size_.x);
    if (height_of_code_ !=
        nullptr) { // plain pointers: checks of bounds would take half of the time
        const std::uint16_t* const codes = codes_.get() + static_cast<std::size_t>(inside) * count;
        const float* const table = height_of_code_->data();
        float* const into = heights.data() + begin;
        for (std::size_t i = 0; i < count; ++i) {
            into[i] = table[codes[i]];
        }
    } else if (floats_ != nullptr) {
        std::copy_n(floats_.get() + static_cast<std::size_t>(inside) * count, count,
                    heights.begin() + before_.x);
    } else {
        const auto from = heights_.row(inside);
        std::transform(from.begin(), from.end(), heights.begin() + before_.x,
                       [](double height) { return static_cast<float>(height); });
    }
    std::fill_n(heights.begin(), begin, heights[begin]);
    std::fill(heights.begin() + before_.x + size_.x, heights.end(), heights[begin + count - 1]);
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
bool SampleSource::read_direct(glm::ivec2 first, SampleWindow& window,
                               const std::stop_token& stop) const {
    if (!direct_) {
        return false;
    }
    const std::size_t count =
        static_cast<std::size_t>(window.size_.x) * static_cast<std::size_t>(window.size_.y);
    if (direct_->type == GDT_Float32) {
        window.floats_ = std::make_unique_for_overwrite<float[]>(count);
        return read_stored(first, window.size_, window.floats_.get(), stop) &&
               direct_->decoder.decode_floats({window.floats_.get(), count});
    }
    window.codes_ = std::make_unique_for_overwrite<std::uint16_t[]>(count);
    if (!read_stored(first, window.size_, window.codes_.get(), stop)) {
        return false;
    }
    for (const std::uint16_t code : direct_->contextual_codes) {
        int found = 0;
        const std::uint16_t* const codes = window.codes_.get();
        for (std::size_t i = 0; i < count; ++i) {
            found |= codes[i] == code ? 1 : 0;
        }
        if (found != 0) {
            return false;
        }
    }
    window.height_of_code_ = direct_->height_of_code;
    return true;
}

SampleWindow SampleSource::read(glm::ivec2 first, glm::ivec2 size,
                                const std::stop_token& stop) const {
    const TileGrid& grid = source_.grid;
    const glm::ivec2 last(grid.cols - 1, grid.rows - 1);
    SampleWindow window;
    const glm::ivec2 from = glm::clamp(first, glm::ivec2(0), last);
    window.before_ = from - first;
    window.size_ = glm::min(first + size - 1, last) - from + 1;
    if (!read_direct(from, window, stop)) {
        const TileGrid part{grid.first + grid.step * glm::dvec2(from), grid.step, window.size_.x,
                            window.size_.y};
        TileWindow read = source_.tiles.read(part, source_.gaps, stop);
        window.heights_ = std::move(read.heights);
        window.errors_ = std::move(read.errors);
        window.codes_.reset();
        window.floats_.reset();
    }
    return window;
}

} // namespace reljef::io
