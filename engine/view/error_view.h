#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/scene/graph/camera.h"
#include "engine/scene/technique/technique.h"
#include "engine/terrain/field/placement.h"
#include "engine/terrain/mesh/bisection_mesh.h"

namespace reljef::view {

/// Steps per pixel of the grid that rasterizers move vertices onto, in practice.
inline constexpr float vertex_steps = 256.0F;
/// By so much of the error that may be shown, pixels, a triangle may be off by that: half the
/// diagonal of a step, and as much again for what is interpolated in floats.
inline constexpr double rasterizer_error = 1.5 / 256.0;

/// The least and the greatest error that can be asked for, pixels.
inline constexpr double min_error = scene::min_polygons_error;
inline constexpr double max_error = scene::max_polygons_error;

/// Where vertices rise: terrain::ErrorView::morph_from. A smaller share takes more triangles, a
/// greater one lets them rise faster.
inline constexpr double morph_from = 0.5;

/// How a picture of `size` pixels shows displacements of a terrain placed as `kind` in a node: at
/// most `max_error` pixels from where they belong, the rasterizer's own error included.
/// Precondition: max_error > rasterizer_error, world_from_local is affine.
terrain::ErrorView error_view(const scene::Camera& camera, glm::ivec2 size,
                              const glm::dmat4& world_from_local, terrain::PlacementKind kind,
                              double max_error);

} // namespace reljef::view
