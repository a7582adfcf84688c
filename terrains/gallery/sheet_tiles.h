#pragma once

#include <cstdint>

#include "engine/material/layer_map.h"

namespace reljef::terrains {

/// Rings that hang in each other, those of one row leaning this way, those of the next that way,
/// each through its four neighbours: nowhere more than two over one another. In tile space, `rows`
/// rings along each side in either lean; heights around the middle, in [0,1] where a height of 1
/// lifts a point ring_scale(rows) tile widths.
material::LayerMap ring_layers(int rows, int texels);
float ring_scale(int rows);

} // namespace reljef::terrains
