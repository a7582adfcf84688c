#include "engine/view/ray_course.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/terrain/field/gradient.h"
#include "engine/terrain/field/sample_polynomial.h"
#include "engine/view/draw_list.h"

namespace reljef::view {
namespace {

using terrain::SamplePolynomial;

constexpr int degree = 4;

struct Monomial {
    int x = 0;
    int y = 0;
    int z = 0;
};

constexpr std::array<Monomial, RayCourse::term_count> monomials = [] {
    std::array<Monomial, RayCourse::term_count> all{};
    std::size_t count = 0;
    for (int total = 1; total <= degree; ++total) {
        for (int x = total; x >= 0; --x) {
            for (int y = total - x; y >= 0; --y) {
                all[count++] = {x, y, total - x - y};
            }
        }
    }
    return all;
}();

// Of a monomial among all.
std::size_t index_of(Monomial term) {
    constexpr std::array<std::size_t, degree + 1> first{0, 0, 3, 9, 19}; // of a degree
    const auto less_x = static_cast<std::size_t>(term.y) + static_cast<std::size_t>(term.z);
    return first[static_cast<std::size_t>(term.x) + less_x] + less_x * (less_x + 1) / 2 +
           static_cast<std::size_t>(term.z);
}

double power(double base, int exponent) {
    double product = 1.0;
    for (int i = 0; i < exponent; ++i) {
        product *= base;
    }
    return product;
}

double binomial(int n, int k) {
    double ways = 1.0;
    for (int i = 1; i <= k; ++i) {
        ways = ways * (n - k + i) / i;
    }
    return ways;
}

// Of a polynomial of degree 4, the coefficient around `origin`.
glm::dvec3 shifted_term(const SamplePolynomial& polynomial, Monomial term, glm::dvec3 origin) {
    glm::dvec3 sum(0.0);
    for (int i = term.x; i <= degree; ++i) {
        for (int j = term.y; i + j <= degree; ++j) {
            const int last = std::min(degree - i - j, SamplePolynomial::vertical_degree);
            for (int k = term.z; k <= last; ++k) {
                const double ways = binomial(i, term.x) * binomial(j, term.y) * binomial(k, term.z);
                const glm::dvec3 whole = polynomial.coefficient(i, j, k);
                sum += ways * power(origin.x, i - term.x) * power(origin.y, j - term.y) *
                       power(origin.z, k - term.z) * whole;
            }
        }
    }
    return sum;
}

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

// Of a symmetric matrix, the largest absolute eigenvalue; by the trigonometric solution of its
// cubic.
double norm(const glm::dmat3& matrix) {
    const double mean = (matrix[0][0] + matrix[1][1] + matrix[2][2]) / 3.0;
    const glm::dmat3 rest = matrix - glm::dmat3(mean);
    double squares = 0.0;
    for (int column = 0; column < 3; ++column) {
        squares += glm::dot(rest[column], rest[column]);
    }
    const double size = std::sqrt(squares / 6.0);
    if (size == 0.0) {
        return std::abs(mean);
    }
    const double cosine = std::clamp(0.5 * glm::determinant(rest / size), -1.0, 1.0);
    const double angle = std::acos(cosine) / 3.0;
    const double largest = mean + 2.0 * size * std::cos(angle);
    const double smallest = mean + 2.0 * size * std::cos(angle + 2.0 * std::numbers::pi / 3.0);
    return std::max(std::abs(largest), std::abs(smallest));
}

// Of the second derivatives of a place, along any unit direction in metres; 1/metre.
double curvature_at(const RayCourse& course, glm::dvec3 relative, glm::dvec3 metres) {
    const glm::dvec3 at = course.unit_from_relative * relative;
    std::array<glm::dmat3, 3> hessians{};
    for (std::size_t term = 0; term < monomials.size(); ++term) {
        const std::array<int, 3> powers{monomials[term].x, monomials[term].y, monomials[term].z};
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; b < 3; ++b) {
                std::array<int, 3> left = powers;
                double factor = left[static_cast<std::size_t>(a)]--;
                factor *= left[static_cast<std::size_t>(b)]--;
                if (factor == 0.0) {
                    continue;
                }
                const double value =
                    factor * power(at.x, left[0]) * power(at.y, left[1]) * power(at.z, left[2]);
                for (int axis = 0; axis < 3; ++axis) {
                    hessians[static_cast<std::size_t>(axis)][a][b] +=
                        value * course.terms[term][axis];
                }
            }
        }
    }
    double square = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double bend =
            norm(glm::transpose(course.unit_from_relative) *
                 hessians[static_cast<std::size_t>(axis)] * course.unit_from_relative);
        square += metres[axis] * metres[axis] * bend * bend;
    }
    return std::sqrt(square);
}

// What the terms of degree 4 add to the sample of a place.
glm::dvec3 quartic_at(const RayCourse& course, glm::dvec3 relative) {
    const glm::dvec3 at = course.unit_from_relative * relative;
    glm::dvec3 sum(0.0);
    for (std::size_t term = index_of({degree, 0, 0}); term < monomials.size(); ++term) {
        const auto [x, y, z] = monomials[term];
        sum += power(at.x, x) * power(at.y, y) * power(at.z, z) * course.terms[term];
    }
    return sum;
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

// The terms of a polynomial at a place plus a way, by powers of the way.
std::array<glm::dvec3, LightCourse::term_count>
terms_along(const std::array<glm::dvec3, RayCourse::term_count>& terms, glm::dvec3 way) {
    constexpr std::array<std::size_t, degree> first{0, 20, 30, 34}; // of each power
    std::array<glm::dvec3, LightCourse::term_count> along{};
    const auto add = [&](Monomial whole, Monomial part, std::size_t at) {
        const int total = whole.x + whole.y + whole.z - part.x - part.y - part.z;
        const double ways = binomial(whole.x, part.x) * binomial(whole.y, part.y) *
                            binomial(whole.z, part.z) * power(way.x, whole.x - part.x) *
                            power(way.y, whole.y - part.y) * power(way.z, whole.z - part.z);
        along[first[static_cast<std::size_t>(total) - 1] + at] += ways * terms[index_of(whole)];
    };
    for (const Monomial whole : monomials) {
        add(whole, {0, 0, 0}, 0);
        for (const Monomial part : monomials) {
            const bool is_smaller = part.x + part.y + part.z < whole.x + whole.y + whole.z;
            if (is_smaller && part.x <= whole.x && part.y <= whole.y && part.z <= whole.z) {
                add(whole, part, 1 + index_of(part));
            }
        }
    }
    return along;
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
            quartic =
                std::max(quartic, glm::length(metres * quartic_at(course, relative)) / distance);
        }
        course.min_metres = glm::min(course.min_metres, metres);
        course.curvature = std::max(course.curvature, curvature_at(course, relative, metres));
    }
    course.needs_quartic = quartic > max_quartic_error * check.pixel;
    return course;
}

} // namespace

glm::dvec3 RayCourse::sample(glm::dvec3 relative) const {
    const glm::dvec3 at = unit_from_relative * relative;
    glm::dvec3 sum = eye;
    for (std::size_t term = 0; term < monomials.size(); ++term) {
        const auto [x, y, z] = monomials[term];
        sum += power(at.x, x) * power(at.y, y) * power(at.z, z) * terms[term];
    }
    return sum;
}

std::optional<RayCourse> ray_course(const scene::Camera& camera, glm::ivec2 size,
                                    const glm::dmat4& world_from_local,
                                    const terrain::Placement& placement, const Box& samples,
                                    const std::optional<SunRays>& sun) {
    if (camera.projection == scene::ProjectionKind::orthographic) {
        return std::nullopt;
    }
    const glm::dmat4 local_from_world = glm::inverse(world_from_local);
    const glm::dvec3 eye(local_from_world * glm::dvec4(camera.eye, 1.0));
    const auto eye_sample = placement.sample_from_world(eye);
    if (!eye_sample) {
        return std::nullopt;
    }
    const Box seen = within_horizon(samples, placement, eye, *eye_sample);
    if (seen.low.x >= seen.high.x || seen.low.y >= seen.high.y) {
        return std::nullopt;
    }
    RayCourse course;
    course.samples = seen;
    if (sun) {
        course.light =
            light_over(seen, placement, glm::dmat3(local_from_world) * sun->to_sun, sun->samples);
    }
    const std::vector<glm::dvec3> checked =
        checked_samples(course.light ? course.light->samples : seen);
    std::vector<glm::dvec3> places = places_of(placement, checked);
    places.push_back(eye);
    const auto polynomial = polynomial_around(placement, places);
    if (!polynomial) {
        return std::nullopt;
    }

    const glm::dvec3 origin = polynomial->local(eye);
    for (std::size_t term = 0; term < monomials.size(); ++term) {
        course.terms[term] = shifted_term(*polynomial, monomials[term], origin);
    }
    // The polynomial's columns, which are continuous all around the Earth.
    const auto around = placement.columns_all_around();
    course.eye = *eye_sample;
    if (around) {
        course.eye.x += *around * std::round((polynomial->at(eye).x - eye_sample->x) / *around);
    }
    course.unit_from_relative = polynomial->local_from_offset() * glm::dmat3(local_from_world);
    if (sun) {
        course.light->terms = terms_along(course.terms, course.unit_from_relative *
                                                            (course.light->reach * sun->to_sun));
    }
    const double pixel = metres_a_pixel(camera, size).y;
    course = measured(course, {placement, checked, places, glm::dmat3(world_from_local), pixel});
    return course.error <= max_course_error * pixel ? std::optional(course) : std::nullopt;
}

} // namespace reljef::view
