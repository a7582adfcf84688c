#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/scene/graph/camera.h"
#include "engine/terrain/field/placement.h"
#include "engine/view/rays/degree_course.h"

namespace reljef::view {

/// Rays from places of a surface to the sun: straight on the Earth, bent in samples. `part` of a
/// ray leads from the sample of a place to that one plus a polynomial of degree 4 in `part`.
struct LightCourse {
    Box samples;        ///< that the rays may cross; true metres
    double reach = 1.0; ///< metres of a ray at part 1: above all heights
    /// Of the factors of part, part^2, part^3 and part^4: polynomials of degree 3, 2, 1 and 0 in
    /// the direction from the eye to the place. Their monomials are those of RayCourse, after the
    /// constant.
    static constexpr std::size_t term_count = 20 + 10 + 4 + 1;
    std::array<glm::dvec3, term_count> terms{}; ///< col, row, height in true metres
};

/// What light rays are made for.
struct SunRays {
    glm::dvec3 to_sun{0.0, 0.0, 1.0}; ///< unit vector of the world
    Box samples;                      ///< all of the surface; true metres
};

/// The view rays over a terrain on the ellipsoid. They are bent in its samples: the sample at
/// eye + direction is a polynomial of degree 4 in the direction. So along a ray it is one in the
/// part of the ray, whose coefficients are precise in floats near the eye. Where no such polynomial
/// is precise, places of rays are mapped one by one.
struct RayCourse {
    Box samples; ///< the part of the surface that may be visible; true metres
    std::optional<DegreeCourse> degrees = {}; ///< maps places; there is no polynomial
    double farthest = 0.0; ///< with `degrees`: ground from the eye, metres, at most
    /// Monomials x^i·y^j·z^k of degree 1 to 4: by degree, then falling i, then falling j.
    static constexpr std::size_t term_count = 34;

    glm::dvec3 eye{0.0}; ///< its col, row, height in true metres
    /// To the polynomial's directions from world metres: about 1 across the terrain.
    glm::dmat3 unit_from_relative{1.0};
    std::array<glm::dvec3, term_count> terms{}; ///< col, row, height in true metres
    /// Of rays in samples, at most, 1/metre. A chord between the distances a and b from the eye is
    /// seen beside the ray by at most (sqrt(b) - sqrt(a))^2 / 2 of it, in radians.
    double curvature = 0.0;
    glm::dvec3 min_metres{1.0}; ///< world metres of a step of each coordinate of a sample, at least
    /// Largest angle between a checked place of the surface and the one found, seen from the eye,
    /// radians; of parallel rays metres.
    double error = 0.0;
    /// Whether the terms of degree 4 move a checked place by more than max_quartic_error on the
    /// picture. Without them, frames take 5 to 13 % less time.
    bool needs_quartic = true;
    std::optional<LightCourse> light;

    /// Of a place from the eye, in world metres.
    [[nodiscard]] glm::dvec3 sample(glm::dvec3 relative) const;
};

/// Pixels by which the polynomial, or floats, may be wrong: a geoid takes about 0.015, the rest
/// less than 0.001 within two degrees around the eye.
inline constexpr double max_course_error = 0.1;
/// Pixels by which places may be beside the polynomial where its terms of degree 4 are left out.
inline constexpr double max_quartic_error = 0.005;
/// Pixels by which the chords of a ray may be.
inline constexpr double max_chord_error = 0.005;
/// Pixels by which the chords of a ray may be whose places are mapped one by one.
inline constexpr double max_degree_chord_error = 0.01;
/// Radians by which the chords of a ray to the sun may be: a thousandth of the sun's disc.
inline constexpr double max_light_error = 1e-5;

/// For the surface within `samples`: columns, rows and heights in true metres. For parallel rays,
/// eyes far above large terrains, and near poles no polynomial is precise enough; then it is empty
/// unless degree_course() is there. `sun`: with light rays, where the polynomial is then precise,
/// too. Preconditions: an invertible transform, a placement on the ellipsoid.
std::optional<RayCourse> ray_course(const scene::Camera& camera, glm::ivec2 size,
                                    const glm::dmat4& world_from_local,
                                    const terrain::Placement& placement, const Box& samples,
                                    const std::optional<SunRays>& sun = {});

} // namespace reljef::view
