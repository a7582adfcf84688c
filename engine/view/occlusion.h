#pragma once

#include "engine/view/draw_list.h"

namespace reljef::view {

/// Leaves out the tiles of a terrain that lie behind nearer ground of the same terrain, as seen in
/// perspective by an eye over it: none of their pixels would be seen (terrain/horizon.h); of
/// streamed terrains those that were found to do so as they were chosen (tile_selection.h).
/// Terrains on an ellipsoid, tiles whose levels go by distance, and wireframes are left as they
/// are. Counts them.
void drop_occluded(DrawList& list);

} // namespace reljef::view
