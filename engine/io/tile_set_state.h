#pragma once

#include <atomic>

#include "engine/io/files/dataset_pool.h"
#include "engine/io/raster/ascii_grid.h"
#include "engine/io/tile_layer.h"
#include "engine/io/tile_set.h"

namespace reljef::io {

/// Samples: rounding error of coordinates of millions of metres.
inline constexpr double near_sample = 1e-6;

/// Constant after open(), except for the mutable members.
struct TileSet::State {
    std::string name;
    std::filesystem::path folder; ///< base of the files' paths; empty for a single raster
    TileSetOptions options;
    std::vector<IndexedFile> indexed;
    std::vector<std::string> indexed_crs; ///< WKT, by IndexedFile::crs
    std::vector<TileLayer> layers;        ///< finest first
    std::vector<TileFile> files;
    std::vector<FileError> errors;
    std::vector<std::string> notes;
    std::string crs; ///< of the grid: WKT or wgs84_degrees
    std::string crs_name;
    std::string vertical_datum; ///< empty if the files differ
    TileGrid grid;
    DegreeBox box{}; ///< around all tiles
    bool is_on_plane = false;
    bool is_spacing_assumed = false; ///< see Place
    mutable WholeRasters whole;
    mutable DatasetPool pool{
        [this](const std::filesystem::path& path, const GdalMessages& messages) {
            return open_raster_of_set(path, messages);
        }};
    mutable FailingFiles failing; ///< remote files
    mutable NewNotes new_notes;

    /// `bytes_read` counts the bytes of samples.
    [[nodiscard]] LayerReading reading(std::atomic<std::size_t>& bytes_read,
                                       const std::stop_token& stop) const;
    /// Adds a note if the overviews are unusable.
    [[nodiscard]] Result<Dataset> open_raster_of_set(const std::filesystem::path& path,
                                                     const GdalMessages& messages) const;
};

/// What index_files() needs of them.
inline FileIndexOptions files_of(const TileSetOptions& options) {
    return {options.cache_folder, options.threads, options.allows_planes, options.spacing,
            options.stop};
}

/// Sorts by file and keeps the first error of each file.
void keep_each_once(std::vector<FileError>& errors);

} // namespace reljef::io
