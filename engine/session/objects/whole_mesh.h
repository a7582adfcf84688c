#pragma once

#include <filesystem>
#include <stop_token>

#include "engine/core/result.h"
#include "engine/scene/graph/mesh.h"

namespace reljef::session {

/// All parts of a mesh file as one mesh without their colours. It stands on z = 0, around the z
/// axis, and its largest side is `side` metres. Fails as io::read_mesh_file, and without size or
/// without texture coordinates that span an area, which detail textures need.
Result<scene::Mesh> read_whole_mesh(const std::filesystem::path& file, double side,
                                    const std::stop_token& stop);

} // namespace reljef::session
