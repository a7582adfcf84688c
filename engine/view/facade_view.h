#pragma once

#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/core/grid.h"
#include "engine/view/draw_list.h"

namespace reljef::view {

/// A wall for rays and shaders. Samples are columns and rows of the terrain's surface, and
/// directions lie along the axes of GrainView.
struct FacadeTexels {
    glm::vec4 along{0.0F};   ///< xy: sample of the begin; zw: windows per sample
    glm::vec4 storeys{0.0F}; ///< x: windows at the begin; y: eaves, true height; z: storeys in a
                             ///< metre of true height; w: metres in a window
    glm::vec4 facing{0.0F};  ///< xy: the normal; z: share of the sun; w: top, true height
    glm::vec4 plaster{0.0F}; ///< rgb: linear; w: foot, true metres
};

/// What the façades of a terrain look like in a light.
struct FacadeMap {
    /// By sample. x: as terrain::Facades::wall_at; y: true height below which it is in shadow.
    Grid<glm::vec2> samples;
    std::vector<FacadeTexels> walls;
    glm::vec3 sun{0.0F}; ///< radiance at albedo 1 and share 1, linear
    glm::vec3 sky{0.0F}; ///< of an upright wall
};

/// Whether pictures show façades on the terrain: on a plane, without hides_overlay.
bool shows_facades(const scene::TerrainNode& terrain);

/// Precondition: the terrain has façades. Without a light all walls show their plaster.
FacadeMap facade_map(const scene::TerrainSurface& surface, const glm::dmat4& world_from_local,
                     const std::optional<scene::TerrainLight>& light);

} // namespace reljef::view
