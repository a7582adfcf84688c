#pragma once

#include "engine/view/draw_list.h"

namespace reljef::view {

/// Drops tiles behind nearer ground of the same terrain (terrain/field/horizon.h), or behind the
/// curved Earth (terrain/field/earth_horizon.h), and hidden streamed tiles. Keeps tiles with levels
/// by distance, and wireframes.
void drop_occluded(DrawList& list);

} // namespace reljef::view
