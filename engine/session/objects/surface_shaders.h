#pragma once

#include "engine/core/result.h"
#include "engine/io/formats/scene_file.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::session {

/// Reads the shader file and gives materials its shader and constants. Fails as
/// scene::SurfaceShader::create() and check(), and if the file cannot be read.
Result<void> set_surface_shader(const io::SurfaceShaderDescription& description,
                                const std::vector<scene::Material*>& materials);

} // namespace reljef::session
