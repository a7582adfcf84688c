#include "engine/io/image/picture_file.h"

#include <algorithm>
#include <string>
#include <system_error>

#include "engine/io/checks/exr_bytes.h"
#include "engine/io/checks/jpeg2000_bytes.h"
#include "engine/io/checks/picture_bytes.h"
#include "engine/io/checks/picture_format.h"
#include "engine/io/image/picture_module.h"

namespace reljef::io {
namespace fs = std::filesystem;
namespace {

constexpr int max_side = 1 << 16;
constexpr double max_pixels = 1 << 28;
constexpr double always_allowed = 1 << 24; // pixels
constexpr double pixels_per_byte = 2000.0; // above the densest format
constexpr double max_bytes = 1 << 30;      // max_pixels of RGBA; decoders keep as much at once

} // namespace

Result<void> check_image_file(const fs::path& path) {
    std::error_code code;
    const fs::file_status status = fs::status(path, code);
    if (!fs::exists(status)) {
        return Error{fmt::format("{}: does not exist, a picture was expected", path.string())};
    }
    if (!fs::is_regular_file(status)) {
        return Error{fmt::format("{}: is no file, a picture was expected", path.string())};
    }
    if (fs::file_size(path, code) == 0) {
        return Error{fmt::format("{}: is empty, a picture was expected", path.string())};
    }
    auto good = check_exr(path.string());
    good = good ? check_jpeg2000(path.string()) : good;
    return good ? check_png(path.string(), PngPart::whole) : good;
}

Result<void> check_image_size(const fs::path& path, const PictureHeader& header) {
    std::error_code code;
    const double bytes = static_cast<double>(fs::file_size(path, code));
    const double pixels = static_cast<double>(header.cols) * header.rows;
    const double max_allowed =
        std::min(max_pixels, std::max(always_allowed, bytes * pixels_per_byte));
    const bool good = header.cols > 0 && header.rows > 0 && header.cols <= max_side &&
                      header.rows <= max_side && header.depth <= 1 && header.channels() > 0 &&
                      pixels <= max_allowed;
    if (!good) {
        return Error{fmt::format(
            "{}: claims {}×{} pixels of {} channels in {} bytes, at most {:.0f} "
            "pixels were expected",
            path.string(), header.cols, header.rows, header.channels(), bytes, max_allowed)};
    }
    // A tile may be larger than the picture.
    const double stored = std::max(pixels, static_cast<double>(header.tile_cols) *
                                               header.tile_rows * std::max(header.tile_depth, 1));
    const double decoded = stored * header.pixel_bytes;
    if (decoded > max_bytes) {
        return Error{fmt::format("{}: claims {}×{} pixels of {} channels, which take {:.1f} GB, at "
                                 "most {:.1f} GB were expected",
                                 path.string(), header.cols, header.rows, header.channels(),
                                 decoded / 1e9, max_bytes / 1e9)};
    }
    return {};
}

namespace {

/// Of formats whose readers allocate a whole picture when they open it.
Result<void> check_claimed_size(const fs::path& path) {
    const auto size = claimed_size(path.string());
    if (!size) {
        return {};
    }
    PictureHeader header;
    header.cols = size->x;
    header.rows = size->y;
    header.channel_names.resize(4);
    header.pixel_bytes = 4.0;
    return check_image_size(path, header);
}

} // namespace

Result<std::unique_ptr<PictureInput>> open_picture(const fs::path& path, const char* expected) {
    if (auto file = check_image_file(path); !file) {
        return file.error();
    }
    if (auto size = check_claimed_size(path); !size) {
        return size.error();
    }
    const auto format = picture_format(path.string());
    if (!format) {
        return format.error();
    }
    const auto codec = picture_codec();
    if (!codec) {
        return Error{fmt::format("{}: cannot be read: {}", path.string(), codec.error().message)};
    }
    auto opened = (*codec)->open(*format, path.string());
    if (opened.input == nullptr) {
        return Error{fmt::format("{}: cannot be read ({}), {} was expected", path.string(),
                                 opened.error, expected)};
    }
    if (auto size = check_image_size(path, opened.input->header()); !size) {
        return size.error();
    }
    return std::move(opened.input);
}

} // namespace reljef::io
