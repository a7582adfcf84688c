#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "engine/core/result.h"
#include "engine/io/formats/scene_file.h"
#include "engine/material/relief_material.h"
#include "engine/scene/graph/terrain_node.h"
#include "engine/session/log.h"
#include "engine/session/options.h"

namespace reljef::session {

/// Selects a relief material.
struct MaterialRequest {
    std::string name;                 ///< a built-in material, or a folder as the user wrote it
    std::filesystem::path folder;     ///< of pictures, unless the name is built in
    std::string asked_by;             ///< the option or the scene file, for errors
    std::uint32_t seed = 1;           ///< of a built-in material
    double width = 1.0;               ///< of a tile, metres
    std::optional<double> scale = {}; ///< of the heights, in widths; absent: the pictures' own
    std::string also = {};            ///< other allowed names, for errors: "NAME, "
};

/// Generates or reads a material. Fails on a name that is neither built in nor a folder (a usage
/// error if an option named it), and on pictures that cannot be read.
Result<material::ReliefMaterial> open_material(const MaterialRequest& request,
                                               const SourceOptions& options);

/// Reports oddities of the maps.
void log_material_notes(const material::ReliefMaterial& set, Log& log);

/// The detail tile that --detail or the scene file lays over the terrain; null if neither does.
/// Fails on unknown or unreadable materials, on a technique that cannot show a detail tile, and
/// after a stop request. A usage error if --detail-technique has no tile.
Result<std::shared_ptr<const scene::TerrainDetail>>
open_detail(const io::SceneDescription& description, const SourceOptions& terrain,
            const SceneOptions& view, Log& log, const std::stop_token& stop);

} // namespace reljef::session
