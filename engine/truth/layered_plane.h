#pragma once

#include <limits>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/truth/relief_plane.h"

namespace reljef::truth {

/// Where a ray enters a solid.
struct LayeredHit {
    glm::dvec2 texture_coordinate{0.0}; ///< as ReliefHit has it
    double height = 0.0;                ///< in [0,1]
    int layer = 0;                      ///< 0 … 3: the surface that is met
    double t = 0.0;                     ///< along the ray
};

/// Two solids over the plane z = 0, between four height surfaces: the first and the second, the
/// third and the fourth. They lie as those of a ReliefPlane, and end as they do. Seen from either
/// side. Safe to ask from several threads.
class LayeredPlane {
public:
    /// Copies the layers; fails on none, on a height outside [0,1] or above that of the layer
    /// before it, and on an option outside its range.
    static Result<LayeredPlane> create(GridView<const glm::vec4> layers,
                                       const ReliefOptions& options);

    /// A ray that passes through this many cells meets nothing.
    static constexpr int max_cells = 1'000'000;

    /// The first place where a ray that was outside comes inside, t in `range` (begin finite);
    /// world metres. A ray that is not finite meets nothing.
    [[nodiscard]] std::optional<LayeredHit>
    first_hit(const Ray& ray,
              Interval range = {0.0, std::numeric_limits<double>::infinity()}) const;

private:
    LayeredPlane() = default;

    ReliefOptions options_;
    Grid<glm::vec4> layers_;
};

} // namespace reljef::truth
