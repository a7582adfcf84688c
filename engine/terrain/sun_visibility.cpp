#include "engine/terrain/sun_visibility.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

namespace reljef::terrain {
namespace {

constexpr double sun_angular_radius = 0.265 * 3.14159265358979323846 / 180.0;

// The sweep runs over lines of samples (rows when the light comes mostly from north or south, else
// columns), each looking at the line before it, towards the sun.
struct Sweep {
    bool by_rows;
    int lines, line_length;
    int first, direction; // line index order, away from the sun
    double shift;         // samples along a line from one line to the previous one
    double run;           // metres over the ground from one line to the previous one
};

Sweep sweep_along(GridView<const float> heights, glm::dvec2 spacing, glm::dvec3 to_sun) {
    const double cols_per_metre = to_sun.x / spacing.x;
    const double rows_per_metre = -to_sun.y / spacing.y;
    const bool by_rows = std::abs(rows_per_metre) >= std::abs(cols_per_metre);
    const double along = by_rows ? rows_per_metre : cols_per_metre;
    const double across = by_rows ? cols_per_metre : rows_per_metre;
    const int lines = by_rows ? heights.rows() : heights.cols();
    return {by_rows,
            lines,
            by_rows ? heights.cols() : heights.rows(),
            along < 0.0 ? 0 : lines - 1,
            along < 0.0 ? 1 : -1,
            across / std::abs(along),
            1.0 / std::abs(along)};
}

float sample(GridView<const float> heights, bool by_rows, int line, int index) {
    return by_rows ? heights(index, line) : heights(line, index);
}

// Height of the shadow's upper edge over a line, from the line before it.
class ShadowFront {
public:
    ShadowFront(GridView<const float> heights, const Sweep& sweep, double exaggeration, double drop)
        : heights_(heights), sweep_(sweep), exaggeration_(exaggeration), drop_(drop),
          edge_(static_cast<std::size_t>(sweep.line_length), -1e30), next_(edge_) {}

    // Moves to `line`; `previous` is the line before it.
    void advance(int previous) {
        for (int i = 0; i < sweep_.line_length; ++i) {
            const double place = i + sweep_.shift;
            const double floor_place = std::floor(place);
            const int left = static_cast<int>(floor_place);
            next_[static_cast<std::size_t>(i)] =
                left < 0 || left + 1 >= sweep_.line_length
                    ? -1e30
                    : std::lerp(top(previous, left), top(previous, left + 1), place - floor_place) -
                          drop_;
        }
        std::swap(edge_, next_);
    }

    [[nodiscard]] double edge(int index) const { return edge_[static_cast<std::size_t>(index)]; }

private:
    [[nodiscard]] double top(int line, int index) const {
        return std::max(edge(index),
                        exaggeration_ * sample(heights_, sweep_.by_rows, line, index));
    }

    GridView<const float> heights_;
    Sweep sweep_;
    double exaggeration_;
    double drop_;
    std::vector<double> edge_;
    std::vector<double> next_;
};

std::uint8_t byte_share(double share) {
    const double smooth = std::clamp(share, 0.0, 1.0);
    return static_cast<std::uint8_t>(std::lround(255.0 * smooth * smooth * (3.0 - 2.0 * smooth)));
}

} // namespace

Grid<std::uint8_t> sun_visibility(GridView<const float> heights, glm::dvec2 spacing,
                                  double exaggeration, glm::dvec3 to_sun) {
    const double horizontal = std::hypot(to_sun.x, to_sun.y);
    const bool below = !(to_sun.z > 0.0);
    Grid<std::uint8_t> visible(heights.cols(), heights.rows(), below ? 0 : 255);
    if (below || heights.empty() || horizontal <= 1e-9 * to_sun.z) {
        return visible; // nothing lit, or a sun in the zenith: no shadow reaches a sample away
    }
    const glm::dvec3 unit_run = to_sun / horizontal;
    const Sweep sweep = sweep_along(heights, spacing, unit_run);
    const double drop = sweep.run * unit_run.z;
    // Half a sample of the shadow's way over the ground, at least the sun's own blur over that way.
    const double penumbra = 0.5 * drop + 2.0 * sun_angular_radius * sweep.run;
    ShadowFront front(heights, sweep, exaggeration, drop);
    for (int n = 1; n < sweep.lines; ++n) {
        const int line = sweep.first + n * sweep.direction;
        front.advance(line - sweep.direction);
        for (int i = 0; i < sweep.line_length; ++i) {
            const double buried =
                front.edge(i) - exaggeration * sample(heights, sweep.by_rows, line, i);
            auto& share = sweep.by_rows ? visible(i, line) : visible(line, i);
            share = byte_share(0.5 - 0.5 * buried / penumbra);
        }
    }
    return visible;
}

std::uint8_t resampled(const Grid<std::uint8_t>& mask, int col, int row, glm::ivec2 size) {
    const auto place = [](int index, int from, int to) {
        return from > 1 ? static_cast<double>(index) * (to - 1) / (from - 1) : 0.0;
    };
    const double x = place(col, size.x, mask.cols());
    const double y = place(row, size.y, mask.rows());
    const int left = static_cast<int>(x);
    const int top = static_cast<int>(y);
    const double u = x - left;
    const double v = y - top;
    const double north = std::lerp(mask.clamped(left, top), mask.clamped(left + 1, top), u);
    const double south = std::lerp(mask.clamped(left, top + 1), mask.clamped(left + 1, top + 1), u);
    return static_cast<std::uint8_t>(std::lround(std::lerp(north, south, v)));
}

} // namespace reljef::terrain
