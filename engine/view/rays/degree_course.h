#pragma once

#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/geo/georeference.h"
#include "engine/terrain/field/placement.h"

namespace reljef::view {

/// The samples of a terrain that is even in degrees, for places relative to an eye. All of it is in
/// differences from the eye, which floats keep to a few units of 2^-24 of the way from it: around
/// poles, across all of the Earth, and near the ground.
///
/// In the plane of a meridian, a place is (a + K)·X from the axis and (b + K·a/b)·Z along it, where
/// (X, Z) is on the unit circle, a and b are the radii of the Earth, and K, its lift, is its height
/// over the length of (X, Z·a/b): that vector is normal to the ellipsoid. Newton's method finds K.
struct DegreeCourse {
    /// To metres away from the axis at the eye's meridian, to its east, and along the axis north.
    glm::dmat3 axes_from_relative{1.0};
    double from_axis = 0.0;    ///< of the eye, metres
    glm::dvec2 circle{0.0};    ///< X and Z of the eye
    double lift = 0.0;         ///< of the eye, metres
    double first_lift = 0.0;   ///< relative to the eye's, where Newton's method begins, metres
    double exaggeration = 1.0; ///< of heights
    glm::dvec3 eye{0.0};       ///< its col, even row (WrappedRows), and height in true metres
    /// (col, even row) per radian of latitude, and of longitude.
    glm::dmat2 samples_a_radian{1.0};
    double first_longitude = 0.0; ///< columns follow a turn from here, from the eye's, radians
    geo::WrappedRows rows;        ///< of the terrain

    /// Col, row and height in true metres of a place from the eye, in world metres.
    [[nodiscard]] glm::dvec3 sample(glm::dvec3 relative) const;
    /// The same with floats, up to the turns of columns, as shaders compute it.
    [[nodiscard]] glm::dvec3 sample_in_floats(glm::dvec3 relative) const;
};

/// Metres below the ellipsoid to which the method is certain to converge.
inline constexpr double max_depth_of_degrees = 1e5;

/// `eye`: local metres. `middle_column`: columns of a terrain that covers all longitudes follow
/// half a turn on both sides of it; others do so around their own. Empty for terrains that are not
/// even in degrees, or have a geoid, and for eyes below max_depth_of_degrees.
std::optional<DegreeCourse> degree_course(glm::dvec3 eye, const glm::dmat3& local_from_world,
                                          const terrain::Placement& placement,
                                          double middle_column);

} // namespace reljef::view
