#pragma once

#include <stop_token>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/grid.h"
#include "engine/material/normal_map.h"

namespace reljef::material {

struct IntegrationOptions {
    glm::dvec2 spacing{1.0};           ///< between samples, > 0; the heights come out in its unit
    WrapMode border = WrapMode::clamp; ///< discard is as clamp
    /// Ends once what is wrong with the equations is this much smaller than at first (both as the
    /// root of a sum of squares), or after so many rounds.
    double reduction = 1e-8;
    int max_rounds = 200;
    std::stop_token stop = {}; ///< no new round begins once a stop is asked for
};

struct IntegratedHeights {
    Grid<float> heights;    ///< their mean is 0
    double remaining = 0.0; ///< how much smaller what is wrong has become; 0 where nothing was
    int rounds = 0;
};

/// The heights whose differences between neighbouring samples come nearest, in the least squares,
/// to what the normals ask for: half of each of the two samples' slopes (the problem of Frankot and
/// Chellappa 1988, without their waves: any border, any size). Clamped, nothing is asked across the
/// border. Wrapped, the last sample's neighbour is the first: a slope all along, which no closed
/// surface has, is spread out. A normal that is not finite or not above the plane counts as level.
///
/// Against heights whose normals were found with NormalFilter::bilinear a wave of ω radians a
/// sample loses at most the share sin²(ω/2): central differences and means see the short ones
/// weaker.
///
/// By conjugate gradients on a pyramid of 2×2 sums (Notay 2010): the time is that of some dozens of
/// sweeps over the map. Precondition: not empty, spacing > 0.
IntegratedHeights heights_from_normals(GridView<const glm::vec3> normals,
                                       const IntegrationOptions& options = {});

} // namespace reljef::material
