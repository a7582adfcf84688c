#pragma once

#include <atomic>
#include <map>

#include "engine/io/dataset_pool.h"
#include "engine/io/raster/ascii_grid.h"
#include "engine/io/tile_layer.h"
#include "engine/io/tile_set.h"

namespace reljef::io {

/// Of a sample: what coordinates of millions of metres lose by rounding.
inline constexpr double near_sample = 1e-6;

/// What a tile set knows; never changed once it is open.
struct TileSet::State {
    std::string name;
    std::filesystem::path folder; ///< the files' paths begin here; empty for a single raster
    TileSetOptions options;
    std::vector<IndexedFile> indexed;
    std::vector<std::string> indexed_crs; ///< WKT, by IndexedFile::crs
    std::vector<TileLayer> layers;        ///< finest first
    std::vector<TileFile> files;
    std::vector<FileError> errors;
    std::vector<std::string> notes;
    std::string crs; ///< of the grid: WKT, or WGS 84
    std::string crs_name;
    std::string vertical_datum; ///< empty where the tiles differ
    TileGrid grid;
    DegreeBox box{}; ///< around all tiles
    mutable std::atomic<std::size_t> bytes_read{0};
    mutable WholeRasters whole;
    mutable DatasetPool pool{
        [this](const std::filesystem::path& path, const GdalMessages& messages) {
            return open_raster_of_set(path, messages);
        }};
    mutable FailingFiles failing; ///< what a server does not give is not asked for by every tile
    mutable NewNotes new_notes;

    [[nodiscard]] TileContent reading(const std::stop_token& stop) const;
    /// With a note where its overviews are of no use.
    [[nodiscard]] Result<Dataset> open_raster_of_set(const std::filesystem::path& path,
                                                     const GdalMessages& messages) const;
};

/// Of the samples of a grid.
inline geo::PixelAffine affine_of(const TileGrid& grid) {
    return {grid.first.x, grid.step.x, 0.0, grid.first.y, 0.0, grid.step.y};
}

/// Sorted by file, of each file the first.
void keep_each_once(std::vector<FileError>& errors);

} // namespace reljef::io
