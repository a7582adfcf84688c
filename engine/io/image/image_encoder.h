#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include <OpenImageIO/imageio.h>

#include "engine/core/atomic_file.h"
#include "engine/core/result.h"

namespace reljef::io {

/// Encodes pixels of `spec`'s type, `stride` bytes apart. Fails with the encoder's reason.
Result<std::vector<std::byte>> encoded(std::unique_ptr<OIIO::ImageOutput> output,
                                       const OIIO::ImageSpec& spec, const void* pixels,
                                       std::size_t stride);

/// A file with encoded(), ready for commit(). On a full disk, encoders report nothing or exit.
Result<AtomicFile> prepare_encoded(std::unique_ptr<OIIO::ImageOutput> output,
                                   const OIIO::ImageSpec& spec, const void* pixels,
                                   std::size_t stride, const std::filesystem::path& path);

} // namespace reljef::io
