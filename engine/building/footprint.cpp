#include "engine/building/footprint.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include <glm/geometric.hpp>

namespace reljef::building {
namespace {

double cross(glm::dvec2 a, glm::dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

// Whether b lies near the line from a to c, or all of them at one place.
bool is_straight(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    const double length = glm::distance(a, c);
    const bool is_spike = glm::dot(b - a, c - b) < 0.0 && length < outline_precision;
    return is_spike || glm::distance(a, b) < outline_precision ||
           std::abs(cross(b - a, c - a)) < outline_precision * length;
}

} // namespace

double signed_area(const Ring& ring) {
    double twice = 0.0;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
        twice += cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
    }
    return 0.5 * twice;
}

glm::dvec2 middle_of(const Ring& ring) {
    glm::dvec2 sum(0.0);
    for (const glm::dvec2 corner : ring) {
        sum += corner;
    }
    return sum / static_cast<double>(ring.size());
}

Ring without_straight_corners(const Ring& ring) {
    Ring kept = ring;
    for (std::size_t i = 0; i < kept.size() && kept.size() >= 3;) {
        const std::size_t n = kept.size();
        if (is_straight(kept[(i + n - 1) % n], kept[i], kept[(i + 1) % n])) {
            kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(i));
            i = i > 0 ? i - 1 : 0;
        } else {
            ++i;
        }
    }
    return kept.size() >= 3 ? kept : Ring();
}

bool is_convex(const Ring& ring) {
    const std::size_t n = ring.size();
    double turn = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec2 in = ring[(i + 1) % n] - ring[i];
        const glm::dvec2 out = ring[(i + 2) % n] - ring[(i + 1) % n];
        const double angle = std::atan2(cross(in, out), glm::dot(in, out));
        if (!(angle > 0.0)) {
            return false;
        }
        turn += angle;
    }
    return n >= 3 && turn < 3.0 * std::numbers::pi; // one turn, not two
}

} // namespace reljef::building
