#pragma once

#include "engine/terrain/field/heightfield.h"
#include "terrains/urban/urban_city.h"

namespace reljef::terrains::urban {

/// The nearest 8-bit colour; channels outside [0,1] are clamped.
Rgba8 encoded(const Color& color);

struct HollowOptions {
    float spacing = 0.5F;  ///< metres between samples
    bool tileable = false; ///< what lies beyond an edge: the other side, or the edge itself
    unsigned threads = 0;
};

/// Soft ambient occlusion: samples that lie below what is around them get darker, by walls
/// 1.6 m away and by the averages of the heights over about 10 and 32 m. No direction, no shadow.
void darken_hollows(terrain::Terrain& terrain, const HollowOptions& options);

} // namespace reljef::terrains::urban
