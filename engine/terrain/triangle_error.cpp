#include "engine/terrain/triangle_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

// Why this is exact. Over a cell the surface less the triangle's plane is a + b u + c v + t u v
// with the cell's twist t = h00 - h10 - h01 + h11: a saddle, or a plane where t = 0, so it has no
// extremum inside any region. The triangle's edges run along cell borders or through opposite
// corners of cells, so it covers a cell wholly, or one half of it. A region's border consists of
// sides of the cell, where the difference is linear and greatest at a sample, and of the cell's
// diagonal, where it is the parabola d0 + (d1 - d0 - s) x + s x² with s = t from the first to the
// last corner, where uv = x², and s = -t across, where uv = x - x². All samples of the triangle and
// the vertices of the parabolas along its diagonal edges thus hold the greatest.

namespace reljef::terrain {
namespace {

// A plane over samples, relative to its first corner.
struct SlopedPlane {
    glm::ivec2 origin{0};
    double height = 0.0;
    double by_col = 0.0;
    double by_row = 0.0;

    [[nodiscard]] double at(int col, int row) const {
        return height + by_col * (col - origin.x) + by_row * (row - origin.y);
    }
};

SlopedPlane plane_through(GridView<const float> heights, const SampleTriangle& triangle) {
    const glm::ivec2 a = triangle[0];
    const glm::dvec2 p(triangle[1] - a);
    const glm::dvec2 q(triangle[2] - a);
    const double height = heights(a.x, a.y);
    const double at_p = heights(triangle[1].x, triangle[1].y) - height;
    const double at_q = heights(triangle[2].x, triangle[2].y) - height;
    const double area = p.x * q.y - p.y * q.x;
    check(area != 0.0, "a triangle without an area");
    return {a, height, (at_p * q.y - at_q * p.y) / area, (at_q * p.x - at_p * q.x) / area};
}

// First and last column of a triangle in a row.
struct ColumnSpan {
    int first = std::numeric_limits<int>::max();
    int last = std::numeric_limits<int>::min();

    void add(int col) {
        first = std::min(first, col);
        last = std::max(last, col);
    }
    void add_edge(glm::ivec2 from, glm::ivec2 to, int row) {
        if (row < std::min(from.y, to.y) || row > std::max(from.y, to.y)) {
            return;
        }
        if (from.y == to.y) {
            add(from.x);
            add(to.x);
        } else {
            add(from.x + (row - from.y) * (to.x - from.x) / (to.y - from.y));
        }
    }
};

ColumnSpan span_in(const SampleTriangle& triangle, int row) {
    ColumnSpan span;
    for (std::size_t i = 0; i < 3; ++i) {
        span.add_edge(triangle[i], triangle[(i + 1) % 3], row);
    }
    return span;
}

double greatest_at_samples(GridView<const float> heights, const SampleTriangle& triangle,
                           const SlopedPlane& plane) {
    const auto [low, high] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
    double greatest = 0.0;
    for (int row = low; row <= high; ++row) {
        const ColumnSpan span = span_in(triangle, row);
        const double begin = plane.at(span.first, row);
        for (int col = span.first; col <= span.last; ++col) {
            const double over = heights(col, row) - (begin + plane.by_col * (col - span.first));
            greatest = std::max(greatest, std::abs(over));
        }
    }
    return greatest;
}

// |d0 + (d1 - d0 - s) x + s x²| at its vertex, where that lies between 0 and 1.
double parabola_vertex(double at_begin, double at_end, double bend) {
    const double slope = at_end - at_begin - bend;
    const bool is_between = std::abs(slope) < 2.0 * std::abs(bend) && slope * bend < 0.0;
    return is_between ? std::abs(at_begin - slope * slope / (4.0 * bend)) : 0.0;
}

double greatest_along(GridView<const float> heights, const SlopedPlane& plane, glm::ivec2 from,
                      glm::ivec2 to) {
    if (from.x == to.x || from.y == to.y) {
        return 0.0;
    }
    const glm::ivec2 step(to.x > from.x ? 1 : -1, to.y > from.y ? 1 : -1);
    double greatest = 0.0;
    for (glm::ivec2 place = from; place != to; place += step) {
        const glm::ivec2 next = place + step;
        const double begin = heights(place.x, place.y);
        const double end = heights(next.x, next.y);
        const double across =
            static_cast<double>(heights(place.x, next.y)) + heights(next.x, place.y);
        greatest = std::max(greatest,
                            parabola_vertex(begin - plane.at(place.x, place.y),
                                            end - plane.at(next.x, next.y), begin + end - across));
    }
    return greatest;
}

} // namespace

double triangle_error(GridView<const float> heights, const SampleTriangle& triangle) {
    const SlopedPlane plane = plane_through(heights, triangle);
    double greatest = greatest_at_samples(heights, triangle, plane);
    for (std::size_t i = 0; i < 3; ++i) {
        greatest =
            std::max(greatest, greatest_along(heights, plane, triangle[i], triangle[(i + 1) % 3]));
    }
    return greatest;
}

} // namespace reljef::terrain
