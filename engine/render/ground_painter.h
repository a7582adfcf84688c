#pragma once

#include <glm/mat4x4.hpp>

#include "engine/gl/program.h"
#include "engine/render/ground_view.h"
#include "engine/render/shader_library.h"
#include "engine/render/tile_residency.h"

namespace reljef::render {

/// The surface of a terrain's tile of detail that is shown.
TileSide ground_side();

/// The variant that draws a terrain with its tile of detail. `features` are the scene's.
/// Precondition: something is seen of it.
ShaderVariant ground_variant(const scene::GroundDetail& detail, DetailLevel level,
                             std::uint32_t features);

/// What these programs ask for beside the terrain's maps and its place.
void set_ground(gl::Program& program, const scene::TerrainNode& terrain,
                const glm::dmat4& world_from_local, const scene::Camera& camera, glm::ivec2 size,
                const TileResidency& tiles);

} // namespace reljef::render
