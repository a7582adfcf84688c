#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/building/footprint.h"

namespace reljef::test {

/// Corners on an ellipse, counter-clockwise: convex. 3 to 9 corners.
inline building::Ring random_convex(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const int corners = 3 + static_cast<int>(seed % 7U);
    const glm::dvec2 radius(4.0 + 20.0 * share(random), 4.0 + 20.0 * share(random));
    const glm::dvec2 middle(1000.0 * share(random), -1000.0 * share(random));
    building::Ring ring;
    for (int i = 0; i < corners; ++i) {
        const double angle = 6.283185307 * (i + 0.6 * share(random)) / corners;
        ring.push_back(middle + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    return ring;
}

/// A place in a convex ring.
inline glm::dvec2 random_place(const building::Ring& ring, std::mt19937& random) {
    std::uniform_real_distribution<double> share(1e-3, 1.0);
    glm::dvec2 sum(0.0);
    double total = 0.0;
    for (const glm::dvec2 corner : ring) {
        const double weight = share(random);
        sum += weight * corner;
        total += weight;
    }
    return sum / total;
}

inline building::Ring rectangle_ring(glm::dvec2 low, glm::dvec2 high) {
    return {low, {high.x, low.y}, high, {low.x, high.y}};
}

} // namespace reljef::test
