#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/material/cone_map.h"
#include "engine/material/layer_map.h"
#include "engine/material/wrap_mode.h"

namespace reljef::material {

/// The cones over one side of a tile, made beforehand: over cone_field() of seen_heights().
struct KnownCones {
    WrapMode border = WrapMode::wrap; ///< wrap, or clamp where the tile does not repeat
    bool from_behind = false;
    std::shared_ptr<const ConeMaps> of_field;
};

/// The maps of one tile of surface detail. Texture coordinates (u, v) in [0,1] cover the tile: u
/// grows along the columns, v along the rows, texel (i, j) of an n × m map has its centre at
/// ((i + ½)/n, (j + ½)/m). Maps may differ in size.
struct ReliefMaterial {
    std::string name;
    Image color;
    Grid<float> heights;            ///< in [0,1], 1 is the highest
    Grid<float> back_heights;       ///< off the back of a sheet, of as many texels; empty: none
    std::optional<LayerMap> layers; ///< where one height a place says too little
    Grid<glm::vec3> normals;        ///< unit length, z > 0: x along u, y along v, z off the surface
    std::vector<KnownCones> cones;  ///< those not among them are made when they are needed
    float scale = 0.05F;            ///< of the normals: height of 1, in tile widths
    float specular = 0.10F;  ///< linear, what a surface turned into the mirror direction adds
    float shininess = 32.0F; ///< exponent of Blinn and Phong
    std::vector<std::string> notes; ///< what a person should know about the maps
};

/// What a tile may cover, metres, and how high its relief may be, in tile widths.
inline constexpr double min_tile_width = 1e-3;
inline constexpr double max_tile_width = 1e6;
inline constexpr double max_tile_scale = 10.0;

/// Normals of a tile whose height of 1 lifts a point `scale` tile widths, from central differences
/// over the border: at a texel's centre the mean of the two slopes that the bilinear surface has
/// there, exactly. Precondition: not empty.
Grid<glm::vec3> tile_normals(GridView<const float> heights, float scale, WrapMode border);

/// The heights as a side of the tile shows them: from behind what is left of them to 1.
Grid<float> seen_heights(const Grid<float>& heights, bool from_behind);

/// Whether opposite borders do not fit together: across them the heights differ, in the mean, by
/// more than `seam_limit` times what neighbouring texels differ by. Precondition: not empty.
bool has_seam(GridView<const float> heights);
inline constexpr double seam_limit = 4.0;

/// The set, ready to be drawn: normals are made where there are none; a normal that is none (zero,
/// or not off the surface) becomes (0, 0, 1), with a note; maps of different sizes and borders that
/// do not fit together where the tile is to be repeated get a note. Fails where colours or heights
/// are missing, a height is outside [0,1], or the scale is no number above 0.
Result<ReliefMaterial> completed(ReliefMaterial set, WrapMode border);

/// Which solids a tile's maps say.
enum class LayerKind {
    symmetric, ///< a sheet, its heights on both sides
    dual,      ///< a sheet with other heights on its back; flat there where the set has none
    multi      ///< the set's layers; all below its heights where it has none
};
/// Precondition: as completed() gave it.
LayerMap layers_of(const ReliefMaterial& set, LayerKind kind);

} // namespace reljef::material
