#pragma once

#include <memory>
#include <optional>
#include <string>

#include "engine/io/imagery/imagery_set.h"
#include "engine/io/tile_set.h"
#include "engine/session/options.h"
#include "engine/session/terrain_source.h"

namespace reljef::session {

/// The images over a terrain that may be streamed: opened once, as the look for what is white in
/// 16-bit ones takes seconds.
struct OpenImagery {
    std::shared_ptr<const io::ImagerySet> set; ///< null: none needed, or none that can be opened
    std::string fault;                         ///< why none can be opened

    [[nodiscard]] std::optional<double> white() const {
        return set != nullptr ? std::optional(set->white()) : std::nullopt;
    }
};

/// Opens them where tiles would show them.
OpenImagery open_imagery(const io::TileSet& tiles, const SourceOptions& choice,
                         const io::TileTerrainOptions& options);

/// Whether images are finer than one picture over all of the terrain may be.
bool has_finer_pictures(const io::TileSet& tiles, const io::TileTerrainOptions& options,
                        const OpenImagery& imagery);

/// How the tiles are to be read as they are needed; nothing where all fits or that is not wanted.
/// GDAL's memory for blocks is limited to its share then.
std::optional<StreamSource> stream_source(const io::TileSet& tiles, const SourceOptions& choice,
                                          io::TileTerrainOptions options,
                                          const OpenImagery& imagery);

/// What tiles show of images. `spacing`: metres from sample to sample of the terrain.
scene::ImageryDetail imagery_detail(const io::ImagerySet& imagery, const StreamSource& stream,
                                    double spacing);

} // namespace reljef::session
