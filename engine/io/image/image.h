#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/core/atomic_file.h"
#include "engine/core/color.h"
#include "engine/core/hit.h"
#include "engine/core/result.h"

namespace reljef::io {

/// Reads any picture of a format that picture_format() knows, as 8-bit sRGB.
Result<Image> read_image(const std::filesystem::path& path);

/// Whether damage to a picture of this name's format shows: .png, .jpg and .tif have checksums.
bool shows_damage(const std::filesystem::path& path);
/// Reads a picture that write_image() wrote. Fails if it is cut or damaged. Precondition:
/// shows_damage().
Result<Image> read_undamaged_image(const std::filesystem::path& path);

/// Writes an opaque picture whole or not at all. The extension selects the format (.png, .jpg, …).
Result<void> write_image(const std::filesystem::path& path, const Image& image);
/// The same, ready for commit().
Result<AtomicFile> prepare_image(const std::filesystem::path& path, const Image& image);

/// Encodes like write_image() for an extension (".png", ".jpg", …).
Result<std::vector<std::byte>> encode_image(const std::string& extension, const Image& image);

/// Fail if the extension is no format of pictures, of hits, or of contact sheets; or if the module
/// that writes them is missing.
Result<void> check_image_name(const std::filesystem::path& path);
Result<void> check_sheet_name(const std::filesystem::path& path);
Result<void> check_hits_name(const std::filesystem::path& path);

/// Writes float32 channels col, row, height, depth, col_low, row_low to an OpenEXR file, whole or
/// not at all.
Result<void> write_hits(const std::filesystem::path& path, const HitBuffer& hits);
/// The same, ready for commit().
Result<AtomicFile> prepare_hits(const std::filesystem::path& path, const HitBuffer& hits);
Result<HitBuffer> read_hits(const std::filesystem::path& path);

/// Thumbnails in rows of `columns`, each `width` pixels wide. Fails without the module of pictures.
Result<Image> contact_sheet(std::span<const Image> pictures, int columns, int width);

} // namespace reljef::io
