#pragma once

#include <filesystem>
#include <memory>

#include <glm/vec2.hpp>

#include "engine/core/atomic_file.h"
#include "engine/core/color.h"
#include "engine/core/result.h"

namespace reljef::io {

/// Whether PictureWriter writes the format of a name: .png, .tif or .tiff.
bool is_written_in_bands(const std::filesystem::path& path);

/// Writes an opaque picture from the top, some rows at a time, and keeps none of them: a PNG, or a
/// TIFF of tiles, BigTIFF if it may exceed 4 GB.
class PictureWriter {
public:
    /// Of a TIFF, all calls of write() but the last have a multiple of its tiles' rows.
    static constexpr glm::ivec2 tile{256, 64};

    /// Fails for other formats, for sizes that a format cannot hold, and as AtomicFile::create().
    static Result<PictureWriter> create(const std::filesystem::path& path, glm::ivec2 size);

    PictureWriter(PictureWriter&& other) noexcept;
    PictureWriter& operator=(PictureWriter&& other) noexcept;
    ~PictureWriter(); ///< removes an unfinished file

    /// The next rows. Precondition: as wide as the picture, and no more rows than are left.
    Result<void> write(const Image& rows);
    /// The file, ready for commit(). Precondition: all rows are written.
    Result<AtomicFile> finish();

    class Encoder;

private:
    explicit PictureWriter(std::unique_ptr<Encoder> encoder);

    std::unique_ptr<Encoder> encoder_;
};

} // namespace reljef::io
