#include "engine/view/choice/view_plan.h"

#include <algorithm>
#include <cmath>

namespace reljef::view {
namespace {

constexpr double ns_a_ms = 1e6;
// Both must promise to save a quarter: the rays that remain are those of what is far, which are the
// longest, and views that change between plans cut tiles again. Measured up to 1.25 of the
// estimate.
constexpr double max_share_of_both = 0.75;
// Triangles that cost up to that share more are drawn, too: a view at rest keeps them.
constexpr double tie = 1.05;

} // namespace

ViewPlan plan_up_to(int ring, const ViewCosts& view, const TechniqueCosts& costs) {
    ViewPlan plan{.last_ring = ring};
    double covered = 0.0;
    bool is_all = true;
    for (const RingCost& cost : view.rings) {
        if (cost.ring > ring) {
            is_all = false;
            continue;
        }
        plan.triangles += cost.triangles;
        plan.touched_pixels += std::sqrt(cost.triangles * cost.pixels);
        covered += cost.pixels;
    }
    const int samples = plan.triangles > 0.0 ? view.samples_of_both : view.samples_of_rays;
    const int further = samples - 1;
    plan.ms = costs.frame_ms + further * costs.frame_sample_ms +
              (plan.triangles * costs.triangle_ns +
               plan.touched_pixels * (costs.touched_pixel_ns + further * costs.touched_sample_ns) +
               covered * (costs.covered_pixel_ns + further * costs.covered_sample_ns)) /
                  ns_a_ms;
    if (!is_all) {
        plan.ray_pixels = std::max(view.box_pixels - covered, 0.0);
        plan.ms += costs.rays_ms + plan.ray_pixels * samples * costs.ray_pixel_ns / ns_a_ms;
    }
    return plan;
}

ViewPlan cheaper_alone(const ViewCosts& view, const TechniqueCosts& costs) {
    const ViewPlan rays = plan_up_to(-1, view, costs);
    const ViewPlan triangles = plan_up_to(view.rings.back().ring, view, costs);
    return triangles.ms <= tie * rays.ms && triangles.triangles <= view.max_triangles ? triangles
                                                                                      : rays;
}

ViewPlan cheapest_plan(const ViewCosts& view, const TechniqueCosts& costs) {
    ViewPlan best = cheaper_alone(view, costs);
    double limit = max_share_of_both * best.ms;
    for (const RingCost& last : view.rings) {
        const ViewPlan plan = plan_up_to(last.ring, view, costs);
        if (plan.ms < limit && plan.triangles <= view.max_triangles) {
            best = plan;
            limit = plan.ms;
        }
    }
    return best;
}

} // namespace reljef::view
