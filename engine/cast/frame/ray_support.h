#pragma once

#include <string>

#include "engine/core/result.h"
#include "engine/view/draw_list.h"

namespace reljef::cast {

/// Whether rays draw terrains with a technique: `exact`, or an error bound, which they keep;
/// without options, except hard shadows and the depth of hits.
bool draws_technique(const scene::Technique& technique);

/// What rays on the CPU cannot draw of a terrain with a technique; empty if they draw it.
std::string obstacle_of(const scene::TerrainNode& terrain, const scene::Technique& technique);

/// The same of a mesh: rays draw its colour, or the colours of a texture that repeats.
std::string obstacle_of(const scene::MeshNode& mesh);

/// The same of a list, which has at most one terrain.
std::string obstacle_of(const view::DrawList& list);
/// The same where OpenGL may draw instead: also what its triangles keep drawing faster within the
/// technique's error bound. Their first frame may take longer.
std::string obstacle_beside_triangles(const view::DrawList& list);
/// Fails if there is an obstacle.
Result<void> check_support(const view::DrawList& list);

} // namespace reljef::cast
