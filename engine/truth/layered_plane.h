#pragma once

#include <limits>
#include <optional>

#include <glm/vec4.hpp>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/truth/relief_plane.h"

namespace reljef::truth {

/// Two solids over the plane z = 0: between height surfaces 1 and 2, and between 3 and 4. Placement
/// and borders as for ReliefPlane. Visible from both sides. Thread-safe.
class LayeredPlane {
public:
    /// Copies the layers. Fails without texels, on a height outside [0,1] or above the layer before
    /// it, and as check_options().
    static Result<LayeredPlane> create(GridView<const glm::vec4> layers,
                                       const ReliefOptions& options);

    /// Limit of a ray's way, in cells.
    static constexpr int max_cells = 1'000'000;

    /// The first place where a ray enters a solid from outside, t in `range` (begin finite); world
    /// metres. Empty for a ray that is not finite.
    [[nodiscard]] std::optional<ReliefHit>
    first_hit(const Ray& ray,
              Interval range = {0.0, std::numeric_limits<double>::infinity()}) const;

private:
    LayeredPlane() = default;

    ReliefOptions options_;
    Grid<glm::vec4> layers_;
};

} // namespace reljef::truth
