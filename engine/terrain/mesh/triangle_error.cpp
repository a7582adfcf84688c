#include "engine/terrain/mesh/triangle_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

// Why this is exact. In a cell with the twist t = h00 - h10 - h01 + h11, surface minus plane is
// a + b u + c v + t u v: a saddle or a plane, without an extremum inside a region. The triangle
// covers a cell completely or one half of it, because its edges run along cell borders or through
// opposite corners. Along the sides of the cell the difference is linear, with its maximum at a
// sample. Along the diagonal it is the parabola d0 + (d1 - d0 - s) x + s x², with s = t from the
// first to the last corner (uv = x²) and s = -t across (uv = x - x²). So the maximum lies at a
// sample of the triangle or at a parabola's vertex on a diagonal edge.

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

struct TriangleSide {
    glm::ivec2 upper;
    glm::ivec2 lower;
    int cols_per_row = 0; // -1, 0 or 1

    TriangleSide(glm::ivec2 a, glm::ivec2 b)
        : upper(a.y <= b.y ? a : b), lower(a.y <= b.y ? b : a) {
        cols_per_row =
            upper.y == lower.y ? 0 : (lower.x > upper.x ? 1 : 0) - (lower.x < upper.x ? 1 : 0);
    }
};

// First and last column of a triangle in a row.
struct ColumnSpan {
    int first = std::numeric_limits<int>::max();
    int last = std::numeric_limits<int>::min();

    void add(int col) {
        first = std::min(first, col);
        last = std::max(last, col);
    }
    void add_side(const TriangleSide& side, int row) {
        if (row < side.upper.y || row > side.lower.y) {
            return;
        }
        add(side.upper.x + (row - side.upper.y) * side.cols_per_row);
        if (side.upper.y == side.lower.y) {
            add(side.lower.x);
        }
    }
};

// Maximum of |height - plane| along a row. Four independent maxima keep the pipeline full.
double greatest_in_row(std::span<const float> heights, double begin, double by_col) {
    std::array<double, 4> greatest{};
    const std::size_t whole = heights.size() / 4 * 4;
    const auto over = [&](std::size_t i) {
        return std::abs(heights[i] - (begin + by_col * static_cast<double>(i)));
    };
    for (std::size_t i = 0; i < whole; i += 4) {
        for (std::size_t k = 0; k < 4; ++k) {
            greatest[k] = std::max(greatest[k], over(i + k));
        }
    }
    for (std::size_t i = whole; i < heights.size(); ++i) {
        greatest[0] = std::max(greatest[0], over(i));
    }
    return std::max({greatest[0], greatest[1], greatest[2], greatest[3]});
}

double greatest_at_samples(GridView<const float> heights, const SampleTriangle& triangle,
                           const SlopedPlane& plane) {
    const std::array sides{TriangleSide(triangle[0], triangle[1]),
                           TriangleSide(triangle[1], triangle[2]),
                           TriangleSide(triangle[2], triangle[0])};
    const auto [low, high] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
    double greatest = 0.0;
    for (int row = low; row <= high; ++row) {
        ColumnSpan span;
        for (const TriangleSide& side : sides) {
            span.add_side(side, row);
        }
        const auto first = static_cast<std::size_t>(span.first);
        const auto last = static_cast<std::size_t>(span.last);
        const auto in_row = heights.row(row).subspan(first, last - first + 1);
        greatest =
            std::max(greatest, greatest_in_row(in_row, plane.at(span.first, row), plane.by_col));
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
