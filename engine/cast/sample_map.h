#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/cast/earth_map.h"
#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/terrain/field/placement.h"
#include "engine/terrain/field/sample_polynomial.h"

namespace reljef::cast {

/// EarthMap::sample, by polynomials if these are precise enough.
/// No polynomial follows a geoid, except over a few kilometres around the eye. Farther away, the
/// geoid is interpolated between samples, beside a polynomial without it.
class SampleMap {
public:
    struct Ground {
        Box local;          ///< around the surface, metres
        Box samples;        ///< the same in samples and metres of height
        double above = 0.0; ///< metres above and below it where rays are looked up
        /// Errors are smallest near it: the eye, or the middle of what parallel rays show.
        glm::dvec3 eye{0.0};
    };
    /// Errors that do not count, metres: `near`, plus `a_metre` for each metre from the eye.
    struct Tolerance {
        double near = 0.0;
        double a_metre = 0.0;
    };

    /// `threads`: 0: one per hardware thread.
    SampleMap(const EarthMap& map, const Ground& ground, const Tolerance& tolerance,
              unsigned threads);

    /// (col, row, height) of a place within a tolerance, metres; empty outside of the map. Columns
    /// of a globe may be those of another turn.
    [[nodiscard]] std::optional<glm::dvec3> at(glm::dvec3 place, double tolerance) const;

private:
    [[nodiscard]] std::optional<terrain::SamplePolynomial>
    fitted(const terrain::Placement& placement, const Ground& ground, const Tolerance& tolerance,
           int halvings) const;
    void make_zeros(const Ground& ground, unsigned threads);
    [[nodiscard]] double zero_at(glm::dvec2 sample) const;
    [[nodiscard]] glm::dvec3 in_turn(glm::dvec3 sample) const;

    EarthMap map_;
    std::optional<terrain::SamplePolynomial> near_; // with the geoid
    std::optional<terrain::SamplePolynomial> far_;  // without it
    Grid<double> zeros_;                            // of the geoid above the ellipsoid, metres
    glm::dvec2 first_{0.0};                         // sample of the first zero
    glm::dvec2 step_{1.0};
    double zero_error_ = 0.0; // of interpolated zeros, metres
    double around_ = 0.0;     // columns of a globe; else 0
    double middle_ = 0.0;     // column
};

} // namespace reljef::cast
