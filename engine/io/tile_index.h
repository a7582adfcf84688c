#pragma once

#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "engine/geo/georeference.h"
#include "engine/io/tile_set.h"

namespace reljef::io {

/// What a file of a folder is for: heights, a picture, neither, or heights that cannot be used.
enum class TileUse : std::uint8_t { heights, picture, fault };

/// What the index keeps of one file.
struct IndexedFile {
    std::string path;          ///< below the folder, with '/'
    std::uint64_t bytes = 0;   ///< with the next two: to see whether the file is still the same
    std::int64_t modified = 0; ///< ticks of the file system's clock
    std::uint64_t beside = 0;  ///< checksum of the names, sizes and times of its side files
    bool opened = false;       ///< what could not be opened is tried again each time
    TileUse use = TileUse::fault;
    std::string fault; ///< one sentence: why it cannot be used
    int cols = 0;
    int rows = 0;
    geo::PixelAffine crs_from_pixel; ///< GDAL's pixels: (0,0) is the outer corner
    int crs = 0;                     ///< index into TileIndex::crs
    std::string format;
    std::string type;
    std::string vertical_datum;
    bool declares_voids = false;

    friend bool operator==(const IndexedFile&, const IndexedFile&) = default;
};

struct TileIndex {
    std::vector<std::string> crs;   ///< WKT of the horizontal coordinate systems, each once
    std::vector<IndexedFile> files; ///< by path

    friend bool operator==(const TileIndex&, const TileIndex&) = default;
};

/// The rasters of a folder and of the folders in it, from the cache where a file is the same as it
/// was; or the one raster that `path` names. Adds notes on a cache that was of no use. Fails where
/// the folder cannot be read or holds no raster; a file that cannot be used is a fault in the
/// index.
Result<TileIndex> index_tiles(const std::filesystem::path& path, const TileSetOptions& options,
                              std::vector<std::string>& notes);

/// An index as bytes, with a version and a checksum.
std::string bytes_of(const TileIndex& index);
/// Fails, with what is wrong, for bytes of another version, cut or changed.
Result<TileIndex> index_from_bytes(std::string_view bytes);

} // namespace reljef::io
