#pragma once

#include <array>
#include <cmath>

#include "engine/core/check.h"

namespace reljef::geo {

/// Four-point Lagrange interpolation: first control point, weights and their derivatives.
struct Cubic {
    int first = 0;
    std::array<double, 4> weights{};
    std::array<double, 4> slopes{};
};

/// At `position`, from four control points starting at `first`.
inline Cubic cubic_from(double position, int first) {
    Cubic cubic;
    cubic.first = first;
    const double u = position - first;
    const double a = u - 1.0;
    const double b = u - 2.0;
    const double c = u - 3.0;
    cubic.weights = {-a * b * c / 6.0, u * b * c / 2.0, -u * a * c / 2.0, u * a * b / 6.0};
    cubic.slopes = {-(b * c + a * c + a * b) / 6.0, (b * c + u * c + u * b) / 2.0,
                    -(a * c + u * c + u * a) / 2.0, (a * b + u * b + u * a) / 6.0};
    return cubic;
}

/// From the nearest four of `points` control points; NaN gives weights of NaN.
inline Cubic cubic_at(double position, int points) {
    return cubic_from(position, clamped_int(std::floor(position) - 1.0, 0, points - 4));
}

} // namespace reljef::geo
