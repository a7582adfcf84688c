#include "engine/terrain/field/sun_visibility.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace reljef::terrain {
namespace {

constexpr double sun_angular_radius = 0.265 * 3.14159265358979323846 / 180.0;

// The sweep runs over lines of samples: rows if the light comes mostly from north or south, else
// columns. Each line uses the previous one, towards the sun.
struct Sweep {
    bool by_rows;
    int lines, line_length;
    int first, direction; // order of the lines, away from the sun
    double shift;         // samples along a line to the previous line
    double run;           // horizontal metres to the previous line
    bool around = false;  // the last column is the same place as the first
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

// Rounding of a sun's direction, samples: places so close to the border count as on it.
constexpr double border_slack = 1e-6;

// The upper edge of a shadow over a sample.
struct Edge {
    double height = -1e30; // metres
    double run = 0.0;      // horizontal metres from the occluder
};

Edge between(Edge a, Edge b, double t) {
    return {std::lerp(a.height, b.height, t), std::lerp(a.run, b.run, t)};
}

// The highest shadow edges over a line of samples.
class ShadowFront {
public:
    // `drop`: metres that an edge falls from line to line. The highest edge is the one with the
    // largest height + widening * run.
    ShadowFront(GridView<const float> heights, const Sweep& sweep, double exaggeration, double drop,
                double widening)
        : heights_(heights), sweep_(sweep), exaggeration_(exaggeration), drop_(drop),
          widening_(widening), edges_(static_cast<std::size_t>(sweep.line_length)), next_(edges_) {}

    void advance(int previous) {
        for (int i = 0; i < sweep_.line_length; ++i) {
            const double last = sweep_.line_length - 1;
            const double desired = on_line(i + sweep_.shift);
            const double place = std::clamp(desired, 0.0, last);
            Edge& edge = next_[static_cast<std::size_t>(i)];
            if (std::abs(desired - place) > border_slack) {
                edge = {}; // beyond the border
                continue;
            }
            const int left = static_cast<int>(place);
            const int right = std::min(left + 1, sweep_.line_length - 1);
            edge = between(top(previous, left), top(previous, right), place - left);
            edge.height -= drop_;
            edge.run += sweep_.run;
        }
        std::swap(edges_, next_);
    }

    // Visible share of the sun at a height over a sample, not clamped to [0,1]. The penumbra is
    // `spread` metres per metre of run to each side, and at least `min_height` metres high.
    [[nodiscard]] double share(int index, double height, double spread, double min_height) const {
        const Edge& edge = edges_[static_cast<std::size_t>(index)];
        return 0.5 - (edge.height - height) / std::max(2.0 * spread * edge.run, min_height);
    }

private:
    [[nodiscard]] double on_line(double place) const {
        const double turn = sweep_.line_length - 1;
        return sweep_.around && sweep_.by_rows ? place - turn * std::floor(place / turn) : place;
    }
    [[nodiscard]] Edge top(int line, int index) const {
        const double ground = exaggeration_ * sample(heights_, sweep_.by_rows, line, index);
        const Edge& edge = edges_[static_cast<std::size_t>(index)];
        return edge.height + widening_ * edge.run > ground ? edge : Edge{ground, 0.0};
    }

    GridView<const float> heights_;
    Sweep sweep_;
    double exaggeration_;
    double drop_;
    double widening_;
    std::vector<Edge> edges_;
    std::vector<Edge> next_;
};

// The lines in order, each with the previous one. Lines around the Earth are swept twice, so that
// the first ones see the last.
std::vector<std::pair<int, int>> lines_of(const Sweep& sweep) {
    const bool twice = sweep.around && !sweep.by_rows;
    const int last = sweep.lines - 1;
    std::vector<std::pair<int, int>> lines;
    for (int n = 1; n <= (twice ? 2 * last : last); ++n) {
        const int at = sweep.first + ((n - 1) % last + 1) * sweep.direction;
        lines.emplace_back(at, at - sweep.direction);
    }
    return lines;
}

std::uint8_t byte_share(double share) {
    const double smooth = std::clamp(share, 0.0, 1.0);
    return static_cast<std::uint8_t>(std::lround(255.0 * smooth * smooth * (3.0 - 2.0 * smooth)));
}

} // namespace

Grid<std::uint8_t> sun_visibility(GridView<const float> heights, glm::dvec2 spacing,
                                  double exaggeration, glm::dvec3 to_sun, bool around) {
    const double horizontal = std::hypot(to_sun.x, to_sun.y);
    const bool below = !(to_sun.z > 0.0);
    Grid<std::uint8_t> visible(heights.cols(), heights.rows(), below ? 0 : 255);
    if (below || heights.empty() || horizontal <= 1e-9 * to_sun.z) {
        return visible; // night, or a sun in the zenith
    }
    const glm::dvec3 unit_run = to_sun / horizontal;
    Sweep sweep = sweep_along(heights, spacing, unit_run);
    sweep.around = around && heights.cols() >= 2;
    const double drop = sweep.run * unit_run.z;
    // Half the disc as metres of height per metre of run. The rays of the lower limb still fall.
    const double spread =
        std::min(sun_angular_radius * (1.0 + unit_run.z * unit_run.z), 0.5 * unit_run.z);
    // The edges that hide the disc's middle, and those that reach farthest into its upper half.
    ShadowFront deep(heights, sweep, exaggeration, drop, 0.0);
    ShadowFront wide(heights, sweep, exaggeration, drop, spread);
    for (const auto& [line, previous] : lines_of(sweep)) {
        deep.advance(previous);
        wide.advance(previous);
        for (int i = 0; i < sweep.line_length; ++i) {
            const double height = exaggeration * sample(heights, sweep.by_rows, line, i);
            (sweep.by_rows ? visible(i, line) : visible(line, i)) = byte_share(
                std::min(deep.share(i, height, spread, drop), wide.share(i, height, spread, drop)));
        }
    }
    for (int row = 0; sweep.around && row < heights.rows(); ++row) {
        const int from = sweep.direction > 0 ? heights.cols() - 1 : 0;
        visible(heights.cols() - 1 - from, row) = visible(from, row);
    }
    return visible;
}

} // namespace reljef::terrain
