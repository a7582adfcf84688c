#pragma once

#include <stop_token>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/grid.h"
#include "engine/material/normal_map.h"

namespace reljef::material {

struct IntegrationOptions {
    glm::dvec2 spacing{1.0};           ///< between samples, > 0; also the unit of the heights
    WrapMode border = WrapMode::clamp; ///< discard equals clamp
    std::stop_token stop = {};
};

struct IntegratedHeights {
    Grid<float> heights;    ///< mean 0
    double remaining = 0.0; ///< final residual / initial residual; 0 without an initial one
    int rounds = 0;
};

/// Least-squares heights: the differences between neighbouring samples approximate the mean of the
/// two samples' slopes from the normals (the problem of Frankot and Chellappa 1988, without their
/// Fourier basis). clamp: no equations across the border. wrap: the last sample's neighbour is the
/// first; a constant slope, which a closed surface cannot have, is distributed. A normal that is
/// not finite or not above the plane counts as level.
///
/// For normals from NormalFilter::bilinear a wave of ω radians per sample loses at most the share
/// sin²(ω/2).
///
/// Conjugate gradients with a multigrid preconditioner of 2×2 blocks (Notay 2010), until the
/// residual has fallen by 1e-8 or after 200 rounds. Takes as long as some dozens of sweeps over the
/// map. Precondition: not empty, spacing > 0.
IntegratedHeights heights_from_normals(GridView<const glm::vec3> normals,
                                       const IntegrationOptions& options = {});

} // namespace reljef::material
