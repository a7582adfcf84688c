#include "engine/view/rays/degree_course.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::view {
namespace {

// Of an eye; above it, Newton's method begins at the ellipsoid.
constexpr double max_near_height = 1e5; // metres

// Of a place, from an eye.
template <class T> struct TurnAndRise {
    T latitude;  // radians
    T longitude; // radians
    T height;    // metres
};

template <class T>
TurnAndRise<T> turn_and_rise(const DegreeCourse& course, const glm::vec<3, T>& way) {
    using Pair = glm::vec<2, T>;
    const Pair earth(geo::radii_of_earth());
    const Pair flattened(T(1), earth.x / earth.y);
    const Pair circle(course.circle);
    const T lift_of_eye = static_cast<T>(course.lift);
    const T eye_from_axis = static_cast<T>(course.from_axis);
    const T x = eye_from_axis + way.x;
    const T from_axis = std::hypot(x, way.y);
    const T away = (way.x * (eye_from_axis + x) + way.y * way.y) /
                   std::max(from_axis + eye_from_axis, std::numeric_limits<T>::min());
    const Pair shift(away, way.z); // from and along the axis

    T lift = static_cast<T>(course.first_lift); // from the eye's
    Pair change(T(0));                          // of the circle
    const auto follow = [&] {
        const Pair radii = earth + flattened * (lift_of_eye + lift);
        change = (shift - circle * flattened * lift) / radii;
        return radii;
    };
    for (int i = 0; i < 3; ++i) {
        const Pair radii = follow();
        const Pair at = circle + change;
        const T off_circle = glm::dot(T(2) * circle + change, change);
        lift += off_circle / (T(2) * glm::dot(at * at, flattened / radii));
    }
    follow();

    const Pair normal_of_eye = circle * flattened;
    const Pair normal_change = flattened * change;
    const Pair normal = normal_of_eye + normal_change;
    const T length_of_eye = glm::length(normal_of_eye);
    const T length = glm::length(normal);
    const T length_change =
        glm::dot(T(2) * normal_of_eye + normal_change, normal_change) / (length + length_of_eye);
    return {std::atan2(normal_of_eye.x * normal_change.y - normal_of_eye.y * normal_change.x,
                       glm::dot(normal_of_eye, normal)),
            std::atan2(way.y, x), lift * length + lift_of_eye * length_change};
}

template <class T> glm::dvec3 sample_at(const DegreeCourse& course, glm::dvec3 relative) {
    const TurnAndRise<T> found =
        turn_and_rise<T>(course, glm::vec<3, T>(course.axes_from_relative * relative));
    constexpr double turn = 2.0 * std::numbers::pi;
    double longitude = static_cast<double>(found.longitude);
    longitude -= turn * std::floor((longitude - course.first_longitude) / turn);
    const glm::dvec2 place =
        glm::dvec2(course.eye) +
        course.samples_a_radian * glm::dvec2(static_cast<double>(found.latitude), longitude);
    return {place.x, course.rows.from_even_row(place.y),
            course.eye.z + static_cast<double>(found.height) / course.exaggeration};
}

} // namespace

glm::dvec3 DegreeCourse::sample(glm::dvec3 relative) const {
    return sample_at<double>(*this, relative);
}

glm::dvec3 DegreeCourse::sample_in_floats(glm::dvec3 relative) const {
    return sample_at<float>(*this, relative);
}

std::optional<DegreeCourse> degree_course(glm::dvec3 eye, const glm::dmat3& local_from_world,
                                          const terrain::Placement& placement,
                                          double middle_column) {
    const auto grid = placement.degree_grid();
    if (!grid) {
        return std::nullopt;
    }
    const geo::LocalFrame& frame = *placement.frame();
    const geo::Geodetic place = frame.geodetic_from_local(eye);
    if (!(place.height > -max_depth_of_degrees)) {
        return std::nullopt;
    }
    const double longitude = glm::radians(place.longitude);
    const auto local = [&](glm::dvec3 geocentric) { return frame.local_direction(geocentric); };
    const glm::dmat3 local_from_axes(local({std::cos(longitude), std::sin(longitude), 0.0}),
                                     local({-std::sin(longitude), std::cos(longitude), 0.0}),
                                     local({0.0, 0.0, 1.0}));
    const glm::dvec3 normal = geo::normal_from_geodetic(place.latitude, place.longitude);
    const glm::dvec2 upward(std::hypot(normal.x, normal.y), normal.z);
    const glm::dvec2 earth = geo::radii_of_earth();
    const double length = earth.x / glm::length(earth * upward); // of (X, Z·a/b)

    DegreeCourse course;
    course.axes_from_relative = glm::transpose(local_from_axes) * local_from_world;
    course.circle = length * upward * glm::dvec2(1.0, earth.y / earth.x);
    course.lift = place.height / length;
    course.first_lift = place.height > max_near_height ? -course.lift : 0.0;
    course.from_axis = (earth.x + course.lift) * course.circle.x;
    course.exaggeration = placement.exaggeration();
    course.samples_a_radian = grid->samples_a_degree * (180.0 / std::numbers::pi);
    course.rows = grid->rows;
    const double columns_a_degree = grid->samples_a_degree[1].x;
    const double middle =
        placement.columns_all_around()
            ? grid->first.y + middle_column / columns_a_degree // rows do not turn with longitudes
            : grid->middle_longitude;
    const double east = place.longitude - 360.0 * std::round((place.longitude - middle) / 360.0);
    course.eye =
        glm::dvec3(grid->samples_a_degree * (glm::dvec2(place.latitude, east) - grid->first),
                   place.height / placement.exaggeration());
    course.first_longitude = glm::radians(middle - 180.0 - east);
    return course;
}

} // namespace reljef::view
