#pragma once

#include <span>
#include <vector>

#include "engine/core/result.h"
#include "engine/geo/georeference.h"

namespace reljef::terrain {

/// A sample of a profile.
struct ProfilePoint {
    double distance = 0.0; ///< from the start, horizontal, metres
    double height = 0.0;   ///< metres; NaN in voids and outside the terrain
};

struct ProfileSummary {
    double distance = 0.0; ///< horizontal, metres
    /// Along the chords between the points, metres: at least `distance`. Parts without a height
    /// count as level.
    double over_ground = 0.0;
    double climb = 0.0;   ///< sum of all rises, metres
    double descent = 0.0; ///< sum of all falls, metres, positive
    double lowest = 0.0;  ///< metres; NaN without heights
    double highest = 0.0;
    int missing = 0; ///< points without a height
};

/// Precondition: at least one point; distances ascend.
ProfileSummary summarize(std::span<const ProfilePoint> points);

inline constexpr int max_profile_points = 10'000'000;

/// Places on the geodesic from one place to another, both included, at equal distances of at most
/// `step` metres. Heights are interpolated. Fails for a step that is not positive, places that are
/// not finite, and more than max_profile_points.
Result<std::vector<geo::Geodetic>> geodesic_places(const geo::Geodetic& from,
                                                   const geo::Geodetic& to, double step);

} // namespace reljef::terrain
