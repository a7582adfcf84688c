#pragma once

#include "engine/core/grid.h"
#include "engine/material/cone_map.h"
#include "engine/material/wrap_mode.h"

namespace reljef::material {

/// The heights from which a tile's cones are computed; a wrapping tile gets a margin from its next
/// copies, a quarter of its shorter side wide. Precondition: not empty.
Grid<float> cone_field(GridView<const float> heights, WrapMode border);

/// The cones of a tile, cut from the cones of its field and limited to the field's margin. Cells as
/// in ConeMaps; a wrapping tile has one cell per texel, the last one between it and the next copy.
/// A tile that does not wrap gets plain cones for relaxed ones: the surface may fall beyond the
/// border. Also works on cones_at_samples() of a wrapping tile's field.
Grid<float> tile_cones(const Grid<float>& of_field, int cols, int rows, WrapMode border);
ConeMaps tile_cones(const ConeMaps& of_field, int cols, int rows, WrapMode border);

} // namespace reljef::material
