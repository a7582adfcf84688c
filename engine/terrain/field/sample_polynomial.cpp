#include "engine/terrain/field/sample_polynomial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace reljef::terrain {
namespace {

constexpr int side = SamplePolynomial::horizontal_degree + 1;
constexpr int layers = SamplePolynomial::vertical_degree + 1;

std::size_t index_of(int i, int j, int k) {
    const int index = (i * side + j) * layers + k;
    return static_cast<std::size_t>(index);
}

// The Chebyshev points in (-1, 1); the middle one of an odd number is 0 exactly.
template <std::size_t count> std::array<double, count> chebyshev_points() {
    std::array<double, count> points{};
    for (std::size_t i = 0; i < count; ++i) {
        const double odd = 2.0 * static_cast<double>(i) + 1.0;
        const double angle = std::numbers::pi * odd / (2.0 * static_cast<double>(count));
        points[i] = 2 * i + 1 == count ? 0.0 : -std::cos(angle);
    }
    return points;
}

// Places in a box by their samples.
class LocalMap {
public:
    LocalMap(const Placement& placement, glm::dvec3 middle, const glm::dmat3& offset_from_local)
        : placement_(placement), middle_(middle), offset_from_local_(offset_from_local),
          around_(placement.columns_all_around()), first_(placement.sample_from_world(middle)) {}

    [[nodiscard]] glm::dvec3 world(glm::dvec3 local) const {
        return middle_ + offset_from_local_ * local;
    }
    // Columns continue those of the middle.
    [[nodiscard]] std::optional<glm::dvec3> sample(glm::dvec3 local) const {
        auto sample = placement_.sample_from_world(world(local));
        if (!first_ || !sample) {
            return std::nullopt;
        }
        if (around_) {
            sample->x -= *around_ * std::round((sample->x - first_->x) / *around_);
        }
        return sample;
    }

private:
    const Placement& placement_;
    glm::dvec3 middle_;
    glm::dmat3 offset_from_local_;
    std::optional<double> around_;
    std::optional<glm::dvec3> first_;
};

using Coefficients = std::array<glm::dvec3, SamplePolynomial::term_count>;

// Along one axis after the other.
void interpolate_lines(Coefficients& values) {
    const auto horizontal = chebyshev_points<side>();
    const auto along_lines = [&](const auto& points, int lines, const auto& index) {
        std::array<glm::dvec3, std::tuple_size_v<std::decay_t<decltype(points)>>> line{};
        for (int other = 0; other < lines; ++other) {
            for (std::size_t i = 0; i < line.size(); ++i) {
                line[i] = values[index(static_cast<int>(i), other)];
            }
            line = powers_through(points, line);
            for (std::size_t i = 0; i < line.size(); ++i) {
                values[index(static_cast<int>(i), other)] = line[i];
            }
        }
    };
    along_lines(horizontal, side * layers,
                [](int i, int other) { return index_of(i, other / layers, other % layers); });
    along_lines(horizontal, side * layers,
                [](int j, int other) { return index_of(other / layers, j, other % layers); });
    along_lines(chebyshev_points<layers>(), side * side,
                [](int k, int other) { return index_of(other / side, other % side, k); });
}

std::optional<Coefficients> coefficients_of(const LocalMap& map) {
    const auto horizontal = chebyshev_points<side>();
    const auto vertical = chebyshev_points<layers>();
    Coefficients values{};
    for (int term = 0; term < SamplePolynomial::term_count; ++term) {
        const auto at = static_cast<std::size_t>(term);
        const std::size_t k = at % layers;
        const std::size_t j = at / layers % side;
        const std::size_t i = at / layers / side;
        const auto sample = map.sample({horizontal[i], horizontal[j], vertical[k]});
        if (!sample) {
            return std::nullopt;
        }
        values[at] = *sample;
    }
    interpolate_lines(values);
    return values;
}

// Half the sides of the box for one that is 1 long.
glm::dmat3 offset_from_local(const Placement& placement, glm::dvec3 middle, glm::dvec3 half_size) {
    const glm::dvec3 up = placement.up(middle);
    const glm::dvec3 north = placement.north(middle);
    return {half_size.x * glm::cross(north, up), half_size.y * north, half_size.z * up};
}

} // namespace

std::optional<SamplePolynomial> SamplePolynomial::create(const Placement& placement,
                                                         glm::dvec3 middle, glm::dvec3 half_size) {
    const glm::dmat3 axes = offset_from_local(placement, middle, half_size);
    const LocalMap map(placement, middle, axes);
    const auto coefficients = coefficients_of(map);
    if (!coefficients) {
        return std::nullopt;
    }
    SamplePolynomial polynomial;
    polynomial.middle_ = middle;
    polynomial.local_from_offset_ = glm::inverse(axes);
    polynomial.coefficients_ = *coefficients;
    for (const double part : {1.0, 1.0 / 16.0}) {
        const glm::dvec3 step = part * 2.0 / glm::dvec3(side, side, layers);
        for (int i = 0; i <= side; ++i) {
            for (int j = 0; j <= side; ++j) {
                for (int k = 0; k <= layers; ++k) {
                    const glm::dvec3 local = glm::dvec3(i, j, k) * step - glm::dvec3(part);
                    const glm::dvec3 world = map.world(local);
                    const glm::dvec3 found =
                        placement.world_from_sample(polynomial.at_local(local));
                    polynomial.checks_.push_back({world, glm::distance(world, found)});
                }
            }
        }
    }
    return polynomial;
}

glm::dvec3 SamplePolynomial::at_local(glm::dvec3 local) const {
    glm::dvec3 sample(0.0);
    for (int i = horizontal_degree; i >= 0; --i) {
        glm::dvec3 line(0.0);
        for (int j = horizontal_degree; j >= 0; --j) {
            const std::size_t first = index_of(i, j, 0);
            glm::dvec3 term(0.0);
            for (std::size_t k = layers; k-- > 0;) {
                term = term * local.z + coefficients_[first + k];
            }
            line = line * local.y + term;
        }
        sample = sample * local.x + line;
    }
    return sample;
}

glm::dvec3 SamplePolynomial::coefficient(int i, int j, int k) const {
    return coefficients_[index_of(i, j, k)];
}

double SamplePolynomial::error() const {
    return std::max_element(checks_.begin(), checks_.end(),
                            [](const Check& a, const Check& b) { return a.error < b.error; })
        ->error;
}

double SamplePolynomial::angle_from(glm::dvec3 eye) const {
    double largest = 0.0;
    for (const Check& check : checks_) {
        const double distance = glm::distance(check.world, eye);
        largest = std::max(largest, distance > 0.0 ? check.error / distance
                                                   : std::numeric_limits<double>::infinity());
    }
    return largest;
}

} // namespace reljef::terrain
