#include "engine/io/image/image_encoder.h"

#include <exception>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "engine/core/memory_file.h"
#include "engine/io/image/picture_module.h"
#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {
namespace {

using EncodedBytes = Result<std::vector<std::byte>>;

EncodedBytes encoded_in_memory(PictureOutput& output, const PictureSpec& spec,
                               const PicturePixels& pixels) {
    auto bytes = output.encode(spec, pixels);
    return bytes ? EncodedBytes(std::move(*bytes)) : Error{output.error()};
}

EncodedBytes encoded_in_file(PictureOutput& output, const PictureSpec& spec,
                             const PicturePixels& pixels) {
    const auto file = MemoryFile::create();
    if (!file) {
        return file.error();
    }
    return output.encode_file(spec, pixels, file->path().string()) ? file->bytes()
                                                                   : Error{output.error()};
}

} // namespace

Result<std::unique_ptr<PictureOutput>> create_output(const std::filesystem::path& path,
                                                     const std::string& format) {
    const auto codec = picture_codec();
    if (!codec) {
        return Error{
            fmt::format("{}: cannot be written: {}", path.string(), codec.error().message)};
    }
    auto output = (*codec)->create_output(format);
    if (output == nullptr) {
        return Error{fmt::format("{}: cannot be written: OpenImageIO knows no format {:?}, a name "
                                 "of one was expected",
                                 path.string(), format)};
    }
    return output;
}

EncodedBytes encoded(std::unique_ptr<PictureOutput> output, const PictureSpec& spec,
                     const PicturePixels& pixels) {
    const GdalMessages ignored_messages; // of the TIFF library, about unknown tags, also at the end
    const auto encoder = std::move(output);
    // OpenImageIO 2.4 writes TIFF directories to memory that no reader accepts.
    const bool in_memory =
        encoder->writes_to_memory() && encoder->format() != std::string_view("tiff");
    try {
        auto bytes = in_memory ? encoded_in_memory(*encoder, spec, pixels)
                               : encoded_in_file(*encoder, spec, pixels);
        return bytes && bytes->empty() ? Error{"its encoder wrote nothing"} : std::move(bytes);
    } catch (const std::exception& problem) {
        return Error{problem.what()};
    }
}

} // namespace reljef::io
