#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/cast/packet/block_kernel.h"
#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/terrain/field/placement.h"

namespace reljef::cast {

/// Rays to the sun from the places of a terrain on the ellipsoid. They are bent in samples: each is
/// a polynomial of degree 4 in its part, whose factors are polynomials in its place (Chebyshev's),
/// plus the geoid, which is interpolated. Chords replace the rays.
class SunCourse {
public:
    /// Of a terrain, samples (col, row) and true metres of height.
    struct Ground {
        Box lit; ///< where the rays begin
        Box all; ///< of all ground that may hide the sun
    };

    /// `to_sun`: unit vector, local. Empty where no polynomial is precise enough (max_error): near
    /// poles, and over very large terrains. Precondition: a placement on the ellipsoid.
    static std::optional<SunCourse> create(const terrain::Placement& placement, glm::dvec3 to_sun,
                                           const Ground& whole);

    SunCourse(SunCourse&&) = default;
    SunCourse(const SunCourse&) = delete;
    SunCourse& operator=(SunCourse&&) = default;
    SunCourse& operator=(const SunCourse&) = delete;
    ~SunCourse() = default;

    /// Valid as long as this.
    [[nodiscard]] const SunBends& bends() const { return bends_; }
    /// Unit place = scale · sample + first.
    [[nodiscard]] glm::dvec2 unit_scale() const { return glm::dvec2(unit_scale_); }
    [[nodiscard]] glm::dvec2 unit_first() const { return glm::dvec2(unit_first_); }

    /// Offsets of the ends of its chords from a place: samples and true metres; the first is 0.
    [[nodiscard]] std::vector<glm::dvec3> ways_from(glm::dvec3 sample) const;
    /// Boxes around the ends of all chords from places in a box.
    [[nodiscard]] std::vector<Box> ends_from(const Box& places) const;

    /// World metres of a ray at part 1.
    [[nodiscard]] double reach() const { return reach_; }
    /// Of the polynomials and the geoid at checked places: largest angle between a place of a ray
    /// and the one found, seen from where the ray begins, radians. Chords add chord_error.
    [[nodiscard]] double error() const { return error_; }

    static constexpr double max_error = 1e-5;   ///< radians
    static constexpr double chord_error = 8e-6; ///< radians

private:
    using Factors = std::array<glm::dvec3, 4>; // of part to part^4

    class Fit;
    SunCourse() = default;
    [[nodiscard]] Factors factors_at(glm::dvec3 unit) const;
    [[nodiscard]] glm::dvec3 unit_of(glm::dvec3 sample) const;
    [[nodiscard]] static glm::dvec3 way_to(const Factors& factors, double part); // without geoid
    [[nodiscard]] glm::dvec3 way(const Factors& factors, glm::dvec3 unit, double part) const;
    [[nodiscard]] double zero_at(glm::dvec2 unit) const;
    void place(const Ground& ground, const terrain::Placement& placement);
    void make_zeros(const Ground& ground, const terrain::Placement& placement);
    bool cut(const terrain::Placement& placement, glm::dvec3 to_sun, const Ground& ground);

    std::array<glm::dvec3, SunBends::term_count> terms_{};
    glm::dvec3 unit_scale_{1.0};
    glm::dvec3 unit_first_{0.0};
    Grid<float> zeros_; // empty without a geoid
    glm::dvec2 zero_scale_{1.0};
    glm::dvec2 zero_first_{0.0};
    double zero_range_ = 0.0; // true metres
    std::vector<float> parts_;
    double reach_ = 1.0;
    double error_ = 0.0;
    SunBends bends_;
};

} // namespace reljef::cast
