#pragma once

#include <exception>
#include <filesystem>

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "engine/core/result.h"
#include "engine/io/image/image_limits.h"

namespace reljef::io {

/// What `read(input)` makes of a picture that OpenImageIO opens, alpha as it is stored. Fails where
/// there is no such file or it is no picture, and as `read` does.
template <class T, class Read>
Result<T> read_picture(const std::filesystem::path& path, const Read& read) {
    if (auto file = check_image_file(path); !file) {
        return file.error();
    }
    try {
        OIIO::ImageSpec desired;
        desired.attribute("oiio:UnassociatedAlpha", 1);
        const auto input = OIIO::ImageInput::open(path.string(), &desired);
        if (input == nullptr) {
            return Error{fmt::format("{}: cannot be read ({}), a picture was expected",
                                     path.string(), OIIO::geterror())};
        }
        return read(*input);
    } catch (const std::exception& problem) {
        return Error{fmt::format("{}: cannot be read ({}), a picture was expected", path.string(),
                                 problem.what())};
    }
}

} // namespace reljef::io
