#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "engine/geo/georeference.h"
#include "engine/io/tile_set.h"

namespace reljef::io {

enum class FileKind : std::uint8_t { heights, picture, error };

struct IndexedFile {
    std::string path;               ///< relative to the folder, with '/'
    std::uint64_t bytes = 0;        ///< this and the next two detect changes
    std::int64_t modified = 0;      ///< ticks of the file system's clock
    std::uint64_t sidecar_hash = 0; ///< checksum of its sidecar files' names, sizes and times
    bool opened = false;            ///< false: try again next time
    FileKind use = FileKind::error;
    std::string error; ///< why it cannot be used
    int cols = 0;
    int rows = 0;
    geo::PixelAffine crs_from_pixel; ///< (0,0) is the outer corner
    int crs = 0;                     ///< index into TileIndex::crs
    std::string format;
    std::string type;
    std::string vertical_datum;
    bool declares_voids = false;

    friend bool operator==(const IndexedFile&, const IndexedFile&) = default;
};

struct TileIndex {
    std::vector<std::string> crs;   ///< distinct WKTs
    std::vector<IndexedFile> files; ///< sorted by path

    friend bool operator==(const TileIndex&, const TileIndex&) = default;
};

/// Indexes all rasters below a folder, or one raster file. Uses the cache for unchanged files, if
/// it is right for the few of them that are opened; a hash of the cache's content chooses them.
/// Adds a note on an unusable cache. Fails if the folder cannot be read.
Result<TileIndex> index_tiles(const std::filesystem::path& path, const TileSetOptions& options,
                              std::vector<std::string>& notes);

/// Serializes an index with a version and a checksum.
std::string bytes_of(const TileIndex& index);
/// Fails for another version, damaged bytes, and values out of their range.
Result<TileIndex> index_from_bytes(std::string_view bytes);

} // namespace reljef::io
