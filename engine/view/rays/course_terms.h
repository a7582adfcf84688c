#pragma once

#include <array>

#include <glm/vec3.hpp>

#include "engine/terrain/field/sample_polynomial.h"
#include "engine/view/rays/ray_course.h"

namespace reljef::view {

// The polynomials of a RayCourse.

using CourseTerms = std::array<glm::dvec3, RayCourse::term_count>;

/// Of a polynomial around `origin` (SamplePolynomial::local), without its constant.
CourseTerms shifted_terms(const terrain::SamplePolynomial& polynomial, glm::dvec3 origin);

/// What the terms add up to at a direction, and those of degree 4 alone.
glm::dvec3 sum_of_terms(const CourseTerms& terms, glm::dvec3 direction);
glm::dvec3 sum_of_quartic_terms(const CourseTerms& terms, glm::dvec3 direction);

/// The terms at a place plus a way, by powers of the way (LightCourse::terms).
std::array<glm::dvec3, LightCourse::term_count> terms_along(const CourseTerms& terms,
                                                            glm::dvec3 way);

/// Of the second derivatives of a place, along any unit direction in metres; 1/metre. `metres`: of
/// a step of each coordinate of a sample there.
double curvature_at(const RayCourse& course, glm::dvec3 relative, glm::dvec3 metres);

} // namespace reljef::view
