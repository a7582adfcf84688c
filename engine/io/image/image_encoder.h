#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/io/codec/picture_codec.h"

namespace reljef::io {

/// An encoder for `format`, a name of a format or a file's. Errors begin with the path.
Result<std::unique_ptr<PictureOutput>> create_output(const std::filesystem::path& path,
                                                     const std::string& format);

/// Encodes a picture. Fails with the encoder's reason. Full disks are no matter: on them, encoders
/// report nothing or exit.
Result<std::vector<std::byte>> encoded(std::unique_ptr<PictureOutput> output,
                                       const PictureSpec& spec, const PicturePixels& pixels);

} // namespace reljef::io
