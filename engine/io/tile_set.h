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
#include "engine/io/raster/raster.h"
#include "engine/io/raster/web_tiles.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::io {

struct TileSetOptions {
    /// Where the index of a folder is kept from one time to the next; empty: nowhere.
    std::filesystem::path cache_folder;
    unsigned threads = 0;      ///< 0: as many as the machine has
    double height_scale = 1.0; ///< as in RasterOptions
    double height_offset = 0.0;
    std::stop_token stop;
};

/// A file of the set that holds heights.
struct TileFile {
    std::filesystem::path path;
    int cols = 0;
    int rows = 0;
    std::string format; ///< GDAL's driver
    std::string type;   ///< "Int16", …
    std::string crs_name;
    glm::dvec2 spacing{1.0}; ///< metres
    double south = 0.0;      ///< degrees, of the outermost samples
    double west = 0.0;
    double north = 0.0;
    double east = 0.0; ///< over 180 where the set crosses the antimeridian
    bool declares_voids = false;
};

/// Whether a tile has samples inside an area, not only on its edge.
bool reaches_into(const TileFile& file, const geo::GeodeticArea& area);

/// What lies where the set has no tile.
enum class Gaps { holes, sea };

/// Samples to read: (col, row) lies at first + step·(col, row) in the set's coordinate system.
struct TileGrid {
    glm::dvec2 first{0.0};
    glm::dvec2 step{1.0, -1.0};
    int cols = 0;
    int rows = 0;
};

struct TileWindow {
    Grid<double> heights;          ///< metres; NaN at voids and holes
    std::vector<FileError> errors; ///< of the files that were to be read; each once
    std::size_t bytes_read = 0;    ///< of samples taken from the files
};

/// What is known of a place on Earth.
struct HeightAnswer {
    enum class Kind : std::uint8_t { height, in_void, outside } kind = Kind::outside;
    double height = 0.0; ///< metres above the DEM's own zero, where kind is height
};

struct TileTerrainOptions {
    RasterOptions raster; ///< `window` and `spacing` are of no use here
    std::optional<geo::GeodeticArea> area;
    Gaps gaps = Gaps::holes;
    unsigned threads = 0;
};

/// Any number of georeferenced rasters as one surface: a folder of them in any mix of formats and
/// coordinate systems, or a single raster of any size. Where several have a height the one with the
/// finer spacing counts, then the newer. Files are read where and when they are asked for. Safe
/// from several threads at a time.
class TileSet {
public:
    /// Fails where there is no usable raster; files that cannot be used are faults.
    static Result<TileSet> open(const std::filesystem::path& path,
                                const TileSetOptions& options = {});

    [[nodiscard]] const std::string& name() const;
    [[nodiscard]] std::span<const TileFile> files() const; ///< finest first
    [[nodiscard]] std::span<const FileError> errors() const;
    [[nodiscard]] std::span<const std::string> notes() const;
    /// Notes since the last call, each once: on files that were replaced by others.
    [[nodiscard]] std::vector<std::string> take_new_notes() const;
    /// That of all tiles where they share one, else WGS 84 in degrees.
    [[nodiscard]] const std::string& crs_name() const;
    /// The same as WKT.
    [[nodiscard]] const std::string& crs() const;
    /// All of the set, at the finest spacing, on the samples of the finest tile where all tiles
    /// share a coordinate system.
    [[nodiscard]] TileGrid grid() const;
    /// The part of `grid` in an area; fails where there is none.
    [[nodiscard]] Result<TileGrid> part(const TileGrid& grid, const geo::GeodeticArea& area) const;
    /// What is missing of a grid that goes all around the Earth.
    [[nodiscard]] geo::GlobalWrap closing(const TileGrid& grid) const;
    /// Every `reduction`-th part of `grid` a side: its samples are the middles of whole blocks.
    [[nodiscard]] static TileGrid reduced(const TileGrid& grid, int reduction);

    /// The set's surface at the samples of a grid. Tiles that are finer are averaged over the
    /// grid's cells, others interpolated. On one thread.
    [[nodiscard]] TileWindow read(const TileGrid& grid, Gaps gaps, std::stop_token stop = {}) const;

    /// Bilinear heights at places (latitude, longitude in degrees) from the best tile of each, at
    /// its full resolution, reading only what is needed. `faults` of files that were to be read.
    struct Heights {
        std::vector<HeightAnswer> answers;
        std::vector<FileError> errors;
    };
    [[nodiscard]] Heights heights(std::span<const glm::dvec2> places) const;

    /// What of the set a terrain is made of: the whole grid of samples, or its part in an area, and
    /// the finest whole-number reduction of it that fits the memory.
    struct TerrainPlan {
        TileGrid grid;
        int reduction = 1;
    };
    [[nodiscard]] Result<TerrainPlan> plan(const TileTerrainOptions& options = {}) const;

    /// Bytes of the samples that all readings so far went through in the files.
    [[nodiscard]] std::size_t bytes_read() const;

    /// All of it, or a part, as one terrain at the finest whole-number reduction that fits the
    /// memory. Files that fail are left out; Terrain::faults names them.
    [[nodiscard]] Result<terrain::Terrain> terrain(const TileTerrainOptions& options = {}) const;

private:
    struct State;
    explicit TileSet(std::shared_ptr<const State> state) : state_(std::move(state)) {}
    std::shared_ptr<const State> state_;
};

} // namespace reljef::io
