#pragma once

#include <limits>
#include <optional>

#include <glm/vec2.hpp>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/material/wrap_mode.h"
#include "engine/terrain/field/min_max_pyramid.h"

namespace reljef::truth {

using Border = material::WrapMode;

struct ReliefOptions {
    double width = 1.0;   ///< metres that texture coordinates 0 … 1 cover, both ways; > 0
    double scale = 0.1;   ///< height of 1, in widths; > 0
    double offset = -1.0; ///< of the heights against the plane, in [−1, 0]: −1 sinks all below it
    Border border = Border::wrap;
};

/// Where a ray meets the relief.
struct ReliefHit {
    glm::dvec2 texture_coordinate{0.0}; ///< in [0,1) (wrap), [0,1] (clamp, discard)
    double height = 0.0;                ///< of the tile there, in [0,1]
    double t = 0.0;                     ///< along the ray
};

/// A height tile over the plane z = 0, centred at the origin: what a relief technique should show.
/// The point of texture coordinate (u, v) and height h is x = (u − ½)·width, y = (½ − v)·width, z =
/// (h + offset)·scale·width: v grows against y, as rows do. Texel (i, j) of an n × m tile has its
/// centre at ((i + ½)/n, (j + ½)/m); between centres the surface is bilinear, across the border
/// into the next copy (wrap) or out of the border's own texels (clamp, discard), as GL samples
/// with REPEAT and CLAMP_TO_EDGE. Safe to ask from several threads.
class ReliefPlane {
public:
    /// Copies the tile; fails on an empty one, on a height outside [0,1] and on an option outside
    /// its range.
    static Result<ReliefPlane> create(GridView<const float> tile, const ReliefOptions& options);

    /// A ray that goes on as far as this between its first place in the slab of heights 0 … 1 and
    /// its hit, in copies of the tile, meets nothing: the work for a grazing ray is bounded.
    static constexpr int max_copies = 4096;

    /// The first crossing from above to below, t in `range` (begin finite); world metres. A ray
    /// that is not finite meets nothing.
    [[nodiscard]] std::optional<ReliefHit>
    first_hit(const Ray& ray,
              Interval range = {0.0, std::numeric_limits<double>::infinity()}) const;

private:
    ReliefPlane() = default;
    [[nodiscard]] Ray on_tile(const Ray& ray) const;
    [[nodiscard]] ReliefHit met(const Ray& tile_ray, double t) const;

    ReliefOptions options_;
    glm::ivec2 texels_{0};
    Grid<float> heights_; // the tile and, wrapped, the first texels of the next copies
    terrain::MinMaxPyramid pyramid_;
};

} // namespace reljef::truth
