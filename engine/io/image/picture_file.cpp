#include "engine/io/image/picture_file.h"

#include <algorithm>
#include <system_error>

#include "engine/io/checks/exr_bytes.h"
#include "engine/io/checks/jpeg2000_bytes.h"
#include "engine/io/checks/picture_bytes.h"

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

Result<void> check_image_size(const fs::path& path, const OIIO::ImageSpec& spec) {
    std::error_code code;
    const double bytes = static_cast<double>(fs::file_size(path, code));
    const double pixels = static_cast<double>(spec.width) * spec.height;
    const double max_allowed =
        std::min(max_pixels, std::max(always_allowed, bytes * pixels_per_byte));
    const bool good = spec.width > 0 && spec.height > 0 && spec.width <= max_side &&
                      spec.height <= max_side && spec.depth <= 1 && spec.nchannels > 0 &&
                      pixels <= max_allowed;
    if (!good) {
        return Error{fmt::format(
            "{}: claims {}×{} pixels of {} channels in {} bytes, at most {:.0f} "
            "pixels were expected",
            path.string(), spec.width, spec.height, spec.nchannels, bytes, max_allowed)};
    }
    // A tile may be larger than the picture.
    const double stored = std::max(pixels, static_cast<double>(spec.tile_width) * spec.tile_height *
                                               std::max(spec.tile_depth, 1));
    const double decoded = stored * static_cast<double>(spec.pixel_bytes(true));
    if (decoded > max_bytes) {
        return Error{fmt::format("{}: claims {}×{} pixels of {} channels, which take {:.1f} GB, at "
                                 "most {:.1f} GB were expected",
                                 path.string(), spec.width, spec.height, spec.nchannels,
                                 decoded / 1e9, max_bytes / 1e9)};
    }
    return {};
}

} // namespace reljef::io
