#pragma once

#include "engine/gl/program.h"
#include "engine/material/texture_set.h"
#include "engine/render/residency/resident_tile.h"
#include "engine/scene/technique/technique.h"

namespace reljef::render {

/// Binds the maps of a tile to where the programs that show it have them (tile_light.glsl,
/// relief_surface.glsl).
void bind_tile(gl::Program& program, const ResidentTile& tile, const ResidentSurface& surface);

/// Sets how high and how it shines. `lift`: metres that a height of 1 lifts a point, > 0.
/// `mesh_height`: of the heights in [0,1] as they are seen, where what carries the tile lies.
void set_tile_look(gl::Program& program, const material::TextureSet& set, float lift,
                   float mesh_height);

/// The same technique over what lies at that height: that is the reference plane of parallax.
scene::Technique over_mesh(scene::Technique technique, float mesh_height);

} // namespace reljef::render
