#pragma once

#include <filesystem>
#include <string>

#include "engine/core/result.h"

namespace reljef::io {

/// The bytes of a glTF 2.0 file (.gltf, .glb) without what reljef does not show: cameras, lights,
/// animations, skins, names, extras, and attributes besides positions, normals and the first
/// texture coordinates. The importer's time grows with the square of some of these. Fails on a file
/// whose JSON cannot be read, and as the functions of gltf_check.h; the error does not name the
/// file.
Result<std::string> reduced_gltf(const std::filesystem::path& file);

} // namespace reljef::io
