#pragma once

#include <filesystem>
#include <vector>

#include "engine/core/result.h"
#include "engine/io/mesh/mesh_message.h"

namespace reljef::io {

/// Reads an OBJ (.obj) or glTF 2.0 file (.gltf, .glb) with Assimp, which may crash, hang or take
/// much memory on files from strangers: call it in a process of its own (mesh_file.h). Both formats
/// have y up: x stays, y becomes z, and z becomes −y, so that a glTF's front (+z) faces south.
/// Metres stay metres. Missing normals are computed, with hard edges from 45 degrees on. Rows of
/// textures begin at v = 0. Opens files in and below the file's folder only, of max_mesh_bytes
/// together. Errors begin with what was found.
Result<std::vector<MeshPart>> import_mesh(const std::filesystem::path& file);
inline constexpr std::size_t max_mesh_bytes = std::size_t{512} << 20U;

} // namespace reljef::io
