#pragma once

#include <filesystem>

#include "engine/core/result.h"
#include "engine/io/codec/picture_codec.h"

namespace reljef::io {

/// What reads and writes pictures. The first call loads the module, which takes 0.2 s. Fails if it
/// is missing or that of another build; the next call tries again. Thread-safe.
Result<PictureCodec*> picture_codec();

/// Of one file, which is never unloaded.
Result<PictureCodec*> load_picture_codec(const std::filesystem::path& module);

/// Fails if there is no module: quicker than to load it.
Result<void> find_picture_module();

} // namespace reljef::io
