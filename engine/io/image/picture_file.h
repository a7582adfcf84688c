#pragma once

#include <exception>
#include <filesystem>

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "engine/core/result.h"
#include "engine/io/checks/picture_format.h"

namespace reljef::io {

/// Fails unless the path is a file, not empty, and no truncated or refused PNG (check_png): libpng
/// would print errors.
Result<void> check_image_file(const std::filesystem::path& path);

/// Fails if the size in a picture's header is impossible for its file size or exceeds the limits.
Result<void> check_image_size(const std::filesystem::path& path, const OIIO::ImageSpec& spec);

/// Opens a picture with OpenImageIO, unassociated alpha, and returns `read(input)`. Errors name
/// what was `expected`.
template <class T, class Read>
Result<T> read_picture(const std::filesystem::path& path, const Read& read,
                       const char* expected = "a picture") {
    if (auto file = check_image_file(path); !file) {
        return file.error();
    }
    try {
        OIIO::ImageSpec desired;
        desired.attribute("oiio:UnassociatedAlpha", 1);
        const auto format = picture_format(path.string());
        if (!format) {
            return format.error();
        }
        const auto input = OIIO::ImageInput::create(*format);
        OIIO::ImageSpec found;
        if (input == nullptr || !input->open(path.string(), found, desired)) {
            return Error{fmt::format("{}: cannot be read ({}), {} was expected", path.string(),
                                     input == nullptr ? OIIO::geterror() : input->geterror(),
                                     expected)};
        }
        const auto size = check_image_size(path, input->spec());
        return size ? read(*input) : Result<T>(size.error());
    } catch (const std::exception& problem) {
        return Error{fmt::format("{}: cannot be read ({}), {} was expected", path.string(),
                                 problem.what(), expected)};
    }
}

} // namespace reljef::io
