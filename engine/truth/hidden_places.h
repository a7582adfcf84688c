#pragma once

#include <cstddef>

#include "engine/core/hit.h"
#include "engine/terrain/field/surface_caster.h"
#include "engine/truth/geometric_error.h"

namespace reljef::truth {

/// Places of a terrain that a frame shows.
struct ShownPlaces {
    std::size_t shown = 0;  ///< pixels that show terrain
    std::size_t hidden = 0; ///< of these, places that the terrain hides from the eye

    /// Percent of the pixels that show terrain; 0 without any.
    [[nodiscard]] double hidden_percent() const;
};

/// Counts the pixels that show a place (its texel at its bilinear height, clamped at the border)
/// which a ray from the eye does not reach, because it meets the surface before, more than one
/// texel from there. A place behind the eye or without finite numbers counts as hidden. `caster`:
/// of the surface of `view`. `threads` 0: as many as the machine has; no influence on the result.
ShownPlaces hidden_places(const SurfaceView& view, const terrain::SurfaceCaster& caster,
                          const HitBuffer& shown, unsigned threads = 0);

} // namespace reljef::truth
