#include "engine/view/rays/ray_course.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/terrain/field/gradient.h"
#include "engine/terrain/field/sample_polynomial.h"
#include "engine/view/rays/course_terms.h"

namespace reljef::view {
namespace {

using terrain::SamplePolynomial;

// Places of the surface, at its lowest and its highest.
std::vector<glm::dvec3> checked_samples(const Box& samples) {
    constexpr int steps = 8;
    std::vector<glm::dvec3> places;
    for (int row = 0; row <= steps; ++row) {
        for (int col = 0; col <= steps; ++col) {
            for (int end = 0; end <= 1; ++end) {
                const glm::dvec3 part(static_cast<double>(col) / steps,
                                      static_cast<double>(row) / steps, end);
                places.push_back(samples.low + part * samples.size());
            }
        }
    }
    return places;
}

// Sides along east, north and up of the middle, metres.
struct Frame {
    glm::dvec3 middle{0.0};
    glm::dmat3 axes{1.0};

    Frame(const terrain::Placement& placement, glm::dvec3 at) : middle(at) {
        const glm::dvec3 up = placement.up(at);
        const glm::dvec3 north = placement.north(at);
        axes = {glm::cross(north, up), north, up};
    }
    [[nodiscard]] Box around(const std::vector<glm::dvec3>& places) const {
        Box box;
        for (const glm::dvec3 place : places) {
            box.add(glm::transpose(axes) * (place - middle));
        }
        return box;
    }
};

std::optional<SamplePolynomial> polynomial_around(const terrain::Placement& placement,
                                                  const std::vector<glm::dvec3>& places) {
    const Frame first(placement, places.front());
    const Frame frame(placement, first.middle + first.axes * first.around(places).center());
    const Box box = frame.around(places);
    // Metres. Positions err by 1e-8 m; far beside terrains of centimetres there are no samples.
    constexpr double min_half_size = 0.01;
    const glm::dvec3 half_size = glm::max(glm::max(-box.low, box.high), glm::dvec3(min_half_size));
    return SamplePolynomial::create(placement, frame.middle, half_size);
}

// Metres from a height above the ground to where a ray touches the ground, at most.
double tangent_length(double height) {
    constexpr double max_radius = 6.4e6; // of curvature: 6,399,594 m at the poles of WGS 84
    const double above = std::max(0.0, height);
    return std::sqrt(above * (2.0 * max_radius + above));
}

// Metres from an eye to the farthest ground that the curved Earth does not hide, at most.
double horizon_of(double eye_height, terrain::HeightRange heights) {
    return tangent_length(eye_height - heights.low) + tangent_length(heights.high - heights.low);
}

// The part of the samples within the horizon; all of them around a pole and across the end of
// columns that go all around the Earth.
Box within_horizon(const Box& samples, const terrain::Placement& placement, glm::dvec3 eye,
                   glm::dvec3 eye_sample) {
    const auto position = placement.geodetic_from_world(eye);
    const double exaggeration = placement.exaggeration();
    const double reach = horizon_of(exaggeration * eye_sample.z,
                                    {exaggeration * samples.low.z, exaggeration * samples.high.z});
    constexpr double min_metres_a_degree = 110'000.0; // along a meridian
    if (!position || 90.0 - std::abs(position->latitude) < reach / min_metres_a_degree) {
        return samples;
    }
    const Frame frame(placement, eye);
    const auto around = placement.columns_all_around();
    Box seen;
    constexpr int directions = 32;
    // The circle lies within the polygon around it.
    const double radius = reach / std::cos(std::numbers::pi / directions);
    for (int i = 0; i < directions; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / directions;
        const glm::dvec3 way(radius * std::cos(angle), radius * std::sin(angle), 0.0);
        auto sample = placement.sample_from_world(eye + frame.axes * way);
        if (!sample) {
            return samples;
        }
        if (around) {
            sample->x -= *around * std::round((sample->x - eye_sample.x) / *around);
        }
        seen.add(*sample);
    }
    if (around && (seen.low.x < samples.low.x || seen.high.x > samples.high.x)) {
        return samples;
    }
    Box part = samples;
    for (int axis = 0; axis < 2; ++axis) {
        part.low[axis] = std::max(samples.low[axis], seen.low[axis]);
        part.high[axis] = std::min(samples.high[axis], seen.high[axis]);
    }
    return part;
}

// Metres that rays to the sun from these places have below the highest ground, at most. `to_sun`:
// local.
double light_reach(const terrain::Placement& placement, const std::vector<glm::dvec3>& places,
                   glm::dvec3 to_sun, const Box& samples) {
    const double rise = placement.exaggeration() * samples.size().z;
    double sine = 1.0; // of the sun's lowest altitude
    for (const glm::dvec3 place : places) {
        sine = std::min(sine, glm::dot(placement.up(place), to_sun));
    }
    const double longest = 2.0 * tangent_length(rise); // down to the ground and up again
    constexpr double min_reach = 1.0;
    return std::max(min_reach, sine > 0.0 ? std::min(rise / sine, longest) : longest);
}

// With the samples that the rays from some places cross.
Box with_light(const Box& seen, const terrain::Placement& placement,
               const std::vector<glm::dvec3>& places, glm::dvec3 way, const Box& all) {
    const auto around = placement.columns_all_around();
    const double middle = seen.center().x;
    Box lit = seen;
    for (const glm::dvec3 place : places) {
        auto sample = placement.sample_from_world(place + way);
        if (!sample) {
            return all;
        }
        if (around) {
            sample->x -= *around * std::round((sample->x - middle) / *around);
        }
        lit.add(glm::dvec3(glm::dvec2(*sample), seen.low.z));
    }
    if (around && (lit.low.x < all.low.x || lit.high.x > all.high.x)) {
        return all;
    }
    for (int axis = 0; axis < 2; ++axis) {
        lit.low[axis] = std::max(lit.low[axis], all.low[axis]);
        lit.high[axis] = std::min(lit.high[axis], all.high[axis]);
    }
    return lit;
}

std::vector<glm::dvec3> places_of(const terrain::Placement& placement,
                                  const std::vector<glm::dvec3>& samples) {
    std::vector<glm::dvec3> places;
    places.reserve(samples.size() + 1);
    for (const glm::dvec3 sample : samples) {
        places.push_back(placement.world_from_sample(sample));
    }
    return places;
}

// Of the light over the visible samples; its terms are not yet set.
LightCourse light_over(const Box& seen, const terrain::Placement& placement, glm::dvec3 to_sun,
                       const Box& all) {
    const std::vector<glm::dvec3> places = places_of(placement, checked_samples(seen));
    LightCourse light;
    light.reach = light_reach(placement, places, to_sun, all);
    light.samples = with_light(seen, placement, places, light.reach * to_sun, all);
    return light;
}

// Where a polynomial is compared with the map.
struct CourseCheck {
    const terrain::Placement& placement;
    const std::vector<glm::dvec3>& samples;
    const std::vector<glm::dvec3>& places; // of these, local; the last one is the eye
    glm::dmat3 world_turn;                 // from local directions
    double pixel;                          // radians
};

// With what is measured at places of the surface.
RayCourse measured(RayCourse course, const CourseCheck& check) {
    const glm::dvec3 eye = check.places.back();
    double quartic = 0.0; // radians
    course.min_metres = terrain::metres_at(check.placement, check.samples.front());
    for (std::size_t i = 0; i < check.samples.size(); ++i) {
        const glm::dvec3 relative = check.world_turn * (check.places[i] - eye);
        const glm::dvec3 found = check.placement.world_from_sample(course.sample(relative));
        const double distance = glm::distance(check.places[i], eye);
        const glm::dvec3 metres = terrain::metres_at(check.placement, check.samples[i]);
        if (distance > 0.0) { // at the eye it is exact
            course.error = std::max(course.error, glm::distance(found, check.places[i]) / distance);
            quartic = std::max(
                quartic,
                glm::length(metres * sum_of_quartic_terms(course.terms,
                                                          course.unit_from_relative * relative)) /
                    distance);
        }
        course.min_metres = glm::min(course.min_metres, metres);
        course.curvature = std::max(course.curvature, curvature_at(course, relative, metres));
    }
    course.needs_quartic = quartic > max_quartic_error * check.pixel;
    return course;
}

} // namespace

glm::dvec3 RayCourse::sample(glm::dvec3 relative) const {
    if (degrees) {
        return degrees->sample(relative);
    }
    return eye + sum_of_terms(terms, unit_from_relative * relative);
}

namespace {

// What view rays are made for.
struct CourseView {
    const scene::Camera& camera;
    glm::ivec2 size;
    const glm::dmat4& world_from_local;
    const terrain::Placement& placement;
    const Box& samples;
    const std::optional<SunRays>& sun;
    glm::dmat4 local_from_world = glm::inverse(world_from_local);
    glm::dvec3 eye{local_from_world * glm::dvec4(camera.eye, 1.0)}; // local
};

bool is_parallel(const CourseView& view) {
    return view.camera.projection == scene::ProjectionKind::orthographic;
}

// Empty if none is precise enough.
std::optional<RayCourse> polynomial_course(const CourseView& view) {
    const terrain::Placement& placement = view.placement;
    const glm::dvec3 eye = view.eye;
    const auto eye_sample = placement.sample_from_world(eye);
    if (!eye_sample) {
        return std::nullopt;
    }
    const Box seen = within_horizon(view.samples, placement, eye, *eye_sample);
    if (seen.low.x >= seen.high.x || seen.low.y >= seen.high.y) {
        return std::nullopt;
    }
    const glm::dmat3 turn(view.local_from_world);
    RayCourse course;
    course.samples = seen;
    if (view.sun) {
        course.light = light_over(seen, placement, turn * view.sun->to_sun, view.sun->samples);
    }
    const std::vector<glm::dvec3> checked =
        checked_samples(course.light ? course.light->samples : seen);
    std::vector<glm::dvec3> places = places_of(placement, checked);
    places.push_back(eye);
    const auto polynomial = polynomial_around(placement, places);
    if (!polynomial) {
        return std::nullopt;
    }

    course.terms = shifted_terms(*polynomial, polynomial->local(eye));
    // The polynomial's columns, which are continuous all around the Earth.
    const auto around = placement.columns_all_around();
    course.eye = *eye_sample;
    if (around) {
        course.eye.x += *around * std::round((polynomial->at(eye).x - eye_sample->x) / *around);
    }
    course.unit_from_relative = polynomial->local_from_offset() * turn;
    if (view.sun) {
        course.light->terms = terms_along(
            course.terms, course.unit_from_relative * (course.light->reach * view.sun->to_sun));
    }
    const double pixel = scene::metres_a_pixel(view.camera, view.size).y;
    course =
        measured(course, {placement, checked, places, glm::dmat3(view.world_from_local), pixel});
    return course.error <= max_course_error * pixel ? std::optional(course) : std::nullopt;
}

// Largest distance, as an angle from the eye or of parallel rays, between places and those that
// floats find.
double error_of_floats(const RayCourse& course, const CourseView& view,
                       const std::vector<glm::dvec3>& checked) {
    double error = 0.0;
    for (const glm::dvec3 sample : checked) {
        const glm::dvec3 place = view.placement.world_from_sample(sample);
        const glm::dvec3 way = place - view.eye;
        const glm::dvec3 found = view.placement.world_from_sample(
            course.degrees->sample_in_floats(glm::dmat3(view.world_from_local) * way));
        const double beside = glm::distance(found, place);
        const double distance = is_parallel(view) ? 1.0 : glm::length(way);
        if (distance > 0.0) { // at the eye it is exact
            error = std::max(error, beside / distance);
        }
    }
    return error;
}

// Samples that rays may cross, those to the sun included.
const Box& crossed_samples(const CourseView& view) {
    return view.sun ? view.sun->samples : view.samples;
}

// Of a terrain whose longitudes begin anew: floats of the columns behind have the digits of a whole
// turn. As error_of_floats().
double error_behind_turn(const RayCourse& course, const CourseView& view) {
    const auto around = view.placement.columns_all_around();
    if (!around || crossed_samples(view).size().x < *around) {
        return 0.0;
    }
    const DegreeCourse& degrees = *course.degrees;
    const double away = std::min(-degrees.first_longitude,
                                 2.0 * std::numbers::pi + degrees.first_longitude); // radians
    const double beside = degrees.from_axis * std::sin(std::min(away, 0.5 * std::numbers::pi));
    const double above = view.placement.exaggeration() * (degrees.eye.z - view.samples.high.z);
    const double distance = std::max(beside, above);
    // A sum, a product and two more sums, of numbers up to a turn.
    constexpr double rounding = 4.0 * 2.0 * std::numbers::pi * 0x1p-24;
    const double metres = rounding * (degrees.from_axis + std::max(distance, 0.0));
    return is_parallel(view) ? metres
                             : metres / std::max(distance, std::numeric_limits<double>::min());
}

// Metres from the eye to ground in the picture, at most.
double farthest_ground(const CourseView& view, const DegreeCourse& degrees) {
    const double exaggeration = degrees.exaggeration;
    if (!is_parallel(view)) {
        return horizon_of(exaggeration * degrees.eye.z,
                          {exaggeration * view.samples.low.z, exaggeration * view.samples.high.z});
    }
    const double radius = geo::radii_of_earth().x;
    const double from_middle = glm::distance(
        scene::view_ray(view.camera, view.size, glm::dvec2(0.0)).origin, view.camera.eye);
    const double fall = std::min(from_middle * from_middle / (2.0 * radius), 2.0 * radius);
    return from_middle + fall + exaggeration * std::abs(degrees.eye.z);
}

std::optional<RayCourse> course_over_degrees(const CourseView& view) {
    const terrain::Placement& placement = view.placement;
    const double lowest = placement.exaggeration() * view.samples.low.z;
    const auto degrees = degree_course(view.eye, glm::dmat3(view.local_from_world), placement,
                                       crossed_samples(view).center().x);
    if (!degrees || !(lowest > -max_depth_of_degrees)) {
        return std::nullopt;
    }
    RayCourse course;
    course.samples = view.samples;
    course.eye = {degrees->eye.x, degrees->rows.from_even_row(degrees->eye.y), degrees->eye.z};
    course.unit_from_relative = degrees->axes_from_relative;
    course.needs_quartic = false;
    course.degrees = degrees;
    course.farthest = farthest_ground(view, *degrees);
    const std::vector<glm::dvec3> checked = checked_samples(view.samples);
    if (view.sun) {
        const glm::dvec3 to_sun = glm::dmat3(view.local_from_world) * view.sun->to_sun;
        course.light.emplace();
        course.light->samples = view.sun->samples;
        course.light->reach =
            light_reach(placement, places_of(placement, checked), to_sun, view.sun->samples);
    }
    constexpr double between_checked = 2.0;
    course.error =
        between_checked * error_of_floats(course, view, checked) + error_behind_turn(course, view);
    const glm::dvec2 pixel(scene::metres_a_pixel(view.camera, view.size));
    return course.error <= max_course_error * (pixel.x + pixel.y) ? std::optional(course)
                                                                  : std::nullopt;
}

} // namespace

std::optional<RayCourse> ray_course(const scene::Camera& camera, glm::ivec2 size,
                                    const glm::dmat4& world_from_local,
                                    const terrain::Placement& placement, const Box& samples,
                                    const std::optional<SunRays>& sun) {
    const CourseView view{camera, size, world_from_local, placement, samples, sun};
    auto course = is_parallel(view) ? std::nullopt : polynomial_course(view);
    return course ? course : course_over_degrees(view);
}

} // namespace reljef::view
