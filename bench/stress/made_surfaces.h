#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/terrain/field/heightfield.h"

namespace reljef::bench {

using HeightAt = std::function<double(int col, int row)>;

/// A terrain of heights by a formula; spacing in metres.
terrain::Terrain made_terrain(std::string name, glm::ivec2 size, double spacing,
                              const HeightAt& height_at);

/// Smooth hills of up to ±`height` metres, a few dozen samples wide.
terrain::Terrain made_hills(glm::ivec2 size, double spacing, double height);

/// Heightfields that break searches: level, a spike, a checkerboard, cliffs, noise, 2×2, a strip, a
/// long strip, a prime size.
std::vector<terrain::Terrain> odd_terrains();

} // namespace reljef::bench
