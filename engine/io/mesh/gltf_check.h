#pragma once

#include <filesystem>

#include "engine/core/result.h"

namespace reljef::io {

/// Reads what a glTF 2.0 file (.gltf, .glb) says of its size, before importing costs time. Fails,
/// with what was found, on more than max_mesh_triangles, on texts and nodes nested deeper than
/// max_gltf_depth, and on required extensions that the importer lacks. A file that is no glTF
/// passes: its import says what is wrong.
Result<void> check_gltf(const std::filesystem::path& file);
inline constexpr int max_gltf_depth = 500;

} // namespace reljef::io
