#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/core/color.h"
#include "engine/core/hit.h"
#include "engine/core/result.h"

namespace reljef::io {

/// Any picture OpenImageIO opens, as 8-bit sRGB.
Result<Image> read_image(const std::filesystem::path& path);

/// Writes a picture, opaque, whole or not at all; the extension chooses the format (.png, .jpg, …).
Result<void> write_image(const std::filesystem::path& path, const Image& image);

/// The bytes that write_image() would put into a file of that extension (".png", ".jpg", …).
Result<std::vector<std::byte>> encode_image(const std::string& extension, const Image& image);

/// Whether a file of that name can hold a picture, or the hits: by its extension.
Result<void> check_image_name(const std::filesystem::path& path);
Result<void> check_hits_name(const std::filesystem::path& path);

/// Writes float32 channels col, row, height, depth to an OpenEXR file, whole or not at all.
Result<void> write_hits(const std::filesystem::path& path, const HitBuffer& hits);
Result<HitBuffer> read_hits(const std::filesystem::path& path);

/// Small copies of the pictures side by side, `columns` a row, each `width` pixels wide, with a
/// gap.
Image contact_sheet(std::span<const Image> pictures, int columns, int width);

} // namespace reljef::io
