#pragma once

#include <memory>
#include <optional>

#include "engine/io/imagery/imagery_set.h"
#include "engine/io/tile_set.h"
#include "engine/session/options.h"
#include "engine/session/terrain_source.h"

namespace reljef::session {

/// The images over a terrain, if tiles would show them; else null. The overview takes their white
/// point, because searching that of 16-bit images takes seconds.
Result<std::shared_ptr<const io::ImagerySet>> open_imagery(const io::TileSet& tiles,
                                                           const SourceOptions& choice,
                                                           const io::TileTerrainOptions& options);

/// Whether images are finer than the largest single picture over the terrain.
bool has_finer_pictures(const io::TileSet& tiles, const io::TileTerrainOptions& options,
                        const io::ImagerySet* imagery);

/// How tiles are read on demand; empty if all fits in memory or streaming is off. Otherwise limits
/// GDAL's block cache to its share of the memory.
std::optional<StreamSource> stream_source(const io::TileSet& tiles, const SourceOptions& choice,
                                          io::TileTerrainOptions options,
                                          const io::ImagerySet* imagery);

/// The resolution of tile images. `spacing`: metres between samples of the terrain.
scene::ImageryDetail imagery_detail(const io::ImagerySet& imagery, const StreamSource& stream,
                                    double spacing);

} // namespace reljef::session
