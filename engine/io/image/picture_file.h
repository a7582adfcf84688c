#pragma once

#include <exception>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "engine/core/result.h"
#include "engine/io/codec/picture_codec.h"
#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {

/// Fails unless the path is a file, not empty, and no truncated or refused PNG (check_png): libpng
/// would print errors.
Result<void> check_image_file(const std::filesystem::path& path);

/// Fails if the size in a picture's header is impossible for its file size or exceeds the limits.
Result<void> check_image_size(const std::filesystem::path& path, const PictureHeader& header);

/// A picture of a format that picture_format() knows and of a possible size. Errors name what was
/// `expected`.
Result<std::unique_ptr<PictureInput>> open_picture(const std::filesystem::path& path,
                                                   const char* expected);

/// Opens a picture and returns `read(input)`.
template <class T, class Read>
Result<T> read_picture(const std::filesystem::path& path, const Read& read,
                       const char* expected = "a picture") {
    const GdalMessages unprinted; // libtiff's handlers are GDAL's
    try {
        const auto input = open_picture(path, expected);
        return input ? read(**input) : Result<T>(input.error());
    } catch (const std::exception& problem) {
        return Error{fmt::format("{}: cannot be read ({}), {} was expected", path.string(),
                                 problem.what(), expected)};
    }
}

} // namespace reljef::io
