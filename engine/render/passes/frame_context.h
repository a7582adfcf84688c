#pragma once

#include <cstdint>

#include "engine/core/result.h"
#include "engine/gl/framebuffer.h"
#include "engine/gl/vertex_array.h"
#include "engine/render/passes/draw_state.h"
#include "engine/render/passes/ground_shadow.h"
#include "engine/render/passes/skips.h"
#include "engine/render/residency/residency.h"
#include "engine/view/draw_list.h"

namespace reljef::render {

struct FrameContext {
    const view::DrawList& list;
    const Residency& residency; ///< prepared for the list
    bool hits;                  ///< draws hits instead of colours
    ShaderFeatures features;    ///< see scene_features()
    const gl::Framebuffer& picture;
    const gl::Framebuffer& beams; ///< used by techniques with beams (beams.h)
    const gl::VertexArray& no_vertices;
    const Skips& skips;
    DrawState& state;
    ShaderFeatures mesh_shadows = 0; ///< feature_mesh_shadows if meshes may hide the sun
    const GroundShadow* ground_shadow = nullptr; ///< null for hits and work

    /// Whether fragments add their work to the picture instead of their colours.
    [[nodiscard]] bool counts() const { return (features & feature_counting) != 0; }
};

/// The features that all programs of the list share, see Skips::features. `samples`: per pixel of
/// the picture.
ShaderFeatures scene_features(const view::DrawList& list, bool hits, int samples, bool skips);

/// feature_point_lights if view::needs_ground(); 0 for hits, and where prewarp shows other places
/// than its triangles.
ShaderFeatures point_light_features(const FrameContext& frame, const view::TileDraw& draw);
ShaderFeatures point_light_features(const FrameContext& frame, const view::TerrainDraw& draw);

// The passes. They fail as ShaderLibrary::program and without memory.

Result<void> draw_terrain_tiles(const FrameContext& frame);

/// Draws the bounding box of each relief; before it the beams of techniques that have them.
Result<void> draw_reliefs(const FrameContext& frame);

Result<void> draw_meshes(const FrameContext& frame);

/// Draws the walls below terrains over all ground: a wall that faces the eye is in front of it.
/// Nothing for hits.
Result<void> draw_bases(const FrameContext& frame);

/// Draws the sky behind everything; nothing for hits.
Result<void> draw_sky(const FrameContext& frame);

} // namespace reljef::render
