#pragma once

#include <cstddef>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/material/wrap_mode.h"

namespace reljef::material {

/// How a slope is found from heights.
enum class NormalFilter {
    /// The mean of the bilinear surface's exact gradients in the four cells around a sample, there:
    /// central differences.
    bilinear,
    /// Sobel's 3×3: smoother, and blurs what is a sample wide.
    sobel
};

struct NormalOptions {
    glm::dvec2 spacing{1.0}; ///< between samples, in the heights' unit, > 0
    NormalFilter filter = NormalFilter::bilinear;
    WrapMode border = WrapMode::clamp; ///< discard is as clamp
};

/// Unit normals of a height surface at its samples: x east, y north, z up. At a clamped border the
/// slope across it is half that of the one cell there is. Precondition: not empty, all finite.
Grid<glm::vec3> normals_from_heights(GridView<const float> heights,
                                     const NormalOptions& options = {});

/// The normal of the bilinear surface itself between the samples, exact: x east, y north, z up.
/// `place` is (col, row), inside the grid. Precondition: at least 2×2 samples.
glm::dvec3 bilinear_normal(GridView<const float> heights, glm::dvec2 place, glm::dvec2 spacing);

/// Normals as colours: (n + 1) / 2 in r, g, b, and heights in [0,1], clamped, in a. 8 bits: a
/// height of 1 is cut into 255 quanta. Precondition: of one size, or no heights (a is 255).
Image normal_image(GridView<const glm::vec3> normals, GridView<const float> unit_heights = {});

/// The unit normals of such a picture; one of no length, or that does not point up, is (0, 0, 1)
/// and counted.
struct ReadNormals {
    Grid<glm::vec3> normals;
    std::size_t unusable = 0;
};
ReadNormals normals_from_image(const Image& image);

} // namespace reljef::material
