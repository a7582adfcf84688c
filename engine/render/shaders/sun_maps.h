#pragma once

#include <cstddef>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/core/geometry.h"
#include "engine/view/draw_list.h"

namespace reljef::render {

struct MeshShadowBlock;

/// A part of the picture's depths, seen from the sun in parallel: an orthographic depth map of the
/// meshes that may shade what is seen there.
struct SunMap {
    /// To x and y in [0, 1] and a depth of 1 at the caster nearest to the sun and 0 at the farthest
    /// one, from world directions relative to the eye, metres.
    glm::dmat4 map_from_relative{1.0};
    double texel = 0.0;  ///< the diagonal of a texel, metres across the sun's rays
    double metres = 0.0; ///< of a depth of 1
};

/// Of a picture. The nearest to the eye is the first; they lie in a square of two by two.
inline constexpr std::size_t max_sun_maps = 4;

/// Whether a terrain casts and shows shadows of rays: by `shadow=` of its technique.
bool casts_shadows(const view::TerrainDraw& draw);

/// Whether shadows of meshes are requested: by casts_shadows() of a terrain, with a sun above the
/// horizon.
bool casts_mesh_shadows(const view::DrawList& list);

/// Meshes that hide the sun from what the picture shows. Empty: no shadows are requested, or
/// there are no meshes, or all their shadows are outside of the picture. All parts of a picture
/// have the same maps. `side`: of a map, texels.
std::vector<SunMap> sun_maps(const view::DrawList& list, int side);

/// Whether a mesh casts a shadow: hulls of detail, inner sides, and layers, which have holes, do
/// not.
bool is_shadow_caster(const view::MeshDraw& draw);

/// The list's meshes that cast shadows, also those beside the picture.
std::vector<view::MeshDraw> shadow_casters(const view::DrawList& list);

/// Of the maps. Precondition: at most max_sun_maps.
MeshShadowBlock mesh_shadow_block(const std::vector<SunMap>& maps);

} // namespace reljef::render
