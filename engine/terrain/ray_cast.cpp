#include "engine/terrain/ray_cast.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace reljef::terrain {
namespace {

// Real roots of a·t² + b·t + c in ascending order, without cancellation.
struct Roots {
    std::array<double, 2> t{};
    int count = 0;
};

Roots solve_quadratic(double a, double b, double c) {
    if (a == 0.0) {
        return b == 0.0 ? Roots{} : Roots{{-c / b, 0.0}, 1};
    }
    const double discriminant = b * b - 4.0 * a * c;
    if (discriminant < 0.0) {
        return {};
    }
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    if (q == 0.0) {
        return {{0.0, 0.0}, 1};
    }
    const auto [low, high] = std::minmax({q / a, c / q});
    return {{low, high}, 2};
}

enum class Side { unknown, above, below };

// Follows one ray through the pyramid, front to back, and remembers on which side of the surface it
// is. Intervals of t meet exactly at the planes between cells, so no crossing falls between two.
class Traversal {
public:
    // `side`: where the ray is known to be before its range begins.
    Traversal(GridView<const float> heights, const MinMaxPyramid& pyramid, const Ray& ray,
              Side side = Side::unknown)
        : heights_(heights), pyramid_(pyramid), ray_(ray), side_(side) {}

    std::optional<double> run(Interval range) {
        visit(pyramid_.levels() - 1, 0, 0, range);
        return hit_;
    }

    // Where the last stretch over the surface lay.
    [[nodiscard]] Side side() const { return side_; }

private:
    // The part of `range` in which one coordinate of the ray lies in [low, high).
    [[nodiscard]] Interval clipped(Interval range, int axis, double low, double high,
                                   bool last) const {
        const double origin = ray_.origin[axis];
        const double direction = ray_.direction[axis];
        if (direction == 0.0) {
            const bool inside = origin >= low && (origin < high || (last && origin == high));
            return inside ? range : Interval{1.0, 0.0};
        }
        const double t0 = (low - origin) / direction;
        const double t1 = (high - origin) / direction;
        return {std::max(range.begin, std::min(t0, t1)), std::min(range.end, std::max(t0, t1))};
    }

    [[nodiscard]] Interval clipped_to_block(Interval range, int level, int col, int row) const {
        const int last_col = heights_.cols() - 1;
        const int last_row = heights_.rows() - 1;
        const int east = std::min((col + 1) << level, last_col);
        const int south = std::min((row + 1) << level, last_row);
        range = clipped(range, 0, col << level, east, east == last_col);
        return clipped(range, 1, row << level, south, south == last_row);
    }

    void visit(int level, int col, int row, Interval range) {
        range = clipped_to_block(range, level, col, row);
        if (!(range.begin < range.end)) {
            return;
        }
        const MinMax bounds = pyramid_.level(level)(col, row);
        const auto [lowest, highest] = std::minmax({ray_.at(range.begin).z, ray_.at(range.end).z});
        if (lowest > bounds.high) {
            pass(lowest - bounds.high, range.begin);
        } else if (highest < bounds.low) {
            pass(highest - bounds.low, range.begin);
        } else if (level == 0) {
            visit_cell(col, row, range);
        } else {
            visit_children(level - 1, 2 * col, 2 * row, range);
        }
    }

    void visit_children(int level, int col, int row, Interval range) {
        const Grid<MinMax>& blocks = pyramid_.level(level);
        const int near_x = ray_.direction.x < 0.0 ? 1 : 0;
        const int near_y = ray_.direction.y < 0.0 ? 1 : 0;
        const std::array<std::pair<int, int>, 4> order{{{near_x, near_y},
                                                        {1 - near_x, near_y},
                                                        {near_x, 1 - near_y},
                                                        {1 - near_x, 1 - near_y}}};
        for (const auto& [x, y] : order) {
            if (!hit_ && col + x < blocks.cols() && row + y < blocks.rows()) {
                visit(level, col + x, row + y, range);
            }
        }
    }

    // Height of the ray above the bilinear patch is a quadratic in τ = t − range.begin; between its
    // roots the sign is constant and read in the middle.
    void visit_cell(int col, int row, Interval range) {
        const double h00 = heights_(col, row);
        const double h10 = heights_(col + 1, row);
        const double h01 = heights_(col, row + 1);
        const double h11 = heights_(col + 1, row + 1);
        const double twist = h00 - h10 - h01 + h11;
        const glm::dvec3 start = ray_.at(range.begin) - glm::dvec3(col, row, 0.0);
        const glm::dvec3& d = ray_.direction;
        const double slope_u = h10 - h00 + twist * start.y;
        const double slope_v = h01 - h00 + twist * start.x;
        const double a = -twist * d.x * d.y;
        const double b = d.z - slope_u * d.x - slope_v * d.y;
        const double c = start.z - (h00 + (h10 - h00) * start.x + (h01 - h00) * start.y +
                                    twist * start.x * start.y);
        const double length = range.end - range.begin;
        const Roots roots = solve_quadratic(a, b, c);
        std::array<double, 4> breaks{0.0, 0.0, 0.0, 0.0};
        std::size_t count = 1;
        for (int i = 0; i < roots.count; ++i) {
            const double root = roots.t[static_cast<std::size_t>(i)];
            if (root > 0.0 && root < length) {
                breaks[count++] = root;
            }
        }
        breaks[count] = length;
        for (std::size_t i = 0; i < count && !hit_; ++i) {
            const double middle = 0.5 * (breaks[i] + breaks[i + 1]);
            pass((a * middle + b) * middle + c, range.begin + breaks[i]);
        }
    }

    // One stretch of the ray that begins at t and lies `height` above the surface.
    void pass(double height, double t) {
        if (height > 0.0) {
            side_ = Side::above;
        } else if (height < 0.0) {
            if (side_ == Side::above) {
                hit_ = t;
            }
            side_ = Side::below;
        }
    }

    GridView<const float> heights_;
    const MinMaxPyramid& pyramid_;
    Ray ray_;
    Side side_;
    std::optional<double> hit_;
};

bool is_finite(glm::dvec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

constexpr double bend_tolerance = 1e-3; // samples, and metres of height
constexpr int most_halvings = 24;
constexpr int most_halvings_unmapped = 8; // of a stretch without a place on the map

// A world ray as seen in sample coordinates, followed front to back.
class BentRay {
public:
    BentRay(GridView<const float> heights, const MinMaxPyramid& pyramid, const Placement& placement,
            const Ray& ray)
        : heights_(heights), pyramid_(pyramid), placement_(placement), ray_(ray) {}

    std::optional<SurfaceHit> first_hit_between(double begin, double end, int halvings) {
        const auto from = placement_.sample_from_world(ray_.at(begin));
        const auto to = placement_.sample_from_world(ray_.at(end));
        const double middle = 0.5 * (begin + end);
        const auto halfway = placement_.sample_from_world(ray_.at(middle));
        const bool unmapped = !from && !to && !halfway;
        const bool straight = from && to && halfway && bend(*from, *to, *halfway) <= bend_tolerance;
        if (!straight && halvings > (unmapped ? most_halvings - most_halvings_unmapped : 0)) {
            if (const auto hit = first_hit_between(begin, middle, halvings - 1)) {
                return hit;
            }
            return first_hit_between(middle, end, halvings - 1);
        }
        if (!from || !to) {
            side_ = Side::unknown;
            return std::nullopt;
        }
        return first_hit_on({*from, *to - *from}, {begin, end});
    }

private:
    // On a straight piece, which is left at t = 1; `range` is what it is of the world ray.
    std::optional<SurfaceHit> first_hit_on(const Ray& piece, Interval range) {
        Traversal traversal(heights_, pyramid_, piece, side_);
        const auto t = traversal.run({0.0, 1.0});
        // Beyond the border the ray is neither above nor below.
        side_ = is_over_surface(piece.at(1.0)) ? traversal.side() : Side::unknown;
        if (!t) {
            return std::nullopt;
        }
        return SurfaceHit{range.begin + *t * (range.end - range.begin), piece.at(*t)};
    }

    [[nodiscard]] bool is_over_surface(glm::dvec3 sample) const {
        return sample.x >= 0.0 && sample.y >= 0.0 && sample.x <= heights_.cols() - 1 &&
               sample.y <= heights_.rows() - 1;
    }

    // How far the middle of a stretch lies from the straight line: samples, or metres of height.
    [[nodiscard]] static double bend(glm::dvec3 from, glm::dvec3 to, glm::dvec3 halfway) {
        const glm::dvec3 off = halfway - 0.5 * (from + to);
        return std::max(std::hypot(off.x, off.y), std::abs(off.z));
    }

    GridView<const float> heights_;
    const MinMaxPyramid& pyramid_;
    const Placement& placement_;
    Ray ray_;
    Side side_ = Side::unknown;
};

// The stretch of the ray that can meet the surface: inside the box around the placed border, blown
// up by the Earth's bulge over it.
std::optional<Interval> reach(GridView<const float> heights, const MinMaxPyramid& pyramid,
                              const Placement& placement, const Ray& ray) {
    Box box;
    const MinMax total = pyramid.total();
    constexpr int steps = 16;
    for (int j = 0; j <= steps; ++j) {
        for (int i = 0; i <= steps; ++i) {
            const double col = (heights.cols() - 1) * (static_cast<double>(i) / steps);
            const double row = (heights.rows() - 1) * (static_cast<double>(j) / steps);
            box.add(placement.world_from_sample({col, row, total.low}));
            box.add(placement.world_from_sample({col, row, total.high}));
        }
    }
    const glm::dvec3 margin = 0.02 * box.size() + glm::dvec3(1.0);
    return intersect(ray, Box{box.low - margin, box.high + margin});
}

} // namespace

std::optional<SurfaceHit> first_hit(GridView<const float> heights, const MinMaxPyramid& pyramid,
                                    const Ray& sample_ray, Interval range) {
    if (!is_finite(sample_ray.origin) || !is_finite(sample_ray.direction)) {
        return std::nullopt;
    }
    const auto t = Traversal(heights, pyramid, sample_ray).run(range);
    if (!t) {
        return std::nullopt;
    }
    return SurfaceHit{*t, sample_ray.at(*t)};
}

std::optional<SurfaceHit> pick(GridView<const float> heights, const MinMaxPyramid& pyramid,
                               const Placement& placement, const Ray& world_ray) {
    if (!is_finite(world_ray.origin) || !is_finite(world_ray.direction)) {
        return std::nullopt;
    }
    const auto range = reach(heights, pyramid, placement, world_ray);
    if (!range) {
        return std::nullopt;
    }
    const int halvings = placement.kind() == PlacementKind::plane ? 0 : most_halvings;
    return BentRay(heights, pyramid, placement, world_ray)
        .first_hit_between(range->begin, range->end, halvings);
}

} // namespace reljef::terrain
