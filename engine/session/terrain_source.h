#pragma once

#include <memory>
#include <optional>
#include <stop_token>

#include "engine/io/formats/scene_file.h"
#include "engine/io/imagery/imagery_set.h"
#include "engine/io/tile_set.h"
#include "engine/scene/streamed_tile.h"
#include "engine/session/log.h"
#include "engine/session/options.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::session {

/// Samples of a tile set that are read as they are needed.
struct StreamSource {
    io::TileSet::TerrainPlan plan; ///< the terrain is its overview
    io::Gaps gaps = io::Gaps::holes;
    std::size_t memory_budget = 0;   ///< bytes, for tiles
    std::size_t overview_budget = 0; ///< bytes
    /// Where only the images do not fit: --memory with which the overview has all samples.
    std::optional<std::size_t> megabytes_for_all_heights;
    unsigned threads = 0;
    /// Tiles of so many samples from vertex to vertex, or more, are made of the overview: of files
    /// without overviews reading them takes too long. 0: none are.
    int step_of_overview = 0;
    scene::ImageryDetail imagery;
};

/// A terrain that was read or generated, and what its scene file says.
struct TerrainSource {
    terrain::Terrain terrain;
    io::SceneDescription description;
    std::optional<io::TileSet> tiles; ///< where the heights are a folder, or streamed
    std::optional<StreamSource> stream = {};
    std::shared_ptr<const io::ImagerySet> imagery; ///< where tiles show images of their own
};

/// The part of a folder or a tile pyramid that is of use; absent: all.
std::optional<geo::GeodeticArea> area_of(const SourceOptions& options,
                                         const io::SceneDescription& description);

/// What a TERRAIN names, without reading its heights: a scene file's or a built-in scene's text, or
/// a description of the path.
Result<io::SceneDescription> describe(const std::string& terrain);

/// Opens what the options name. The log gets the progress, and the terrain's notes and faults.
/// Errors name the terrain, what was found and what was expected; options that do not fit such a
/// terrain are usage errors.
Result<TerrainSource> open_terrain(const SourceOptions& options, Log& log,
                                   const std::stop_token& stop);

/// The same for a scene that is described already; `options.terrain` is not read.
Result<TerrainSource> open_terrain(io::SceneDescription description, const SourceOptions& options,
                                   Log& log, const std::stop_token& stop);

/// The files of heights that TERRAIN names, and the part of them that is of use.
struct HeightSource {
    io::TileSet tiles;
    std::optional<geo::GeodeticArea> area; ///< absent: all
};

/// Indexes them and reads none. Fails for generated terrains, and as open_terrain does; what is
/// read of them later is kept within half of the memory.
Result<HeightSource> open_heights(const SourceOptions& options, const std::stop_token& stop);

/// What is told in the end, with exit status 1, where files of the terrain could not be read.
Result<void> report_faults(const std::string& terrain, std::size_t faults);

} // namespace reljef::session
