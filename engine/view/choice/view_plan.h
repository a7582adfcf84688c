#pragma once

#include <limits>
#include <vector>

#include "engine/view/choice/technique_costs.h"

namespace reljef::view {

/// What a terrain's tiles in a view cost, by their ring: tiles around the one below the eye have
/// ring 1, those around these ring 2.
struct RingCost {
    int ring = 0;
    double triangles = 0.0;
    double pixels = 0.0;         ///< of the picture that it covers
    double seen_triangles = 0.0; ///< of tiles that probes hit
};

/// Which part of a view is drawn as triangles.
struct ViewPlan {
    /// Tiles up to this ring are triangles, and rays draw all pixels that these leave; -1: rays
    /// alone. At least the last ring: triangles alone.
    int last_ring = -1;
    double triangles = 0.0;
    double touched_pixels = 0.0; ///< see TechniqueCosts::touched_pixel_ns
    double ray_pixels = 0.0;
    double ms = 0.0; ///< estimated
};

/// What plans are made of.
struct ViewCosts {
    std::vector<RingCost> rings; ///< ascending
    double box_pixels = 0.0;     ///< that show the box around the terrain
    int samples_of_rays = 1;     ///< per pixel of a picture by rays alone
    int samples_of_both = 1;     ///< per pixel of a picture with triangles, too
    double max_triangles = std::numeric_limits<double>::infinity(); ///< that fit the memory
};
/// Estimates the plan up to a ring.
ViewPlan plan_up_to(int ring, const ViewCosts& view, const TechniqueCosts& costs);
/// The cheapest whose triangles fit, but both only if they save a quarter. Precondition: there are
/// rings.
ViewPlan cheapest_plan(const ViewCosts& view, const TechniqueCosts& costs);
/// The cheaper of triangles alone, if they fit, and rays alone. Precondition: there are rings.
ViewPlan cheaper_alone(const ViewCosts& view, const TechniqueCosts& costs);

} // namespace reljef::view
