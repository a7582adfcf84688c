#pragma once

#include <span>
#include <vector>

#include "engine/terrain/field/placement.h"
#include "engine/terrain/mesh/bisection_mesh.h"
#include "engine/terrain/mesh/tile_layout.h"

namespace reljef::terrain {

/// Walls that hang from the border of a tile. Tiles of one terrain show its border within their
/// errors, whatever their triangles. So walls as deep as two errors close all gaps, and show no
/// point farther from its true height than the errors.
struct Skirt {
    double depth = 0.0; ///< scene metres along the vertical
    /// More depth for errors of the view: metres per metre from the eye, seen from the side.
    double slope = 0.0;
    glm::dvec3 eye{0.0}; ///< scene metres
    // The sides with walls.
    bool north = true;
    bool east = true;
    bool south = true;
    bool west = true;

    [[nodiscard]] bool is_empty() const { return depth <= 0.0 && slope <= 0.0; }
    friend bool operator==(const Skirt&, const Skirt&) = default;
};

/// The walls below all border edges of a tile's triangles, seen from outside, in parts of 16-bit
/// indices. Their upper vertices are those of the border, the lower ones move down.
std::vector<Triangulation> skirt_below(std::span<const Triangulation> parts, const Tile& tile,
                                       const Heightfield& heightfield, const Placement& placement,
                                       const Skirt& skirt);

/// The same below a vertex at every sample of the border.
std::vector<Triangulation> skirt_below_samples(const Tile& tile, const Heightfield& heightfield,
                                               const Placement& placement, const Skirt& skirt);

} // namespace reljef::terrain
