#pragma once

#include <atomic>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/io/dataset_pool.h"
#include "engine/io/raster/crs_transform.h"
#include "engine/io/tile_index.h"

namespace reljef::io {

/// A tile on its layer's lattice.
struct LayerTile {
    int file = 0; ///< index into the indexed files
    int col = 0;  ///< of its first sample, in the layer's lattice
    int row = 0;
    int cols = 0;
    int rows = 0;
    glm::dvec2 offset{0.0}; ///< its samples lie so far from the lattice's points, in lattice steps
    bool is_turned = false; ///< the same tile again, a whole turn around the Earth away
};

/// Tiles of one coordinate system whose samples lie on one lattice: together one raster with gaps.
struct TileLayer {
    std::string crs;                   ///< WKT
    geo::PixelAffine crs_from_lattice; ///< whole numbers are samples; (0,0) is the first of all
    glm::dmat2 lattice_steps{1.0};     ///< lattice steps for one unit of x and of y
    int cols = 0;
    int rows = 0;
    glm::dvec2 spacing{1.0};      ///< metres at its middle
    std::int64_t modified = 0;    ///< of the newest tile
    double period = 0.0;          ///< of x: 360 degrees in its unit; 0: no degrees
    DegreeBox box{};              ///< around all tiles
    std::vector<LayerTile> tiles; ///< newest first; turned ones lie outside cols

    [[nodiscard]] glm::dvec2 lattice_from_crs(glm::dvec2 point) const {
        return lattice_steps * (point - glm::dvec2(crs_from_lattice.x0, crs_from_lattice.y0));
    }
    /// The same where x may be whole turns away.
    [[nodiscard]] glm::dvec2 lattice_from_turned(glm::dvec2 point) const;
};

/// A usable file: where it lies, with x moved by whole turns so that the set hangs together.
struct PlacedFile {
    int file = 0;                     ///< index into the indexed files
    std::string crs;                  ///< WKT; the same text for the same system
    geo::PixelAffine crs_from_sample; ///< (0,0) is the centre of the first sample
    glm::dvec2 spacing{1.0};
    DegreeBox box{};
    double period = 0.0;
};

/// Whole steps of about 1 %, smaller where samples or pixels are closer together: those of one step
/// are equally fine.
double resolution(glm::dvec2 spacing);

/// The layers of a set, the finest first; of equally fine ones the newer.
std::vector<TileLayer> layers_of(std::span<const PlacedFile> placed,
                                 std::span<const IndexedFile> files);

/// Square cells of `reduction` samples a side: cell (0,0) begins at lattice point `anchor`.
struct CellWindow {
    int reduction = 1;
    glm::ivec2 anchor{0};
    glm::ivec2 first{0}; ///< cell
    int cols = 0;
    int rows = 0;

    [[nodiscard]] glm::dvec2 cell_from_lattice(glm::dvec2 point) const {
        const double middle = 0.5 * (reduction - 1);
        return (point - glm::dvec2(anchor) - middle) / static_cast<double>(reduction);
    }
};

/// Where and how files are read.
struct TileContent {
    std::span<const IndexedFile> files;
    std::span<const std::string> crs;               ///< WKT, by IndexedFile::crs
    std::filesystem::path folder;                   ///< the files' paths begin here
    RasterOptions options;                          ///< scale, offset, stop
    std::atomic<std::size_t>* bytes_read = nullptr; ///< counts them
    DatasetPool* pool = nullptr;                    ///< where the files are open
    FailingFiles* failing = nullptr;                ///< on servers
    NewNotes* new_notes = nullptr;                  ///< on files: replaced, or with voids
};

/// The averages of a layer's samples over cells, of the newest tile where there are several; NaN
/// where there is none. What fails is added to the faults and left out: a file, of a tile pyramid
/// only those of its tiles that cannot be read.
Grid<double> read_cells(const TileLayer& layer, const CellWindow& window,
                        const TileContent& reading, std::vector<FileError>& errors);

/// Geodesic distance in metres between two (longitude, latitude) in degrees.
double metres_between(glm::dvec2 a, glm::dvec2 b);

/// Placed files of an index. Longitudes are continuous across the antimeridian, so that the set is
/// as narrow as possible. Adds an error for each file without a position on Earth.
std::vector<PlacedFile> place_files(const TileIndex& index, const std::filesystem::path& folder,
                                    std::vector<FileError>& errors);

struct ReplacedFile {
    Dataset dataset;                 ///< size and place as in the index
    std::optional<std::string> note; ///< set if the file was replaced
};

/// Makes a newly opened file match its index entry. A file of other size, place or CRS that covers
/// the indexed samples is resampled to them (bilinear; averages finer samples). Fails if it does
/// not cover them. `crs`: WKT of the indexed file.
Result<ReplacedFile> as_indexed(Dataset opened, const IndexedFile& indexed, const std::string& crs,
                                const std::string& name);

} // namespace reljef::io
