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

struct ResidentTile {
    gl::Texture2D color;
    gl::Texture2D normals;
    glm::vec3 mean_color{1.0F}; ///< linear
};
Result<ResidentTile> resident_tile(const material::ReliefMaterial& set, bool wraps,
                                   view::FrameStats& stats);

struct TileSide {
    std::optional<material::LayerKind> layers; ///< empty: the heights
    bool wraps = true;
    bool from_behind = false; ///< 1 − heights

    friend auto operator<=>(const TileSide&, const TileSide&) = default;
};

/// The side of a detail texture that a terrain shows.
inline TileSide ground_side() {
    return {std::nullopt, true, false};
}

/// See material::LayerNormals.
struct LayerTextures {
    gl::Texture2D along_u;
    gl::Texture2D along_v;
};

/// The surface of a tile. Its cells lie between the heights; a wrapping tile also has cells between
/// the last and the first heights.
struct ResidentSurface {
    gl::Texture2D heights; ///< or the four layers
    glm::ivec2 cells{1};
    glm::vec2 rms_rise{0.0F}; ///< height difference per texel along u and v; 0 for layers
    std::optional<LayerTextures> normals;    ///< of layers
    std::optional<gl::Texture2D> max_mipmap; ///< for exact
    std::optional<gl::Texture2D> cones;      ///< for cone
};
Result<ResidentSurface> resident_surface(const material::ReliefMaterial& set, const TileSide& side,
                                         view::FrameStats& stats);
/// Precondition: a surface without layers.
Result<gl::Texture2D> max_mipmap_texture(const material::ReliefMaterial& set, const TileSide& side,
                                         view::FrameStats& stats);
Result<gl::Texture2D> tile_cone_texture(const material::ReliefMaterial& set, const TileSide& side,
                                        view::FrameStats& stats);

} // namespace reljef::render
