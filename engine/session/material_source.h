#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "engine/core/result.h"
#include "engine/material/relief_material.h"
#include "engine/scene/technique/technique.h"
#include "engine/session/log.h"
#include "engine/session/options.h"

namespace reljef::session {

/// Which maps of a tile of detail.
struct MaterialRequest {
    std::string name;                 ///< as the user said it: a built-in one, or a folder
    std::filesystem::path folder;     ///< of pictures, where it is none that is built in
    std::string asked_by;             ///< the option or the scene file
    std::uint32_t seed = 1;           ///< of a built-in one
    double width = 1.0;               ///< metres that the tile covers
    std::optional<double> scale = {}; ///< of the heights, in widths; absent: as pictures have it
    std::string also = {};            ///< what else the user might have said: "NAME, "
};

/// Makes or reads them. Fails on a name that is neither built in nor a folder (a usage error where
/// an option asked), and where pictures cannot be read.
Result<material::ReliefMaterial> open_material(const MaterialRequest& request,
                                               const SourceOptions& options);

/// Reports what is odd about the maps.
void log_material_notes(const material::ReliefMaterial& set, Log& log);

} // namespace reljef::session
