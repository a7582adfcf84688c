#include "engine/io/image/image.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "engine/io/image/image_encoder.h"
#include "engine/io/image/picture_checksum.h"
#include "engine/io/image/picture_file.h"

namespace reljef::io {
namespace fs = std::filesystem;
namespace {

constexpr int jpeg_quality = 95;
constexpr std::size_t max_picture_bytes = std::size_t{1} << 30;
constexpr int rows_at_a_time = 64;
constexpr int sheet_gap = 4; // pixels
constexpr Rgba8 sheet_background{24, 24, 24, 255};

std::uint8_t rounded(float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255.0F));
}

/// `values`: per pixel `channels` values in [0,1]: grey, grey and alpha, RGB, or RGBA and more.
void store_row(std::span<const float> values, int channels, bool linear, std::span<Rgba8> row) {
    const auto stride = static_cast<std::size_t>(channels);
    for (std::size_t i = 0; i < row.size(); ++i) {
        const float* pixel = &values[i * stride];
        const bool grey = channels < 3;
        const glm::vec3 color =
            grey ? glm::vec3(pixel[0]) : glm::vec3(pixel[0], pixel[1], pixel[2]);
        const float alpha = channels == 2 ? pixel[1] : channels >= 4 ? pixel[3] : 1.0F;
        row[i] = linear
                     ? rgba8_from_linear(color, rounded(alpha))
                     : Rgba8{rounded(color.r), rounded(color.g), rounded(color.b), rounded(alpha)};
    }
}

// OpenImageIO 2.4 divides by zero where it reads scanlines of a TIFF with tiles.
// `values`: the rows of the picture, all of its columns.
bool read_rows(OIIO::ImageInput& input, int first_row, int channels, std::span<float> values) {
    const OIIO::ImageSpec& spec = input.spec();
    const std::size_t row_values =
        static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(channels);
    const int begin = spec.y + first_row;
    const int end = begin + static_cast<int>(values.size() / row_values);
    return spec.tile_width > 0
               ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, begin, end, spec.z, spec.z + 1,
                                  0, channels, OIIO::TypeDesc::FLOAT, values.data())
               : input.read_scanlines(0, 0, begin, end, 0, 0, channels, OIIO::TypeDesc::FLOAT,
                                      values.data());
}

Result<Image> read_open_image(OIIO::ImageInput& input, const fs::path& path) {
    const OIIO::ImageSpec& spec = input.spec();
    Image image(spec.width, spec.height);
    const bool linear = spec.format.is_floating_point();
    const int channels = std::min(spec.nchannels, 4);
    const std::size_t row_values =
        static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(channels);
    const int step = std::min(spec.tile_width > 0 ? spec.tile_height : rows_at_a_time, spec.height);
    std::vector<float> values(row_values * static_cast<std::size_t>(step));
    for (int begin = 0; begin < spec.height; begin += step) {
        const int end = std::min(begin + step, spec.height);
        const auto rows = static_cast<std::size_t>(end - begin);
        if (!read_rows(input, begin, channels, std::span(values).first(rows * row_values))) {
            return Error{
                fmt::format("{}: cannot be read at row {} ({}), a whole picture was expected",
                            path.string(), begin, input.geterror())};
        }
        for (int row = begin; row < end; ++row) {
            const auto first = static_cast<std::size_t>(row - begin) * row_values;
            store_row(std::span(values).subspan(first, row_values), channels, linear,
                      image.row(row));
        }
    }
    return image;
}

std::unique_ptr<OIIO::ImageOutput> output_for(const fs::path& path) {
    auto output = OIIO::ImageOutput::create(path.string());
    static_cast<void>(OIIO::geterror());
    // The JPEG 2000 encoder needs a file extension; files in memory have none.
    if (output != nullptr && std::string_view(output->format_name()) == "jpeg2000") {
        output.reset();
    }
    return output;
}

Error unknown_format(const fs::path& path) {
    return {fmt::format("{}: cannot be written: {:?} names no format of pictures, .png or .jpg "
                        "was expected",
                        path.string(), path.extension().string())};
}

Result<std::unique_ptr<OIIO::ImageOutput>> output_for(const fs::path& path, const Image& image) {
    if (image.empty()) {
        return Error{fmt::format("{}: cannot be written: a picture of {}×{} pixels was given, at "
                                 "least 1×1 was expected",
                                 path.string(), image.cols(), image.rows())};
    }
    auto output = output_for(path);
    return output ? Result<std::unique_ptr<OIIO::ImageOutput>>(std::move(output))
                  : unknown_format(path);
}

bool is_of_format(const OIIO::ImageOutput& output, std::string_view format) {
    return output.format_name() == format;
}

// Formats whose pictures have a checksum of ours. PNG has its own.
bool gets_checksum(const OIIO::ImageOutput& output) {
    return is_of_format(output, "jpeg") || is_of_format(output, "tiff");
}

// OpenImageIO would write JPEG in a TIFF, too, which loses colours, and the time, which makes equal
// pictures differ; blanks are an unknown time (Exif 2.3, DateTime).
OIIO::ImageSpec spec_of(const Image& image, const OIIO::ImageOutput& output) {
    OIIO::ImageSpec spec(image.cols(), image.rows(), 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("Compression",
                   is_of_format(output, "jpeg") ? fmt::format("jpeg:{}", jpeg_quality) : "zip");
    if (is_of_format(output, "tiff")) {
        spec.attribute("DateTime", "    :  :     :  :  ");
    }
    if (gets_checksum(output)) {
        spec.attribute("ImageDescription", std::string(checksum_text));
    }
    return spec;
}

Result<std::vector<std::byte>> encoded_picture(std::unique_ptr<OIIO::ImageOutput> output,
                                               const Image& image) {
    const OIIO::ImageSpec spec = spec_of(image, *output);
    auto bytes = encoded(std::move(output), spec, image.samples().data(), sizeof(Rgba8));
    return bytes ? with_checksum(std::move(*bytes)) : std::move(bytes);
}

Image resized(const Image& picture, int width) {
    const double scale = static_cast<double>(width) / picture.cols();
    Image result(width, std::max(1, static_cast<int>(std::lround(picture.rows() * scale))));
    const OIIO::ImageSpec from(picture.cols(), picture.rows(), 4, OIIO::TypeDesc::UINT8);
    const OIIO::ImageSpec to(result.cols(), result.rows(), 4, OIIO::TypeDesc::UINT8);
    // OpenImageIO only reads from this pointer.
    const OIIO::ImageBuf source(from, const_cast<Rgba8*>(picture.samples().data()));
    OIIO::ImageBuf target(to, result.samples().data());
    OIIO::ImageBufAlgo::resize(target, source);
    return result;
}

void paste(const Image& picture, int col, int row, Image& sheet) {
    for (int i = 0; i < picture.rows(); ++i) {
        const auto from = picture.row(i);
        std::copy(from.begin(), from.end(), sheet.row(row + i).begin() + col);
    }
}

} // namespace

Result<Image> read_image(const fs::path& path) {
    return read_picture<Image>(
        path, [&](OIIO::ImageInput& input) { return read_open_image(input, path); });
}

bool shows_damage(const fs::path& path) {
    const auto output = output_for(path);
    return output != nullptr && (is_of_format(*output, "png") || gets_checksum(*output));
}

Result<Image> read_undamaged_image(const fs::path& path) {
    const auto output = output_for(path);
    if (output != nullptr && gets_checksum(*output)) {
        const auto text = read_text_file(path, max_picture_bytes);
        if (!text) {
            return text.error();
        }
        if (!has_right_checksum(std::as_bytes(std::span(*text)))) {
            return Error{fmt::format("{}: has changed since it was written, or was not written by "
                                     "reljef, a picture with its checksum was expected",
                                     path.string())};
        }
    }
    return read_image(path);
}

Result<void> check_image_name(const fs::path& path) {
    return output_for(path) != nullptr ? Result<void>() : unknown_format(path);
}

Result<AtomicFile> prepare_image(const fs::path& path, const Image& image) {
    auto output = output_for(path, image);
    if (!output) {
        return output.error();
    }
    const auto bytes = encoded_picture(std::move(*output), image);
    return bytes ? prepare_file(path, *bytes)
                 : Error{fmt::format("{}: cannot be written: {}", path.string(),
                                     bytes.error().message)};
}

Result<void> write_image(const fs::path& path, const Image& image) {
    auto file = prepare_image(path, image);
    return file ? file->commit() : file.error();
}

Result<std::vector<std::byte>> encode_image(const std::string& extension, const Image& image) {
    const fs::path path = "a picture in memory" + extension;
    auto output = output_for(path, image);
    if (!output) {
        return output.error();
    }
    return encoded_picture(std::move(*output), image);
}

Image contact_sheet(std::span<const Image> pictures, int columns, int width) {
    check(columns > 0 && width > 0, "contact_sheet needs columns and a width");
    std::vector<Image> small;
    int height = 0;
    for (const Image& picture : pictures) {
        check(!picture.empty(), "contact_sheet of an empty picture");
        small.push_back(resized(picture, width));
        height = std::max(height, small.back().rows());
    }
    if (small.empty()) {
        return {};
    }
    const int count = static_cast<int>(small.size());
    const int across = std::min(columns, count);
    const int down = (count + columns - 1) / columns;
    Image sheet(sheet_gap + across * (width + sheet_gap), sheet_gap + down * (height + sheet_gap),
                sheet_background);
    for (int i = 0; i < count; ++i) {
        paste(small[static_cast<std::size_t>(i)], sheet_gap + (i % columns) * (width + sheet_gap),
              sheet_gap + (i / columns) * (height + sheet_gap), sheet);
    }
    return sheet;
}

} // namespace reljef::io
