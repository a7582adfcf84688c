#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "engine/terrain/field/placement.h"

namespace reljef::terrain {

/// Coefficients of the polynomial through values at places, the lowest power first: divided
/// differences (Newton), then Horner's scheme.
template <std::size_t count>
std::array<glm::dvec3, count> powers_through(const std::array<double, count>& places,
                                             std::array<glm::dvec3, count> values) {
    for (std::size_t order = 1; order < count; ++order) {
        for (std::size_t i = count - 1; i >= order; --i) {
            values[i] = (values[i] - values[i - 1]) / (places[i] - places[i - order]);
        }
    }
    for (std::size_t first = count - 1; first-- > 0;) {
        for (std::size_t i = first; i + 1 < count; ++i) {
            values[i] -= places[first] * values[i + 1];
        }
    }
    return values;
}

/// Placement::sample_from_world over a box, as a polynomial: about fifty times as fast. It
/// interpolates at Chebyshev points, so it is exact at the middle, and its error grows from there
/// with the distance. Around an eye, distant ground may be less precise than near ground.
class SamplePolynomial {
public:
    static constexpr int horizontal_degree = 4; ///< along east and along north
    static constexpr int vertical_degree = 2;
    static constexpr int term_count =
        (horizontal_degree + 1) * (horizontal_degree + 1) * (vertical_degree + 1);

    /// Where the polynomial was compared with the map.
    struct Check {
        glm::dvec3 world{0.0};
        double error = 0.0; ///< metres between this place and that of the polynomial's sample
    };

    /// Over a box with sides along east, north and up at its middle. `half_size`: metres along
    /// these. Empty if places in the box have no sample, or lie so far beside the
    /// terrain that the inverse of its map does not converge.
    static std::optional<SamplePolynomial> create(const Placement& placement, glm::dvec3 middle,
                                                  glm::dvec3 half_size);

    /// (col, row, height in true metres) of a world place in the box. Of a terrain that covers all
    /// longitudes, columns are continuous through the box: they may be beyond the terrain's.
    [[nodiscard]] glm::dvec3 at(glm::dvec3 world) const { return at_local(local(world)); }
    /// The same for a place relative to the box: -1 to 1 along each side.
    [[nodiscard]] glm::dvec3 at_local(glm::dvec3 local) const;
    [[nodiscard]] glm::dvec3 local(glm::dvec3 world) const {
        return local_from_offset_ * (world - middle_);
    }

    [[nodiscard]] glm::dvec3 middle() const { return middle_; }
    /// To a place relative to the box from one relative to its middle, metres.
    [[nodiscard]] const glm::dmat3& local_from_offset() const { return local_from_offset_; }
    /// Of x^i·y^j·z^k in the local place. Precondition: no power above its degree.
    [[nodiscard]] glm::dvec3 coefficient(int i, int j, int k) const;

    /// In the whole box, and in a sixteenth of it around the middle: on lattices between the
    /// points of interpolation, to the corners.
    [[nodiscard]] std::span<const Check> checks() const { return checks_; }
    /// Largest error of the checks, metres.
    [[nodiscard]] double error() const;
    /// Largest angle under which an eye sees the error of a check, radians; infinite at one.
    [[nodiscard]] double angle_from(glm::dvec3 eye) const;

private:
    SamplePolynomial() = default;

    glm::dvec3 middle_{0.0};
    glm::dmat3 local_from_offset_{1.0};
    std::array<glm::dvec3, term_count> coefficients_{};
    std::vector<Check> checks_;
};

} // namespace reljef::terrain
