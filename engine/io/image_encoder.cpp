#include "engine/io/image_encoder.h"

#include <exception>

#include <fmt/format.h>

#include "engine/core/atomic_file.h"
#include "engine/core/memory_file.h"

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

Result<void> write_encoded(std::unique_ptr<OIIO::ImageOutput> output, const OIIO::ImageSpec& spec,
                           const void* pixels, std::size_t stride,
                           const std::filesystem::path& path) {
    const auto failed = [&](const std::string& why) {
        return Error{fmt::format("{}: cannot be written: {}", path.string(), why)};
    };
    const auto file = MemoryFile::create();
    if (!file) {
        return failed(file.error().message);
    }
    try {
        if (!encode(*output, spec, pixels, stride, *file)) {
            return failed(output->geterror());
        }
    } catch (const std::exception& problem) {
        return failed(problem.what());
    }
    output.reset(); // what it held back is written now
    const auto bytes = file->bytes();
    if (!bytes) {
        return failed(bytes.error().message);
    }
    return bytes->empty() ? failed("its encoder wrote nothing") : write_file(path, *bytes);
}

} // namespace reljef::io
