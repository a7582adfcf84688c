#include "engine/io/image/image_encoder.h"

#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <OpenImageIO/filesystem.h>
#include <fmt/format.h>

#include "engine/core/atomic_file.h"
#include "engine/core/memory_file.h"
#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {
namespace {

bool encode(OIIO::ImageOutput& output, const OIIO::ImageSpec& spec, const void* pixels,
            std::size_t stride, const std::string& name) {
    return output.open(name, spec) &&
           output.write_image(spec.format, pixels, static_cast<OIIO::stride_t>(stride)) &&
           output.close();
}

Result<std::vector<std::byte>> encoded_in_memory(std::unique_ptr<OIIO::ImageOutput> output,
                                                 const OIIO::ImageSpec& spec, const void* pixels,
                                                 std::size_t stride) {
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    if (!output->set_ioproxy(&memory) ||
        !encode(*output, spec, pixels, stride, output->format_name())) {
        return Error{output->geterror()};
    }
    output.reset(); // flushes
    const auto span = std::as_bytes(std::span(bytes));
    return std::vector<std::byte>(span.begin(), span.end());
}

Result<std::vector<std::byte>> encoded_in_file(std::unique_ptr<OIIO::ImageOutput> output,
                                               const OIIO::ImageSpec& spec, const void* pixels,
                                               std::size_t stride) {
    const auto file = MemoryFile::create();
    if (!file) {
        return file.error();
    }
    if (!encode(*output, spec, pixels, stride, file->path().string())) {
        return Error{output->geterror()};
    }
    output.reset();
    return file->bytes();
}

} // namespace

Result<std::vector<std::byte>> encoded(std::unique_ptr<OIIO::ImageOutput> output,
                                       const OIIO::ImageSpec& spec, const void* pixels,
                                       std::size_t stride) {
    const GdalMessages ignored_messages; // of the TIFF library, about unknown tags
    // OpenImageIO 2.4 writes TIFF directories to memory that no reader accepts.
    const bool in_memory =
        output->supports("ioproxy") != 0 && output->format_name() != std::string_view("tiff");
    try {
        auto bytes = in_memory ? encoded_in_memory(std::move(output), spec, pixels, stride)
                               : encoded_in_file(std::move(output), spec, pixels, stride);
        return bytes && bytes->empty() ? Error{"its encoder wrote nothing"} : std::move(bytes);
    } catch (const std::exception& problem) {
        return Error{problem.what()};
    }
}

Result<AtomicFile> prepare_encoded(std::unique_ptr<OIIO::ImageOutput> output,
                                   const OIIO::ImageSpec& spec, const void* pixels,
                                   std::size_t stride, const std::filesystem::path& path) {
    const auto bytes = encoded(std::move(output), spec, pixels, stride);
    return bytes ? prepare_file(path, *bytes)
                 : Error{fmt::format("{}: cannot be written: {}", path.string(),
                                     bytes.error().message)};
}

} // namespace reljef::io
