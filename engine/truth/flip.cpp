#include "engine/truth/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "engine/core/parallel_for.h"
#include "engine/truth/separable_filter.h"

namespace reljef::truth {
namespace {

using std::numbers::pi;

// Exponents of the colour and feature differences; the bend of the redistribution maps the share
// bend_difference of the largest colour difference to bend_error.
constexpr double color_exponent = 0.7;
constexpr double feature_exponent = 0.5;
constexpr double bend_difference = 0.4;
constexpr double bend_error = 0.95;

// Width of a human edge detector from peak to trough, degrees.
constexpr double feature_width = 0.082;

// A term a·√(π/b)·exp(−π²d²/b) of a contrast sensitivity function, d in degrees (table 1 of the
// paper).
struct SensitivityTerm {
    double a;
    double b;
};
constexpr std::array achromatic_sensitivity{SensitivityTerm{1.0, 0.0047}};
constexpr std::array red_green_sensitivity{SensitivityTerm{1.0, 0.0053}};
constexpr std::array blue_yellow_sensitivity{SensitivityTerm{34.1, 0.04},
                                             SensitivityTerm{13.5, 0.025}};
constexpr double max_b = 0.04;

// From linear sRGB to CIE XYZ relative to the D65 white.
glm::dmat3 white_relative_from_linear() {
    const glm::dmat3 rows(glm::dvec3(10135552.0, 8788810.0, 4435075.0),
                          glm::dvec3(2613072.0, 8788810.0, 887015.0),
                          glm::dvec3(1425312.0, 8788810.0, 70074185.0));
    glm::dmat3 relative;
    for (int i = 0; i < 3; ++i) {
        relative[i] = rows[i] / (rows[i].x + rows[i].y + rows[i].z);
    }
    return glm::transpose(relative);
}

// Linear values of the sRGB-encoded bytes (IEC 61966-2-1).
std::array<double, 256> linear_from_bytes() {
    std::array<double, 256> linear{};
    for (std::size_t i = 0; i < linear.size(); ++i) {
        const double encoded = static_cast<double>(i) / 255.0;
        linear[i] = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
    }
    return linear;
}

// The channels of YCxCz as (Y + 16) / 116, Cx / 500, Cz / 200: a filter of sum 1 keeps scales and
// offsets.
struct Opponent {
    Plane luminance;
    Plane red_green;
    Plane blue_yellow;
};

void for_each_row(int rows, const FlipOptions& options, const std::function<void(int row)>& body) {
    parallel_for(rows, body, {options.threads, {}, {}});
}

Opponent opponent_of(const Image& picture, const FlipOptions& options) {
    const int cols = picture.cols();
    const int rows = picture.rows();
    Opponent opponent{Plane(cols, rows), Plane(cols, rows), Plane(cols, rows)};
    const std::array<double, 256> linear = linear_from_bytes();
    const glm::dmat3 relative_from_linear = white_relative_from_linear();
    for_each_row(rows, options, [&](int row) {
        for (int col = 0; col < cols; ++col) {
            const Rgba8 color = picture(col, row);
            const glm::dvec3 xyz = relative_from_linear *
                                   glm::dvec3(linear[color.r], linear[color.g], linear[color.b]);
            opponent.luminance(col, row) = xyz.y;
            opponent.red_green(col, row) = xyz.x - xyz.y;
            opponent.blue_yellow(col, row) = xyz.y - xyz.z;
        }
    });
    return opponent;
}

double deviation_of(double b, double pixels_per_degree) {
    return pixels_per_degree * std::sqrt(0.5 * b) / pi;
}

// Filters with the sum of the terms, scaled to sum 1. Each term is separable.
Plane contrast_filtered(const Plane& plane, std::span<const SensitivityTerm> terms,
                        const FlipOptions& options) {
    const double ppd = options.pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3.0 * deviation_of(max_b, ppd)));
    Plane sum(plane.cols(), plane.rows());
    double total = 0.0;
    for (const SensitivityTerm& term : terms) {
        std::vector<double> kernel = gaussian(deviation_of(term.b, ppd), radius);
        const double kernel_sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
        const double volume = kernel_sum * kernel_sum;
        const double weight = term.a * std::sqrt(pi / term.b) * volume;
        normalize(kernel);
        const Plane part = filtered(plane, kernel, kernel, options.threads);
        for_each_row(plane.rows(), options,
                     [&](int row) { add_scaled(sum.row(row), part.row(row), weight); });
        total += weight;
    }
    for_each_row(plane.rows(), options, [&](int row) {
        for (double& sample : sum.row(row)) {
            sample /= total;
        }
    });
    return sum;
}

Opponent contrast_filtered(const Opponent& opponent, const FlipOptions& options) {
    return {contrast_filtered(opponent.luminance, achromatic_sensitivity, options),
            contrast_filtered(opponent.red_green, red_green_sensitivity, options),
            contrast_filtered(opponent.blue_yellow, blue_yellow_sensitivity, options)};
}

// CIE L*a*b* from white-relative XYZ, chroma scaled by lightness (Hunt 1952).
glm::dvec3 hunt_lab(glm::dvec3 xyz) {
    constexpr double delta = 6.0 / 29.0;
    const auto compressed = [](double share) {
        return share > delta * delta * delta ? std::cbrt(share)
                                             : share / (3.0 * delta * delta) + 4.0 / 29.0;
    };
    const glm::dvec3 f(compressed(xyz.x), compressed(xyz.y), compressed(xyz.z));
    const double lightness = 116.0 * f.y - 16.0;
    return {lightness, 0.01 * lightness * 500.0 * (f.x - f.y),
            0.01 * lightness * 200.0 * (f.y - f.z)};
}

// HyAB: city block between lightness and chroma, Euclidean within chroma (Abasi et al. 2020).
double hyab(glm::dvec3 a, glm::dvec3 b) {
    const glm::dvec3 difference = a - b;
    return std::abs(difference.x) +
           std::sqrt(difference.y * difference.y + difference.z * difference.z);
}

class ColorDifference {
public:
    ColorDifference()
        : relative_from_linear_(white_relative_from_linear()),
          linear_from_relative_(glm::inverse(relative_from_linear_)),
          max_(
              std::pow(hyab(hunt_lab(relative_from_linear_[1]), hunt_lab(relative_from_linear_[2])),
                       color_exponent)) {}

    // In [0,1]. Precondition: contrast-filtered pictures.
    [[nodiscard]] double at(const Opponent& a, const Opponent& b, int col, int row) const {
        return redistributed(std::pow(hyab(lab(a, col, row), lab(b, col, row)), color_exponent));
    }

private:
    [[nodiscard]] glm::dvec3 lab(const Opponent& opponent, int col, int row) const {
        const double y = opponent.luminance(col, row);
        const glm::dvec3 relative(y + opponent.red_green(col, row), y,
                                  y - opponent.blue_yellow(col, row));
        const glm::dvec3 linear =
            glm::clamp(linear_from_relative_ * relative, glm::dvec3(0.0), glm::dvec3(1.0));
        return hunt_lab(relative_from_linear_ * linear);
    }

    [[nodiscard]] double redistributed(double difference) const {
        const double bend = bend_difference * max_;
        return difference < bend
                   ? bend_error * difference / bend
                   : bend_error + (1.0 - bend_error) * (difference - bend) / (max_ - bend);
    }

    glm::dmat3 relative_from_linear_;
    glm::dmat3 linear_from_relative_;
    double max_; // between green and blue
};

// Scales the positive weights to sum 1 and the negative weights to sum −1.
void balance(std::vector<double>& kernel) {
    double positive = 0.0;
    double negative = 0.0;
    for (const double weight : kernel) {
        (weight > 0.0 ? positive : negative) += std::abs(weight);
    }
    for (double& weight : kernel) {
        weight /= weight > 0.0 ? positive : negative;
    }
}

struct FeatureKernels {
    std::vector<double> smooth; // Gaussian
    std::vector<double> edge;   // its first derivative
    std::vector<double> point;  // its second derivative
};

FeatureKernels feature_kernels(double pixels_per_degree) {
    const double deviation = 0.5 * feature_width * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3.0 * deviation));
    FeatureKernels kernels;
    kernels.smooth = gaussian(deviation, radius);
    for (std::size_t k = 0; k < kernels.smooth.size(); ++k) {
        const double x = static_cast<double>(k) - radius;
        kernels.edge.push_back(-x * kernels.smooth[k]);
        kernels.point.push_back((x * x / (deviation * deviation) - 1.0) * kernels.smooth[k]);
    }
    normalize(kernels.smooth);
    balance(kernels.edge);
    balance(kernels.point);
    return kernels;
}

// Length of the vector of both axes' responses.
Plane magnitude_of(const Plane& luminance, std::span<const double> derivative,
                   std::span<const double> smooth, const FlipOptions& options) {
    Plane x = filtered(luminance, derivative, smooth, options.threads);
    const Plane y = filtered(luminance, smooth, derivative, options.threads);
    for_each_row(x.rows(), options, [&](int row) {
        for (int col = 0; col < x.cols(); ++col) {
            x(col, row) = std::sqrt(x(col, row) * x(col, row) + y(col, row) * y(col, row));
        }
    });
    return x;
}

struct Features {
    Plane edges;
    Plane points;
};

Features features_of(const Plane& luminance, const FlipOptions& options) {
    const FeatureKernels kernels = feature_kernels(options.pixels_per_degree);
    return {magnitude_of(luminance, kernels.edge, kernels.smooth, options),
            magnitude_of(luminance, kernels.point, kernels.smooth, options)};
}

// In [0,1].
double feature_difference(const Features& a, const Features& b, int col, int row) {
    const double edges = std::abs(a.edges(col, row) - b.edges(col, row));
    const double points = std::abs(a.points(col, row) - b.points(col, row));
    const double share = std::min(std::max(edges, points) / std::numbers::sqrt2, 1.0);
    return std::pow(share, feature_exponent);
}

// The compared properties of a picture.
struct Percept {
    Opponent color;
    Features features;
};

Percept percept_of(const Image& picture, const FlipOptions& options) {
    const Opponent opponent = opponent_of(picture, options);
    return {contrast_filtered(opponent, options), features_of(opponent.luminance, options)};
}

Grid<float> difference_map(const Percept& a, const Percept& b, const FlipOptions& options) {
    const ColorDifference color_difference;
    Grid<float> map(a.color.luminance.cols(), a.color.luminance.rows());
    for_each_row(map.rows(), options, [&](int row) {
        for (int col = 0; col < map.cols(); ++col) {
            const double color = color_difference.at(a.color, b.color, col, row);
            const double feature = feature_difference(a.features, b.features, col, row);
            map(col, row) = static_cast<float>(std::pow(color, 1.0 - feature));
        }
    });
    return map;
}

} // namespace

Result<Flip> flip(const Image& shown, const Image& truth, const FlipOptions& options) {
    check(options.pixels_per_degree >= 1.0, "fewer than one pixel per degree");
    if (const auto fit = check_same_size(shown, truth); !fit) {
        return fit.error();
    }
    Flip result;
    result.map = difference_map(percept_of(shown, options), percept_of(truth, options), options);
    const auto errors = result.map.samples();
    result.mean =
        std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
    return result;
}

Result<void> check_same_size(const Image& shown, const Image& truth) {
    if (shown.cols() != truth.cols() || shown.rows() != truth.rows()) {
        return Error{fmt::format("a picture of {}x{} pixels: {}x{} as the true one was expected",
                                 shown.cols(), shown.rows(), truth.cols(), truth.rows())};
    }
    if (shown.empty()) {
        return Error{fmt::format("a picture of {}x{} pixels: one pixel at least was expected",
                                 shown.cols(), shown.rows())};
    }
    return {};
}

} // namespace reljef::truth
