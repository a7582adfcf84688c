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

/// Precomputed cones over cone_field() of visible_heights().
struct KnownCones {
    WrapMode border = WrapMode::wrap; ///< wrap, or clamp where the tile does not repeat
    bool from_behind = false;
    std::shared_ptr<const ConeMaps> of_field;
};

/// The maps of one tile of surface detail. Texture coordinates (u, v) in [0,1] cover the tile: u
/// along the columns, v along the rows; texel (i, j) of an n × m map has its centre at
/// ((i + ½)/n, (j + ½)/m). Maps may differ in size.
struct ReliefMaterial {
    std::string name;
    Image color;
    Grid<float> heights;            ///< in [0,1], 1 is the highest
    Grid<float> back_heights;       ///< back of a sheet, same size as heights; may be empty
    std::optional<LayerMap> layers; ///< several heights per place
    Grid<glm::vec3> normals;        ///< unit length, z > 0: x along u, y along v, z outward
    std::vector<KnownCones> cones;  ///< missing ones are computed when needed
    float scale = 0.05F;            ///< of the normals: height of 1, in tile widths
    float specular = 0.10F;         ///< linear reflectance in the mirror direction
    float shininess = 32.0F;        ///< exponent of Blinn and Phong
    std::vector<std::string> notes; ///< oddities of the maps
};

inline constexpr double min_tile_width = 1e-3; ///< metres
inline constexpr double max_tile_width = 1e6;  ///< metres
inline constexpr double max_tile_scale = 10.0; ///< height of 1, in tile widths

/// Normals of a tile from central differences. `scale`: height of 1, in tile widths. Precondition:
/// not empty.
Grid<glm::vec3> tile_normals(GridView<const float> heights, float scale, WrapMode border);

/// The heights; from behind 1 − heights.
Grid<float> visible_heights(const Grid<float>& heights, bool from_behind);

/// Whether opposite borders do not match: their mean height difference exceeds `seam_limit` times
/// that of neighbouring texels. Precondition: not empty.
bool has_seam(GridView<const float> heights);
inline constexpr double seam_limit = 4.0;

/// The material, ready to draw. Computes missing normals; replaces invalid normals (zero or into
/// the surface) by (0, 0, 1). Adds notes about those, maps of different sizes and seams of a
/// repeated tile. Fails without colours or heights, on a height outside [0,1] and on a scale that
/// is not a number above 0.
Result<ReliefMaterial> completed(ReliefMaterial set, WrapMode border);

/// The solids that a material's maps describe.
enum class LayerKind {
    symmetric, ///< a sheet with the same heights on both sides
    dual,      ///< a sheet with back_heights on its back; flat without them
    multi      ///< the material's layers; without them solid below the heights
};
/// Precondition: `set` is from completed().
LayerMap layers_of(const ReliefMaterial& set, LayerKind kind);

} // namespace reljef::material
