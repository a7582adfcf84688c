#pragma once

#include "engine/gl/program.h"
#include "engine/material/relief_material.h"
#include "engine/render/residency/resident_tile.h"
#include "engine/render/shaders/uniform_blocks.h"
#include "engine/scene/technique/technique.h"

namespace reljef::render {

/// Binds the maps of a tile to where the programs that show it have them (tile_light.glsl,
/// relief_surface.glsl).
void bind_tile(gl::Program& program, const ResidentTile& tile, const ResidentSurface& surface);

/// How high a tile rises and how it shines, seen from the front. `lift`: metres that a height of 1
/// lifts a point. `mesh_height`: of the heights in [0,1] as they are seen, where what carries the
/// tile lies.
DetailBlock detail_block(const material::ReliefMaterial& set, const ResidentSurface& surface,
                         float lift, float mesh_height);

/// The same technique over what lies at that height: that is the reference plane of parallax.
scene::Technique over_mesh(scene::Technique technique, float mesh_height);

} // namespace reljef::render
