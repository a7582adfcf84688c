#pragma once

#include <cstddef>

#include "engine/terrain/field/heightfield.h"

namespace reljef::terrain {

/// A preview of the same ground: at most `max_samples` samples (at least 2 a side) between those of
/// `terrain`, with its corners, range and colours. If they are fewer, their `reduction` is above 1.
/// Preconditions: at least 2 samples a side; it does not close around the Earth (GlobalWrap).
Terrain coarse_terrain(const Terrain& terrain, std::size_t max_samples);

} // namespace reljef::terrain
