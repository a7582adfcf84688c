#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/cast/beam.h"
#include "engine/core/geometry.h"
#include "engine/geo/georeference.h"
#include "engine/view/draw_list.h"

namespace reljef::cast {

/// What a picture shows of a terrain.
struct SeenTerrain {
    const scene::TerrainNode* node = nullptr;
    glm::dmat4 world_from_local{1.0};
    Box local;              ///< around all ground that is drawn, metres
    Box samples;            ///< the same in samples of the terrain's surface and metres of height
    bool has_tiles = false; ///< those of a stream, not the samples of its surface
    /// On the ellipsoid, of a terrain that covers all longitudes: its columns; else 0. The boxes
    /// are then those of what the eye may see.
    double columns_around = 0.0;
    /// Of such a terrain: the eye is below all ground, and the boxes are those of all of it.
    bool is_from_below = false;
    bool has_pole = false; ///< of such a terrain: a pole lies in the picture, or near it
};

/// On the ellipsoid, the rows of a terrain's surface: SeenTerrain::samples are even. On a plane
/// they are not.
geo::WrappedRows rows_of(const scene::TerrainNode& node);

/// Its streamed tiles in a list, drawn or searched.
std::vector<const scene::TerrainTile*> tiles_in(const view::DrawList& list,
                                                const scene::TerrainNode& terrain);

/// The terrains of a list, each once.
std::vector<SeenTerrain> seen_terrains(const view::DrawList& list);

/// The error that a frame keeps, pixels: that of the proven tile that is farthest off, and of the
/// rays (`of_rays`). Empty: none is proven.
std::optional<double> kept_error(const view::DrawList& list, double of_rays);

bool is_curved(const scene::TerrainNode& node);

std::array<glm::dvec3, 8> corners_of(const Box& box);

/// A rectangle of a picture of `size` pixels around all that is seen of a convex body with these
/// corners; all of the picture if it reaches behind the eye.
PixelBlock seen_pixels(const glm::dmat4& clip_from_local, glm::ivec2 size,
                       const std::array<glm::dvec3, 8>& corners);

} // namespace reljef::cast
