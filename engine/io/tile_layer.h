#pragma once

#include <atomic>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/io/files/dataset_pool.h"
#include "engine/io/files/file_index.h"
#include "engine/io/raster/ascii_grid.h"
#include "engine/io/raster/crs_transform.h"
#include "engine/io/raster/raster.h"
#include "engine/io/raster/web_tiles.h"

namespace reljef::io {

/// Bounds of points; ignores NaN.
struct PointBounds {
    glm::dvec2 low{std::numeric_limits<double>::infinity()};
    glm::dvec2 high{-std::numeric_limits<double>::infinity()};

    void add(glm::dvec2 point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
};

/// A tile on its layer's lattice.
struct LayerTile {
    int file = 0; ///< index into the indexed files
    int col = 0;  ///< first sample on the lattice
    int row = 0;
    int cols = 0;
    int rows = 0;
    glm::dvec2 offset{0.0};  ///< of its samples from the lattice points, in steps
    bool is_wrapped = false; ///< a copy 360 degrees away
};

/// Tiles in one CRS with samples on one lattice: one raster with gaps.
struct TileLayer {
    std::string crs;                   ///< WKT
    geo::PixelAffine crs_from_lattice; ///< lattice points are samples; (0,0) is the first
    glm::dmat2 lattice_steps{1.0};     ///< lattice steps per unit of x and y
    int cols = 0;
    int rows = 0;
    glm::dvec2 spacing{1.0};   ///< metres, at the middle
    std::int64_t modified = 0; ///< time of the newest tile
    double period = 0.0;       ///< 360 degrees in units of x; 0: not in degrees
    DegreeBox box{};
    std::vector<LayerTile> tiles; ///< newest first; wrapped ones lie outside [0, cols)

    [[nodiscard]] glm::dvec2 lattice_from_crs(glm::dvec2 point) const {
        return lattice_steps * (point - glm::dvec2(crs_from_lattice.x0, crs_from_lattice.y0));
    }
    /// As lattice_from_crs, modulo 360 degrees.
    [[nodiscard]] glm::dvec2 lattice_from_wrapped(glm::dvec2 point) const;
};

/// Position of a usable file. Multiples of 360 degrees are added to x to keep the set together.
struct PlacedFile {
    int file = 0;                     ///< index into the indexed files
    std::string crs;                  ///< WKT; equal systems have equal text
    geo::PixelAffine crs_from_sample; ///< (0,0) is the centre of the first sample
    glm::dvec2 spacing{1.0};
    DegreeBox box{};
    double period = 0.0;
};

/// The layers of a set: finest first, then newest.
std::vector<TileLayer> layers_of(std::span<const PlacedFile> placed,
                                 std::span<const IndexedFile> files);

/// Cells of `reduction`×`reduction` samples; cell (0,0) starts at lattice point `anchor`.
struct CellWindow {
    int reduction = 1;
    glm::ivec2 anchor{0};
    glm::ivec2 first{0}; ///< first cell
    int cols = 0;
    int rows = 0;

    /// Covers all cells between two cells.
    void set_range(glm::dvec2 low, glm::dvec2 high) {
        first = glm::ivec2(low);
        cols = static_cast<int>(high.x - low.x) + 1;
        rows = static_cast<int>(high.y - low.y) + 1;
    }
    [[nodiscard]] glm::dvec2 cell_from_lattice(glm::dvec2 point) const {
        const double middle = 0.5 * (reduction - 1);
        return (point - glm::dvec2(anchor) - middle) / static_cast<double>(reduction);
    }
};

/// Input of read_cells().
struct LayerReading {
    std::span<const IndexedFile> files;
    std::span<const std::string> crs;               ///< WKT, by IndexedFile::crs
    std::filesystem::path folder;                   ///< base of the files' paths
    RasterOptions options;                          ///< uses scale, offset and stop
    std::atomic<std::size_t>* bytes_read = nullptr; ///< counter
    const WholeRasters* rasters = nullptr;          ///< opened by the pool
    DatasetPool* pool = nullptr;
    FailingFiles* failing = nullptr; ///< remote files
    NewNotes* new_notes = nullptr;   ///< replaced files and voids
};

/// Averages a layer's samples over cells; the newest tile wins; NaN without samples. Adds an error
/// for each unreadable file, or for each unreadable web tile.
Grid<double> read_cells(const TileLayer& layer, const CellWindow& window,
                        const LayerReading& reading, std::vector<FileError>& errors);

/// Placed files of an index. Longitudes are continuous across the antimeridian, so that the set is
/// as narrow as possible. Adds an error for each file without a sane position and scale on Earth.
std::vector<PlacedFile> place_files(const FileIndex& index, const std::filesystem::path& folder,
                                    std::vector<FileError>& errors);

struct ReplacedFile {
    Dataset dataset;                 ///< size and place as in the index
    std::optional<std::string> note; ///< set if the file was replaced
};

/// Makes a newly opened file match its index entry: resamples a file of other size, place or CRS
/// (bilinear; averages finer samples). Fails if it does not cover the indexed samples. `crs`: WKT.
Result<ReplacedFile> as_indexed(Dataset opened, const IndexedFile& indexed, const std::string& crs,
                                const std::string& name);

} // namespace reljef::io
