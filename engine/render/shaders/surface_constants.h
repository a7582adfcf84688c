#pragma once

#include "engine/gl/program.h"
#include "engine/render/shaders/shader_library.h"
#include "engine/scene/graph/camera.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::render {

/// The variant with the material's own shader, if it has one.
ShaderVariant with_surface(ShaderVariant variant, const scene::Material& material);

/// Sets the constants of the material's own shader, if it has one.
void set_surface(gl::Program& program, const scene::Material& material,
                 const scene::Camera& camera);

} // namespace reljef::render
