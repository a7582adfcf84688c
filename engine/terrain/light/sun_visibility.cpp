#include "engine/terrain/light/sun_visibility.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
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

// Where a line's places lie on the previous line: so many samples farther, and a part of the next.
struct Step {
    int whole;
    double part;
};

Step step_of(double shift) {
    const double whole = std::floor(shift + border_slack);
    return {static_cast<int>(whole), std::max(shift - whole, 0.0)};
}

// The highest shadow edges over a line of samples: heights, and horizontal metres from what casts
// them.
class ShadowFront {
public:
    // `drop`: metres that an edge falls from line to line. The highest edge is the one with the
    // largest height + widening * run.
    ShadowFront(const Sweep& sweep, double drop, double widening)
        : sweep_(sweep), drop_(drop), widening_(widening), step_(step_of(sweep.shift)),
          height_(static_cast<std::size_t>(sweep.line_length), nothing), run_(height_.size(), 0.0),
          top_height_(height_.size() + 1), top_run_(height_.size() + 1) {}

    // `ground`: the heights of the previous line.
    void advance(std::span<const double> ground) {
        raise_to(ground);
        const int last = sweep_.line_length - 1;
        if (sweep_.around && sweep_.by_rows) {
            for (int i = 0; i <= last; ++i) {
                move(i, ((i + step_.whole) % last + last) % last, 1);
            }
            return;
        }
        const int last_from = step_.part > border_slack ? last - 1 : last;
        const int begin = std::clamp(-step_.whole, 0, last + 1);
        const int end = std::clamp(last_from + 1 - step_.whole, begin, last + 1);
        forget(0, begin);
        move(begin, begin + step_.whole, end - begin);
        forget(end, last + 1);
    }

    // Below this height over a sample the sun's middle is hidden, metres.
    [[nodiscard]] double height(std::size_t index) const { return height_[index]; }

    // Visible share of the sun at a height over a sample, not clamped to [0,1]. The penumbra is
    // `spread` metres per metre of run to each side, and at least `min_height` metres high.
    [[nodiscard]] double share(std::size_t index, double height, double spread,
                               double min_height) const {
        return 0.5 - (height_[index] - height) / std::max(2.0 * spread * run_[index], min_height);
    }

private:
    static constexpr double nothing = -1e30; // metres

    void raise_to(std::span<const double> ground) {
        for (std::size_t i = 0; i < height_.size(); ++i) {
            const bool is_above = height_[i] + widening_ * run_[i] > ground[i];
            top_height_[i] = is_above ? height_[i] : ground[i];
            top_run_[i] = is_above ? run_[i] : 0.0;
        }
        top_height_.back() = top_height_[height_.size() - 1];
        top_run_.back() = top_run_[height_.size() - 1];
    }
    // Edges at `count` samples, from those between the previous line's samples `from` and the next.
    void move(int to, int from, int count) {
        const auto size = static_cast<std::size_t>(count);
        const auto old_heights = std::span(top_height_).subspan(static_cast<std::size_t>(from));
        const auto old_runs = std::span(top_run_).subspan(static_cast<std::size_t>(from));
        const auto heights = std::span(height_).subspan(static_cast<std::size_t>(to), size);
        const auto runs = std::span(run_).subspan(static_cast<std::size_t>(to), size);
        for (std::size_t i = 0; i < size; ++i) {
            heights[i] =
                old_heights[i] + step_.part * (old_heights[i + 1] - old_heights[i]) - drop_;
            runs[i] = old_runs[i] + step_.part * (old_runs[i + 1] - old_runs[i]) + sweep_.run;
        }
    }
    void forget(int begin, int end) {
        std::fill(height_.begin() + begin, height_.begin() + end, nothing);
        std::fill(run_.begin() + begin, run_.begin() + end, 0.0);
    }

    Sweep sweep_;
    double drop_;
    double widening_;
    Step step_;
    std::vector<double> height_;
    std::vector<double> run_;
    std::vector<double> top_height_; // of the previous line and its ground; the last one twice
    std::vector<double> top_run_;
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
    const double share_of_bytes = 255.0 * smooth * smooth * (3.0 - 2.0 * smooth);
    return static_cast<std::uint8_t>(std::floor(share_of_bytes + 0.5)); // lround is a slow call
}

// The ground's heights along the lines, metres.
class Ground {
public:
    Ground(GridView<const float> heights, const Sweep& sweep, double exaggeration)
        : heights_(heights), by_rows_(sweep.by_rows), exaggeration_(exaggeration),
          line_(static_cast<std::size_t>(sweep.line_length)) {}

    std::span<const double> at(int line) {
        if (line != read_) {
            for (std::size_t i = 0; i < line_.size(); ++i) {
                line_[i] = exaggeration_ * sample(heights_, by_rows_, line, static_cast<int>(i));
            }
            read_ = line;
        }
        return line_;
    }

private:
    GridView<const float> heights_;
    bool by_rows_;
    double exaggeration_;
    std::vector<double> line_;
    int read_ = -1;
};

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
    ShadowFront deep(sweep, drop, 0.0);
    ShadowFront wide(sweep, drop, spread);
    Ground ground(heights, sweep, exaggeration);
    for (const auto& [line, previous] : lines_of(sweep)) {
        deep.advance(ground.at(previous));
        wide.advance(ground.at(previous));
        const std::span<const double> here = ground.at(line);
        for (std::size_t i = 0; i < here.size(); ++i) {
            const int at = static_cast<int>(i);
            (sweep.by_rows ? visible(at, line) : visible(line, at)) = byte_share(std::min(
                deep.share(i, here[i], spread, drop), wide.share(i, here[i], spread, drop)));
        }
    }
    for (int row = 0; sweep.around && row < heights.rows(); ++row) {
        const int from = sweep.direction > 0 ? heights.cols() - 1 : 0;
        visible(heights.cols() - 1 - from, row) = visible(from, row);
    }
    return visible;
}

Grid<float> shadow_heights(GridView<const float> heights, glm::dvec2 spacing, double exaggeration,
                           glm::dvec3 to_sun) {
    constexpr float no_height = std::numeric_limits<float>::infinity();
    const double horizontal = std::hypot(to_sun.x, to_sun.y);
    const bool below = !(to_sun.z > 0.0);
    Grid<float> edges(heights.cols(), heights.rows(), below ? no_height : -no_height);
    if (below || heights.empty() || horizontal <= 1e-9 * to_sun.z) {
        return edges; // night, or a sun in the zenith
    }
    const glm::dvec3 unit_run = to_sun / horizontal;
    const Sweep sweep = sweep_along(heights, spacing, unit_run);
    ShadowFront front(sweep, sweep.run * unit_run.z, 0.0);
    Ground ground(heights, sweep, exaggeration);
    for (const auto& [line, previous] : lines_of(sweep)) {
        front.advance(ground.at(previous));
        for (int at = 0; at < sweep.line_length; ++at) {
            constexpr double lowest = -std::numeric_limits<float>::max();
            const double height =
                std::max(front.height(static_cast<std::size_t>(at)) / exaggeration, lowest);
            (sweep.by_rows ? edges(at, line) : edges(line, at)) = static_cast<float>(height);
        }
    }
    return edges;
}

} // namespace reljef::terrain
