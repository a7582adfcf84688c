#include "engine/io/image/image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "engine/io/checks/lowercase.h"
#include "engine/io/image/image_encoder.h"
#include "engine/io/image/picture_checksum.h"
#include "engine/io/image/picture_file.h"
#include "engine/io/image/picture_module.h"
#include "engine/io/image/png_stream.h"

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

Result<Image> read_open_image(PictureInput& input, const fs::path& path) {
    const PictureHeader& header = input.header();
    Image image(header.cols, header.rows);
    const bool linear = header.has_floats;
    const int channels = std::min(header.channels(), 4);
    const std::size_t row_values =
        static_cast<std::size_t>(header.cols) * static_cast<std::size_t>(channels);
    const int step =
        std::min(header.tile_cols > 0 ? header.tile_rows : rows_at_a_time, header.rows);
    std::vector<float> values(row_values * static_cast<std::size_t>(step));
    for (int begin = 0; begin < header.rows; begin += step) {
        const int end = std::min(begin + step, header.rows);
        const auto rows = static_cast<std::size_t>(end - begin);
        if (!input.read_rows(begin, channels, std::span(values).first(rows * row_values))) {
            return Error{
                fmt::format("{}: cannot be read at row {} ({}), a whole picture was expected",
                            path.string(), begin, input.error())};
        }
        for (int row = begin; row < end; ++row) {
            const auto first = static_cast<std::size_t>(row - begin) * row_values;
            store_row(std::span(values).subspan(first, row_values), channels, linear,
                      image.row(row));
        }
    }
    return image;
}

Error not_written(const fs::path& path, const Error& why) {
    return {fmt::format("{}: cannot be written: {}", path.string(), why.message)};
}

Error unknown_format(const fs::path& path) {
    return {fmt::format("{}: cannot be written: {:?} names no format of pictures, .png or .jpg "
                        "was expected",
                        path.string(), path.extension().string())};
}

// By a file's extension.
Result<std::unique_ptr<PictureOutput>> output_for(const fs::path& path) {
    const auto codec = picture_codec();
    if (!codec) {
        return not_written(path, codec.error());
    }
    auto output = (*codec)->create_output(path.string());
    // The JPEG 2000 encoder needs a file extension; files in memory have none.
    if (output == nullptr || output->format() == "jpeg2000") {
        return unknown_format(path);
    }
    return output;
}

// The formats that OpenImageIO always writes, by its extensions. What needs only these names does
// not load it.
std::string_view common_format(const fs::path& path) {
    struct Extension {
        std::string_view text;
        std::string_view format;
    };
    constexpr std::array<Extension, 13> extensions{{{".png", "png"},
                                                    {".jpg", "jpeg"},
                                                    {".jpeg", "jpeg"},
                                                    {".jpe", "jpeg"},
                                                    {".jif", "jpeg"},
                                                    {".jfif", "jpeg"},
                                                    {".jfi", "jpeg"},
                                                    {".tif", "tiff"},
                                                    {".tiff", "tiff"},
                                                    {".tx", "tiff"},
                                                    {".env", "tiff"},
                                                    {".sm", "tiff"},
                                                    {".vsm", "tiff"}}};
    const std::string extension = extension_of(path);
    const auto* const found =
        std::find_if(extensions.begin(), extensions.end(),
                     [&](const Extension& of) { return of.text == extension; });
    return found != extensions.end() ? found->format : "";
}

// Formats whose pictures have a checksum of ours. PNG has its own.
bool gets_checksum(std::string_view format) {
    return format == "jpeg" || format == "tiff";
}

// OpenImageIO would write JPEG in a TIFF, too, which loses colours, and the time, which makes equal
// pictures differ; blanks are an unknown time (Exif 2.3, DateTime).
PictureSpec spec_of(const Image& image, std::string_view format) {
    PictureSpec spec{image.cols(), image.rows(), 3};
    spec.texts = {{"oiio:ColorSpace", "sRGB"},
                  {"Compression", format == "jpeg" ? fmt::format("jpeg:{}", jpeg_quality) : "zip"}};
    if (format == "tiff") {
        spec.texts.emplace_back("DateTime", "    :  :     :  :  ");
    }
    if (gets_checksum(format)) {
        spec.texts.emplace_back("ImageDescription", checksum_text);
    }
    return spec;
}

Result<std::vector<std::byte>> encoded_picture(std::unique_ptr<PictureOutput> output,
                                               const Image& image) {
    const PictureSpec spec = spec_of(image, output->format());
    auto bytes = encoded(std::move(output), spec, {image.samples().data(), sizeof(Rgba8)});
    return bytes ? with_checksum(std::move(*bytes)) : std::move(bytes);
}

Result<std::vector<std::byte>> encoded_png(const Image& image) {
    std::vector<std::byte> bytes;
    PngStream stream({image.cols(), image.rows()}, [&](std::span<const std::byte> part) {
        bytes.insert(bytes.end(), part.begin(), part.end());
        return true;
    });
    if (!stream.write(image) || !stream.end()) {
        return Error{stream.error()};
    }
    return bytes;
}

Result<std::vector<std::byte>> encoded_as(const fs::path& path, const Image& image) {
    if (image.empty()) {
        return Error{fmt::format("{}: cannot be written: a picture of {}×{} pixels was given, at "
                                 "least 1×1 was expected",
                                 path.string(), image.cols(), image.rows())};
    }
    if (common_format(path) == "png") {
        auto bytes = encoded_png(image);
        return bytes ? std::move(bytes) : not_written(path, bytes.error());
    }
    auto output = output_for(path);
    if (!output) {
        return output.error();
    }
    auto bytes = encoded_picture(std::move(*output), image);
    return bytes ? std::move(bytes) : not_written(path, bytes.error());
}

Image resized(PictureCodec& codec, const Image& picture, int width) {
    const double scale = static_cast<double>(width) / picture.cols();
    Image result(width, std::max(1, static_cast<int>(std::lround(picture.rows() * scale))));
    // OpenImageIO only reads from the first pointer.
    codec.resize({picture.cols(), picture.rows(), const_cast<Rgba8*>(picture.samples().data())},
                 {result.cols(), result.rows(), result.samples().data()});
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
    return read_picture<Image>(path,
                               [&](PictureInput& input) { return read_open_image(input, path); });
}

bool shows_damage(const fs::path& path) {
    return !common_format(path).empty();
}

Result<Image> read_undamaged_image(const fs::path& path) {
    if (gets_checksum(common_format(path))) {
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
    const std::string_view format = common_format(path);
    if (format == "png") {
        return {};
    }
    if (!format.empty()) {
        const auto found = find_picture_module();
        return found ? found : not_written(path, found.error());
    }
    const auto output = output_for(path);
    return output ? Result<void>() : output.error();
}

Result<void> check_sheet_name(const fs::path& path) {
    const auto found = find_picture_module();
    return found ? check_image_name(path) : not_written(path, found.error());
}

Result<AtomicFile> prepare_image(const fs::path& path, const Image& image) {
    const auto bytes = encoded_as(path, image);
    return bytes ? prepare_file(path, *bytes) : bytes.error();
}

Result<void> write_image(const fs::path& path, const Image& image) {
    auto file = prepare_image(path, image);
    return file ? file->commit() : file.error();
}

Result<std::vector<std::byte>> encode_image(const std::string& extension, const Image& image) {
    return encoded_as("a picture in memory" + extension, image);
}

Result<Image> contact_sheet(std::span<const Image> pictures, int columns, int width) {
    check(columns > 0 && width > 0, "contact_sheet needs columns and a width");
    const auto codec = picture_codec();
    if (!codec) {
        return codec.error();
    }
    std::vector<Image> small;
    int height = 0;
    for (const Image& picture : pictures) {
        check(!picture.empty(), "contact_sheet of an empty picture");
        small.push_back(resized(**codec, picture, width));
        height = std::max(height, small.back().rows());
    }
    if (small.empty()) {
        return Image();
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
