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

/// Two solids over a tile, given by four bilinear surfaces with descending heights in [0,1]: solid
/// between 1 and 2, and between 3 and 4; a hole where the two are equal (Policarpo and Oliveira
/// 2006).
class LayerMap {
public:
    /// Empty.
    LayerMap() = default;
    /// Fails without texels, and at the first height outside [0,1] or above the one before it.
    static Result<LayerMap> create(Grid<glm::vec4> heights);

    [[nodiscard]] const Grid<glm::vec4>& heights() const { return heights_; }

private:
    Grid<glm::vec4> heights_;
};

/// A sheet whose thickness is the height, symmetric around its middle; height 0 is a hole (GPU
/// surface-detail survey 2008 ch. 3.6.9). Precondition: not empty, heights in [0,1].
LayerMap symmetric_layers(GridView<const float> heights);

/// A sheet with its own heights on each side of its middle (ch. 3.6.10). Fails as create() and on
/// maps of different sizes.
Result<LayerMap> dual_layers(GridView<const float> front, GridView<const float> back);

/// Solid below the heights. Precondition: not empty, heights in [0,1].
LayerMap filled_layers(GridView<const float> heights);

/// The top of the uppermost solid; 0 without a solid.
Grid<float> top_heights(const LayerMap& layers);

/// The tile from behind: heights h become 1 − h.
LayerMap seen_from_behind(const LayerMap& layers);

/// x (along u) and y (along v) of the four surfaces' outward unit normals. |z| = sqrt(1 - x² - y²);
/// z is positive on surfaces 1 and 3, negative on 2 and 4 (ch. 3.6.11).
struct LayerNormals {
    Grid<glm::vec4> along_u;
    Grid<glm::vec4> along_v;
};
/// From central differences. `scale`: height of 1, in tile widths. Precondition: not empty,
/// scale > 0.
LayerNormals layer_normals(const LayerMap& layers, float scale, WrapMode border);

/// A closed mesh in tile space: x and y are texture coordinates and wrap, z is the height.
/// Triangles are counter-clockwise from outside.
struct TileMesh {
    std::span<const glm::vec3> positions;
    std::span<const std::uint32_t> indices;
};
struct MeshLayers {
    LayerMap layers;
    std::size_t too_many = 0; ///< texels with more than two solids; the outer two are kept
};
/// Samples a mesh along vertical lines through the texel centres, uppermost solid first. A hole has
/// the height of the nearest solid's middle, so that surfaces close towards it. Fails on a height
/// outside [0,1] and on positions beyond 64 copies of the tile. Precondition: cols, rows > 0;
/// indices in range.
Result<MeshLayers> layers_of_mesh(const TileMesh& mesh, int cols, int rows);

} // namespace reljef::material
