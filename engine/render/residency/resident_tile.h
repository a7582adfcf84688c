#pragma once

#include <compare>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/result.h"
#include "engine/gl/texture.h"
#include "engine/material/relief_material.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// How a tile of detail looks.
struct ResidentTile {
    gl::Texture2D color;
    gl::Texture2D normals;
    glm::vec3 mean_color{1.0F}; ///< linear
};
/// Fails when the driver has no memory left.
Result<ResidentTile> resident_tile(const material::ReliefMaterial& set, bool wraps,
                                   view::FrameStats& stats);

/// Which surface of a tile is looked for.
struct TileSide {
    std::optional<material::LayerKind> layers; ///< none: its heights
    bool wraps = true;
    bool from_behind = false; ///< what is left of its heights to 1

    friend auto operator<=>(const TileSide&, const TileSide&) = default;
};

/// The side of a detail texture that a terrain shows.
inline TileSide ground_side() {
    return {std::nullopt, true, false};
}

/// x and y of the normals of a tile's layers.
struct LayerTextures {
    gl::Texture2D along_u;
    gl::Texture2D along_v;
};

/// The surface of a tile. Of its cells, that is, those between the heights and, where the tile
/// wraps, those between the last and the first: `greatest` is there for the exact technique,
/// `cones` for cone.
struct ResidentSurface {
    gl::Texture2D heights; ///< one a place, or those of the four layers
    glm::ivec2 cells{1};
    glm::vec2 rms_rise{
        0.0F}; ///< of the heights, from sample to sample along u and v; not of layers
    std::optional<LayerTextures> normals; ///< of layers
    std::optional<gl::Texture2D> greatest;
    std::optional<gl::Texture2D> cones;
};
/// Fails when the driver has no memory left.
Result<ResidentSurface> resident_surface(const material::ReliefMaterial& set, const TileSide& side,
                                         view::FrameStats& stats);
/// What the techniques ask for besides. Precondition: a surface without layers.
Result<gl::Texture2D> greatest_texture(const material::ReliefMaterial& set, const TileSide& side,
                                       view::FrameStats& stats);
Result<gl::Texture2D> tile_cone_texture(const material::ReliefMaterial& set, const TileSide& side,
                                        view::FrameStats& stats);

} // namespace reljef::render
