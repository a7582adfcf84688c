#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/material/wrap_mode.h"
#include "engine/terrain/field/min_max_pyramid.h"

namespace reljef::truth {

using Border = material::WrapMode;

struct ReliefOptions {
    double width = 1.0;   ///< metres per texture coordinate along u and v; > 0
    double scale = 0.1;   ///< height of 1, in widths; > 0
    double offset = -1.0; ///< added to the heights, in [−1, 0]; −1: all below the plane
    Border border = Border::wrap;
};

/// Fails when an option is outside its range.
Result<void> check_options(const ReliefOptions& options);

struct ReliefHit {
    glm::dvec2 texture_coordinate{0.0}; ///< in [0,1) (wrap), [0,1] (clamp, discard)
    double height = 0.0;                ///< in [0,1]
    double t = 0.0;
    int layer = 0; ///< of a LayeredPlane, 0 … 3: the surface
};

/// A world ray in tile space: texels from the first texel's centre, and height.
Ray tile_ray(const Ray& ray, glm::ivec2 texels, const ReliefOptions& options);

/// The hit at `t` of a ray in tile space.
ReliefHit hit_at(const Ray& tile_ray, double t, glm::ivec2 texels, Border border);

/// Calls visit(square, interval) for the squares of `size` texels along a ray in tile space until
/// it returns a value, for at most `max_squares`. Precondition: range.begin is finite.
template <class Visit>
auto first_in_squares(const Ray& ray, glm::dvec2 size, Interval range, int max_squares,
                      const Visit& visit) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    glm::dvec2 square = glm::floor(glm::dvec2(ray.at(range.begin)) / size);
    const auto exit_time = [&](int axis) {
        const double direction = ray.direction[axis];
        const double border = (square[axis] + (direction > 0.0 ? 1.0 : 0.0)) * size[axis];
        return direction == 0.0 ? infinity : (border - ray.origin[axis]) / direction;
    };
    decltype(visit(square, range)) found;
    double t = range.begin;
    for (int count = 0; count < max_squares && t < range.end && !found; ++count) {
        const glm::dvec2 exit{exit_time(0), exit_time(1)};
        const double end = std::min({exit.x, exit.y, range.end});
        if (end == infinity) {
            break; // the ray has no direction
        }
        found = visit(square, Interval{t, std::max(t, end)});
        square.x += exit.x <= end ? std::copysign(1.0, ray.direction.x) : 0.0;
        square.y += exit.y <= end ? std::copysign(1.0, ray.direction.y) : 0.0;
        t = std::max(t, end);
    }
    return found;
}

/// The true surface of a relief technique: a height tile over the plane z = 0, centred at the
/// origin. Texture coordinate (u, v) and height h lie at x = (u − ½)·width, y = (½ − v)·width,
/// z = (h + offset)·scale·width. Texel (i, j) of an n × m tile has its centre at ((i + ½)/n,
/// (j + ½)/m). The surface is bilinear between centres, with GL's REPEAT (wrap) or CLAMP_TO_EDGE
/// (clamp, discard) at the border. Thread-safe.
class ReliefPlane {
public:
    /// Copies the tile. Fails on an empty tile, a height outside [0,1] and as check_options().
    static Result<ReliefPlane> create(GridView<const float> tile, const ReliefOptions& options);

    /// Limit of a ray's way through the slab of heights 0 … 1, in copies of the tile.
    static constexpr int max_copies = 4096;

    /// The first crossing from above to below, t in `range` (begin finite); world metres. Empty for
    /// a ray that is not finite.
    [[nodiscard]] std::optional<ReliefHit>
    first_hit(const Ray& ray,
              Interval range = {0.0, std::numeric_limits<double>::infinity()}) const;

private:
    ReliefPlane() = default;

    ReliefOptions options_;
    glm::ivec2 texels_{0};
    Grid<float> heights_; // wrap: with the first texels of the next copies
    terrain::MinMaxPyramid pyramid_;
};

} // namespace reljef::truth
