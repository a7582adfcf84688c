#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/grid.h"
#include "engine/material/wrap_mode.h"

namespace reljef::material {

enum class NormalFilter {
    bilinear, ///< central differences: the mean gradient of the four bilinear cells around a sample
    sobel     ///< 3×3: smoother, blurs details one sample wide
};

struct NormalOptions {
    glm::dvec2 spacing{1.0}; ///< between samples, in the heights' unit, > 0
    NormalFilter filter = NormalFilter::bilinear;
    WrapMode border = WrapMode::clamp; ///< discard equals clamp
};

/// Unit normals of a height surface at its samples: x east, y north, z up. At a clamped border the
/// slope across it is half that of the border cell. Precondition: not empty, all finite.
Grid<glm::vec3> normals_from_heights(GridView<const float> heights,
                                     const NormalOptions& options = {});

} // namespace reljef::material
