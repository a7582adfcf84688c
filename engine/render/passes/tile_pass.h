#pragma once

#include "engine/gl/program.h"
#include "engine/material/relief_material.h"
#include "engine/render/residency/resident_tile.h"
#include "engine/render/shaders/uniform_blocks.h"
#include "engine/scene/technique/technique.h"

namespace reljef::render {

void bind_tile(gl::Program& program, const ResidentTile& tile, const ResidentSurface& surface);

/// Relief and reflection of a tile seen from the front. `lift`: height of 1, metres. `mesh_height`:
/// height of the carrying surface among the visible heights in [0,1].
DetailBlock detail_block(const material::ReliefMaterial& set, const ResidentSurface& surface,
                         float lift, float mesh_height);

/// The technique with `mesh_height` as the reference plane of parallax.
scene::Technique over_mesh(scene::Technique technique, float mesh_height);

} // namespace reljef::render
