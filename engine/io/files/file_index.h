#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "engine/geo/georeference.h"

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
    int crs = 0;                     ///< index into FileIndex::crs
    std::string format;
    std::string type;
    std::string vertical_datum;
    bool declares_voids = false;

    friend bool operator==(const IndexedFile&, const IndexedFile&) = default;
};

struct FileIndex {
    std::vector<std::string> crs;    ///< distinct WKTs
    std::vector<IndexedFile> files;  ///< sorted by path
    bool is_spacing_assumed = false; ///< of a single raster, see Place

    friend bool operator==(const FileIndex&, const FileIndex&) = default;
};

struct FileIndexOptions {
    std::filesystem::path cache_folder; ///< for indexes of folders; empty: no cache
    unsigned threads = 0;               ///< 0: one per hardware thread
    bool allows_planes = false;         ///< as in TileSetOptions
    std::optional<double> spacing;      ///< of such a raster, metres; see RasterOptions
    std::stop_token stop;
};

/// Indexes all rasters below a folder, or one raster file, which may lie on a plane if the options
/// allow it; then the notes of place_of() are added. Uses the cache for unchanged files, if it is
/// right for the few of them that are opened; a hash of the cache's content chooses them. Adds a
/// note on an unusable cache. Fails if the folder cannot be read.
Result<FileIndex> index_files(const std::filesystem::path& path, const FileIndexOptions& options,
                              std::vector<std::string>& notes);

/// Serializes an index with a version and a checksum.
std::string bytes_of(const FileIndex& index);
/// Fails for another version, damaged bytes, and values out of their range.
Result<FileIndex> index_from_bytes(std::string_view bytes);

} // namespace reljef::io
