#pragma once

#include "engine/core/grid.h"
#include "engine/material/cone_map.h"
#include "engine/material/wrap_mode.h"

namespace reljef::material {

/// What the cones over a tile are made from: its heights, and where it wraps as much of its next
/// copies around them as a quarter of its shorter side. Precondition: not empty.
Grid<float> cone_field(GridView<const float> heights, WrapMode border);

/// The cones over the tile itself out of those over its field, no wider than the field reaches:
/// those that a ray may trust in any copy. Cells as of ConeMaps; where the tile wraps there is one
/// for each texel, the last between it and the first of the next copy. Where it does not, relaxed
/// cones are plain ones: beyond the border, drawn out, the surface may fall where it rises on the
/// tile. Where it wraps, cones_at_samples() of the field gives those at the texels.
Grid<float> tile_cones(const Grid<float>& of_field, int cols, int rows, WrapMode border);
ConeMaps tile_cones(const ConeMaps& of_field, int cols, int rows, WrapMode border);

} // namespace reljef::material
