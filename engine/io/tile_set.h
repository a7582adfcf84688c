#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/geo/georeference.h"
#include "engine/io/files/tile_grid.h"
#include "engine/io/imagery/imagery_set.h"
#include "engine/io/raster/raster.h"
#include "engine/io/raster/web_tiles.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::io {

struct TileSetOptions {
    std::filesystem::path cache_folder; ///< for indexes of folders; empty: no cache
    unsigned threads = 0;               ///< 0: one per hardware thread
    double height_scale = 1.0;          ///< as in RasterOptions
    double height_offset = 0.0;
    /// Whether a single raster may have no coordinate system, or one of its own. It lies on a
    /// plane.
    bool allows_planes = false;
    std::optional<double> spacing; ///< of such a raster, as in RasterOptions
    std::stop_token stop;
};

/// A file of heights.
struct TileFile {
    std::filesystem::path path;
    int cols = 0;
    int rows = 0;
    std::string format; ///< GDAL's driver
    std::string type;   ///< "Int16", …
    std::string crs_name;
    glm::dvec2 spacing{1.0}; ///< metres; 1 if it is unknown
    double south = 0.0;      ///< degrees; outermost samples; all 0 on a plane
    double west = 0.0;
    double north = 0.0;
    double east = 0.0; ///< above 180 across the antimeridian
    bool declares_voids = false;
};

/// Whether a file overlaps an area by more than its edge.
bool reaches_into(const TileFile& file, const geo::GeodeticArea& area);

/// Content of places without a file.
enum class Gaps { holes, sea };

struct TileWindow {
    Grid<double> heights;          ///< metres; NaN at voids and holes
    std::vector<FileError> errors; ///< at most one per file
    std::size_t bytes_read = 0;    ///< of samples read from files
};

struct HeightSample {
    enum class Kind : std::uint8_t { height, in_void, outside } kind = Kind::outside;
    double height = 0.0; ///< metres above the DEM's own zero; for Kind::height
};

struct TileTerrainOptions {
    RasterOptions raster; ///< ignores `window` and `spacing`
    std::optional<geo::GeodeticArea> area;
    Gaps gaps = Gaps::holes;
    unsigned threads = 0;
};

/// Georeferenced rasters of any format, CRS and size as one surface, read on demand: a folder or a
/// single file. Where files overlap, the finest wins; ties go to the newest. Thread-safe.
class TileSet {
public:
    /// Fails without a usable raster. errors() names unusable files.
    static Result<TileSet> open(const std::filesystem::path& path,
                                const TileSetOptions& options = {});

    [[nodiscard]] const std::string& name() const;
    [[nodiscard]] std::span<const TileFile> files() const; ///< finest first
    [[nodiscard]] std::span<const FileError> errors() const;
    [[nodiscard]] std::span<const std::string> notes() const;
    /// Notes of readers since the last call, each once.
    [[nodiscard]] std::vector<std::string> take_new_notes() const;
    /// Grows when a reading finds that a local file changed since it was read before: its size or
    /// its time. What was read before is outdated.
    [[nodiscard]] std::uint64_t changes() const;
    /// The files' common CRS, else WGS 84 in degrees; on a plane a system without a place, whose
    /// metres terrain() may scale if the spacing is unknown.
    [[nodiscard]] const std::string& crs_name() const;
    [[nodiscard]] const std::string& crs() const; ///< WKT
    [[nodiscard]] bool is_on_plane() const;       ///< has no place on Earth
    /// The whole set at its finest spacing, aligned to the finest file in a common CRS.
    [[nodiscard]] TileGrid grid() const;
    /// The part of `grid` in an area; fails if it is empty.
    [[nodiscard]] Result<TileGrid> part(const TileGrid& grid, const geo::GeodeticArea& area) const;
    /// Scale and offset of the heights.
    [[nodiscard]] const TileSetOptions& options() const;
    /// Of images over `grid`: on a plane the file's own pixels, over which images are stretched.
    [[nodiscard]] ImageryGround imagery_ground(const TileGrid& grid) const;
    /// The samples that close a global grid.
    [[nodiscard]] geo::GlobalWrap wrap(const TileGrid& grid) const;
    /// The centres of blocks of `reduction`×`reduction` samples.
    [[nodiscard]] static TileGrid reduced(const TileGrid& grid, int reduction);

    /// Hash of the files' present names, sizes, times and of a few blocks. Fails as open().
    [[nodiscard]] Result<std::uint64_t> fingerprint() const;
    /// The pixel of the first sample, if the set is one local file and a grid's samples are its
    /// pixels, column by column and row by row.
    [[nodiscard]] std::optional<glm::ivec2> first_pixel(const TileGrid& grid) const;

    /// Heights at the samples of a grid: finer files are averaged over cells, others interpolated.
    /// Single-threaded.
    [[nodiscard]] TileWindow read(const TileGrid& grid, Gaps gaps, std::stop_token stop = {}) const;

    struct Heights {
        std::vector<HeightSample> answers;
        std::vector<FileError> errors;
        std::size_t bytes_read = 0; ///< as in TileWindow
    };
    /// Bilinear full-resolution heights at (latitude, longitude) in degrees, from the best file of
    /// each place; on a plane, all places are outside. Incomplete after a stop request.
    [[nodiscard]] Heights heights(std::span<const glm::dvec2> places,
                                  const std::stop_token& stop = {}) const;

    struct TerrainPlan {
        TileGrid grid;     ///< whole set, or its part in the area
        int reduction = 1; ///< the smallest that fits the memory
    };
    [[nodiscard]] Result<TerrainPlan> plan(const TileTerrainOptions& options = {}) const;

    /// A terrain by plan(). Skips files that fail and names them in Terrain::errors.
    [[nodiscard]] Result<terrain::Terrain> terrain(const TileTerrainOptions& options = {}) const;

private:
    struct State;
    explicit TileSet(std::shared_ptr<const State> state) : state_(std::move(state)) {}
    std::shared_ptr<const State> state_;
};

} // namespace reljef::io
