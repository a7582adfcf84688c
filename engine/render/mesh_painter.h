#pragma once

#include <glm/mat4x4.hpp>

#include "engine/gl/program.h"
#include "engine/render/draw_list.h"
#include "engine/render/mesh_residency.h"
#include "engine/render/shader_library.h"

namespace reljef::render {

/// The variant that draws a mesh: of one colour, with a tile of detail on it, or with each pixel
/// looking for the tile's surface. `features` are the scene's.
ShaderVariant mesh_variant(const scene::Material& material, std::uint32_t features);

/// What the programs of meshes with a tile ask for, beside the transform. Precondition: the
/// material has a tile.
void set_tile(gl::Program& program, const MeshDraw& draw, const MeshResidency& residency,
              const scene::Camera& camera);

} // namespace reljef::render
