#pragma once

#include <glm/mat4x4.hpp>

#include "engine/gl/program.h"
#include "engine/render/passes/frame_context.h"
#include "engine/render/shaders/shader_library.h"
#include "engine/view/draw_list.h"

namespace reljef::render {

/// The variant for a terrain with surface detail. `features`: see scene_features(). Precondition:
/// the level is not none.
ShaderVariant ground_variant(const scene::TerrainDetail& detail, view::DetailLevel level,
                             ShaderFeatures features);

/// Sets the inputs of these programs except the terrain's maps and transform. Fails without GL
/// memory.
Result<void> set_ground(gl::Program& program, const FrameContext& frame,
                        const scene::TerrainNode& terrain, const glm::dmat4& world_from_local);

} // namespace reljef::render
