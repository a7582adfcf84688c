#include "engine/terrain/measure/sight.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace reljef::terrain {
namespace {

bool is_finite_place(glm::dvec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

} // namespace

std::optional<SurfaceHit> obstacle_between(const SurfaceCaster& surface, glm::dvec3 eye,
                                           glm::dvec3 target) {
    if (!is_finite_place(eye) || !is_finite_place(target) || eye == target) {
        return std::nullopt;
    }
    return surface.first_hit({eye, target - eye}, {0.0, 1.0});
}

std::optional<Grid<std::uint8_t>> viewshed(const Heightfield& heightfield,
                                           const MinMaxPyramid& pyramid, const Placement& placement,
                                           glm::dvec3 eye, const ViewshedOptions& options) {
    const GridView<const float> heights = heightfield.heights.view();
    const SurfaceCaster caster(heights, pyramid, placement);
    const double ground = bilinear_height(heights, glm::dvec2(eye));
    const glm::dvec3 from =
        placement.world_from_sample({eye.x, eye.y, std::max(eye.z, ground + sight_tolerance)});
    const glm::dvec3 up = placement.up(from);
    Grid<std::uint8_t> seen(heights.cols(), heights.rows());
    const auto look = [&](int col, int row) {
        SeenState found = SeenState::unknown;
        if (heightfield.void_mask.empty() || heightfield.void_mask(col, row) == 0) {
            const double height = heights(col, row) + options.target_height + sight_tolerance;
            const glm::dvec3 target = placement.world_from_sample({col, row, height});
            const glm::dvec3 way = target - from;
            const double level = glm::length(way - glm::dot(way, up) * up);
            const bool is_seen =
                level <= options.max_distance && !obstacle_between(caster, from, target);
            found = is_seen ? SeenState::visible : SeenState::hidden;
        }
        seen(col, row) = static_cast<std::uint8_t>(found);
    };
    const bool is_done = for_each_cell(heights.cols(), heights.rows(), options.parallel, look);
    return is_done ? std::optional(std::move(seen)) : std::nullopt;
}

} // namespace reljef::terrain
