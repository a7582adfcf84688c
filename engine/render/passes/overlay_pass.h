#pragma once

#include <cstdint>

#include <glm/mat4x4.hpp>

#include "engine/core/result.h"
#include "engine/render/passes/frame_context.h"
#include "engine/render/residency/relief_maps.h"

namespace reljef::render {

/// The features of a terrain that shows grain, façades or contours on ground that is at least
/// `distance` metres away; else 0.
ShaderFeatures overlay_features(const FrameContext& frame, const scene::TerrainNode& terrain,
                                double distance = 0.0);

/// Sets the grain, façades and contours of a terrain, if it has some. Fails without memory.
/// `space`: of a relief; null: none.
Result<void> set_overlay(const FrameContext& frame, const scene::TerrainNode& terrain,
                         const glm::dmat4& world_from_local, const ReliefSpace* space = nullptr);

} // namespace reljef::render
