#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "engine/building/building_faces.h"
#include "engine/io/formats/scene_file.h"
#include "engine/io/imagery/imagery_set.h"
#include "engine/io/tile_set.h"
#include "engine/scene/streaming/tile_builder.h"
#include "engine/session/log.h"
#include "engine/session/options.h"
#include "engine/session/proven_tiles.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::session {

struct StreamSource {
    io::TileSet::TerrainPlan plan; ///< the terrain is its overview
    io::Gaps gaps = io::Gaps::holes;
    std::size_t memory_budget = 0;   ///< bytes, for tiles
    std::size_t overview_budget = 0; ///< bytes
    /// If only the images do not fit in memory: the --memory for an overview with all samples.
    std::optional<std::size_t> megabytes_for_all_heights;
    unsigned threads = 0;
    /// Tiles with at least this step come from the overview: reading them from files without
    /// overviews takes too long. 0: none do.
    int step_of_overview = 0;
    scene::ImageryDetail imagery;
};

struct TerrainSource {
    terrain::Terrain terrain;
    io::SceneDescription description;
    std::optional<io::TileSet> tiles; ///< if the heights are a folder, or streamed
    std::optional<StreamSource> stream = {};
    std::shared_ptr<const io::ImagerySet> imagery;  ///< if tiles have images of their own
    std::shared_ptr<const ProvenTiles> proofs = {}; ///< null: no streamed tile is proven
    /// Meshes of the city `urban` (terrains::City).
    std::vector<building::PaintedFaces> buildings = {};
    Grid<float> city_heights = {}; ///< as terrains::City::heights
};

/// The part of a folder or of web tiles to use; absent: all.
std::optional<geo::GeodeticArea> area_of(const SourceOptions& options,
                                         const io::SceneDescription& description);

/// Describes a TERRAIN without reading its heights: from a scene file, a built-in scene, or the
/// path.
Result<io::SceneDescription> describe(const std::string& terrain);

/// Opens the terrain of the options. Logs progress, notes and errors of files. Errors name the
/// terrain, what was found and what was expected; options that do not fit it are usage errors.
Result<TerrainSource> open_terrain(const SourceOptions& options, Log& log,
                                   const std::stop_token& stop);

/// The same with a known description; ignores `options.terrain`.
Result<TerrainSource> open_terrain(io::SceneDescription description, const SourceOptions& options,
                                   Log& log, const std::stop_token& stop);

/// The height files of a TERRAIN, and the part of them to use.
struct HeightSource {
    io::TileSet tiles;
    std::optional<geo::GeodeticArea> area; ///< absent: all
    io::TileTerrainOptions plan_options;   ///< for tiles.plan()
};

enum class HeightUse { at_places, of_samples };

/// Indexes the files and reads no heights. Fails for generated terrains, for heights at places of a
/// terrain that has none on Earth, and as open_terrain. Later reads take at most half of the
/// memory.
Result<HeightSource> open_heights(const SourceOptions& options, HeightUse use,
                                  const std::stop_token& stop);

/// The final error (exit status 1) if files of the terrain could not be read.
Result<void> report_errors(const std::string& terrain, std::size_t errors);

} // namespace reljef::session
