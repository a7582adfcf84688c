#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/geometry.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::test {

/// How far a ray is above the surface at t.
inline double clearance(const Grid<float>& heights, const Ray& ray, double t) {
    const glm::dvec3 at = ray.at(t);
    return at.z - terrain::bilinear_height(heights.view(), glm::dvec2(at));
}

/// The part of a ray over the grid.
inline Interval over_grid(const Grid<float>& heights, const Ray& ray, Interval range) {
    for (int axis = 0; axis < 2; ++axis) {
        const double last = (axis == 0 ? heights.cols() : heights.rows()) - 1;
        const double origin = ray.origin[axis];
        const double direction = ray.direction[axis];
        if (direction == 0.0) {
            range.end = origin >= 0.0 && origin <= last ? range.end
                                                        : -std::numeric_limits<double>::infinity();
            continue;
        }
        range.begin =
            std::max(range.begin, std::min(-origin / direction, (last - origin) / direction));
        range.end = std::min(range.end, std::max(-origin / direction, (last - origin) / direction));
    }
    return range;
}

/// Where a ray passes a line between cells, and the middle of each piece between these places: in
/// each half a parabola whose vertex is added too is monotone.
inline std::vector<double> monotone_breaks(const Grid<float>& heights, const Ray& ray,
                                           Interval range) {
    std::vector<double> lines{range.begin, range.end};
    for (int axis = 0; axis < 2; ++axis) {
        const int count = axis == 0 ? heights.cols() : heights.rows();
        for (int line = 0; line < count && ray.direction[axis] != 0.0; ++line) {
            const double t = (line - ray.origin[axis]) / ray.direction[axis];
            if (t > range.begin && t < range.end) {
                lines.push_back(t);
            }
        }
    }
    std::sort(lines.begin(), lines.end());
    std::vector<double> breaks = lines;
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
        // The vertex of the parabola through both ends and the middle.
        const double half = 0.5 * (lines[i + 1] - lines[i]);
        const double middle = lines[i] + half;
        const double before = clearance(heights, ray, lines[i]);
        const double at = clearance(heights, ray, middle);
        const double after = clearance(heights, ray, lines[i + 1]);
        const double bend = before - 2.0 * at + after;
        const double vertex = bend != 0.0 ? middle + 0.5 * half * (before - after) / bend : middle;
        breaks.push_back(vertex > lines[i] && vertex < lines[i + 1] ? vertex : middle);
    }
    std::sort(breaks.begin(), breaks.end());
    return breaks;
}

/// The first change from above to below over all cells, by bisection.
inline std::optional<double> brute_force(const Grid<float>& heights, const Ray& ray,
                                         Interval range) {
    range = over_grid(heights, ray, range);
    if (!(range.begin < range.end)) {
        return std::nullopt;
    }
    double above =
        std::numeric_limits<double>::infinity(); // the last break that lies above the surface
    for (const double t : monotone_breaks(heights, ray, range)) {
        const double height = clearance(heights, ray, t);
        if (height > 0.0) {
            above = t;
        } else if (height < 0.0 && above < std::numeric_limits<double>::infinity()) {
            double low = above;
            double high = t;
            for (int i = 0; i < 200; ++i) {
                const double middle = 0.5 * (low + high);
                (clearance(heights, ray, middle) > 0.0 ? low : high) = middle;
            }
            return high;
        } else if (height < 0.0) {
            above = std::numeric_limits<double>::infinity();
        }
    }
    return std::nullopt;
}

} // namespace reljef::test
