#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/material/wrap_mode.h"

namespace reljef::material {

/// Two solids, one over the other, by their four surfaces over one tile: heights in [0,1], each
/// nowhere above the one before it. What lies between the first and the second, and between the
/// third and the fourth, is solid; where two such are equal there is a hole (Policarpo and Oliveira
/// 2006). Between texel centres the surfaces are bilinear.
class LayerMap {
public:
    /// None.
    LayerMap() = default;
    /// Fails on no texels, and where a height is outside [0,1] or above the one before it, with the
    /// first such place.
    static Result<LayerMap> create(Grid<glm::vec4> heights);

    [[nodiscard]] const Grid<glm::vec4>& heights() const { return heights_; }

private:
    Grid<glm::vec4> heights_;
};

/// A sheet as thick as the heights say, half of it on each side of its middle: height 0 is a hole
/// (GPU surface-detail survey 2008 ch. 3.6.9). Precondition: heights in [0,1], at least one.
LayerMap symmetric_layers(GridView<const float> heights);

/// A sheet with its own heights on each side of its middle, `back` off the back (ch. 3.6.10). Fails
/// as create, and on maps of different sizes.
Result<LayerMap> dual_layers(GridView<const float> front, GridView<const float> back);

/// All below the heights is solid. Precondition: heights in [0,1], at least one.
LayerMap filled_layers(GridView<const float> heights);

/// What is seen from straight above: the uppermost solid; 0 where there is none.
Grid<float> top_heights(const LayerMap& layers);

/// The tile seen from behind: what was lowest is highest.
LayerMap seen_from_behind(const LayerMap& layers);

/// x and y of the four surfaces' unit normals, off the solid; z is positive on the first and the
/// third, negative on the others (ch. 3.6.11): sqrt(1 - x² - y²). x along u, y along v.
struct LayerNormals {
    Grid<glm::vec4> along_u;
    Grid<glm::vec4> along_v;
};
/// From central differences over the border, of a height of 1 that lifts a point `scale` tile
/// widths. Precondition: not empty, scale > 0.
LayerNormals layer_normals(const LayerMap& layers, float scale, WrapMode border);

/// A closed mesh in tile space: x and y are texture coordinates, z the height; what lies beyond the
/// tile counts in the next copy. Every three indices are one triangle, counter-clockwise from the
/// outside.
struct TileMesh {
    std::span<const glm::vec3> positions;
    std::span<const std::uint32_t> indices;
};
struct MeshLayers {
    LayerMap layers;
    /// Texels under more than two solids: the highest and the lowest are kept.
    std::size_t too_many = 0;
};
/// What plumb lines through the texel centres meet of it, the uppermost solid first. A hole lies
/// where the middle of the solid next to it does, so that surfaces close on their way there. Fails
/// where a height is outside [0,1] or a place is farther than 64 copies of the tile. Precondition:
/// cols, rows > 0, indices below the positions.
Result<MeshLayers> layers_of_mesh(const TileMesh& mesh, int cols, int rows);

} // namespace reljef::material
