#pragma once

#include <memory>
#include <optional>
#include <stop_token>

#include "app/cli/options.h"
#include "engine/io/formats/scene_file.h"
#include "engine/io/imagery/imagery_set.h"
#include "engine/io/tile_set.h"
#include "engine/scene/streamed_tile.h"
#include "engine/scene/technique/technique.h"
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

/// What becomes of a terrain's notes: told on stderr, or only kept in terrain::Terrain::notes.
enum class Notes { told, kept };

/// The part of a folder or a tile pyramid that is of use; absent: all.
std::optional<geo::GeodeticArea> area_of(const cli::TerrainChoice& choice,
                                         const io::SceneDescription& description);

/// Opens what TERRAIN names, with progress on stderr. Errors name the terrain, what was found and
/// what was expected; options that such a terrain has no use for are refused (misuse.h).
Result<TerrainSource> open_terrain(const cli::TerrainChoice& choice, const std::stop_token& stop,
                                   Notes notes = Notes::told);

/// The same of a scene that is described already; `choice.terrain` is not looked at.
Result<TerrainSource> open_terrain(io::SceneDescription description,
                                   const cli::TerrainChoice& choice, const std::stop_token& stop,
                                   Notes notes = Notes::told);

/// Makes what the technique needs besides the heights and takes seconds, or reads it from the
/// cache, with progress and notes on stderr: the cones. Fails when it was stopped.
Result<void> prepare_technique(TerrainSource& source, const scene::Technique& technique,
                               const cli::TerrainChoice& choice, const std::stop_token& stop);

/// The files of heights that TERRAIN names, and the part of them that is of use.
struct HeightSource {
    io::TileSet tiles;
    std::optional<geo::GeodeticArea> area; ///< absent: all
};

/// Indexes them and reads none. Fails for generated terrains, and as open_terrain does; what is
/// read of them later is kept within half of the memory.
Result<HeightSource> open_heights(const cli::TerrainChoice& choice, const std::stop_token& stop);

/// What is told in the end, with exit status 1, where files of the terrain could not be read.
Result<void> report_faults(const std::string& terrain, std::size_t faults);

} // namespace reljef::session
