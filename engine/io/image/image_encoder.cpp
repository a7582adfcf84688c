#include "engine/io/image/image_encoder.h"

#include <exception>
#include <utility>

#include <fmt/format.h>

#include "engine/core/atomic_file.h"
#include "engine/core/memory_file.h"
#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {
namespace {

// True when all of it was taken.
bool encode(OIIO::ImageOutput& output, const OIIO::ImageSpec& spec, const void* pixels,
            std::size_t stride, const MemoryFile& file) {
    return output.open(file.path().string(), spec) &&
           output.write_image(spec.format, pixels, static_cast<OIIO::stride_t>(stride)) &&
           output.close();
}

} // namespace

Result<std::vector<std::byte>> encoded(std::unique_ptr<OIIO::ImageOutput> output,
                                       const OIIO::ImageSpec& spec, const void* pixels,
                                       std::size_t stride) {
    const auto file = MemoryFile::create();
    if (!file) {
        return file.error();
    }
    const GdalMessages unprinted; // the TIFF library tells GDAL of tags that it does not know
    try {
        if (!encode(*output, spec, pixels, stride, *file)) {
            return Error{output->geterror()};
        }
    } catch (const std::exception& problem) {
        return Error{problem.what()};
    }
    output.reset(); // what it held back is written now
    auto bytes = file->bytes();
    return bytes && bytes->empty() ? Error{"its encoder wrote nothing"} : std::move(bytes);
}

Result<void> write_encoded(std::unique_ptr<OIIO::ImageOutput> output, const OIIO::ImageSpec& spec,
                           const void* pixels, std::size_t stride,
                           const std::filesystem::path& path) {
    const auto bytes = encoded(std::move(output), spec, pixels, stride);
    return bytes ? write_file(path, *bytes)
                 : Error{fmt::format("{}: cannot be written: {}", path.string(),
                                     bytes.error().message)};
}

} // namespace reljef::io
