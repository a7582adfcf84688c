#pragma once

#include <glm/mat4x4.hpp>

#include "engine/gl/program.h"
#include "engine/render/passes/frame_context.h"
#include "engine/render/shaders/shader_library.h"
#include "engine/view/ground_view.h"

namespace reljef::render {

/// The variant that draws a terrain with its tile of detail. `features` are the scene's.
/// Precondition: something is seen of it.
ShaderVariant ground_variant(const scene::TerrainDetail& detail, view::DetailLevel level,
                             std::uint32_t features);

/// What these programs ask for beside the terrain's maps and its place. Fails where the driver has
/// no memory.
Result<void> set_ground(gl::Program& program, const FrameContext& frame_context,
                        const scene::TerrainNode& terrain, const glm::dmat4& world_from_local);

} // namespace reljef::render
