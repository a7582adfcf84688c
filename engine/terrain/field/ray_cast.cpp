#include "engine/terrain/field/ray_cast.h"

#include <algorithm>
#include <array>
#include <cmath>

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

// Follows a ray front to back through the blocks of the pyramid and stores on which side of the
// surface it is. It descends where the ray may touch a block, and ascends one level where the ray
// leaves a parent. Neighbours share the t of the plane between them, so that no crossing is missed.
class Traversal {
public:
    // `side`: of the ray before its range begins.
    Traversal(GridView<const float> heights, const MinMaxPyramid& pyramid, const Ray& ray,
              Side side)
        : heights_(heights), pyramid_(pyramid), ray_(ray), side_(side),
          level_(pyramid.levels() - 1) {
        for (int axis = 0; axis < 2; ++axis) {
            const double along = ray.direction[axis];
            inverse_[axis] = along != 0.0 ? 1.0 / along : 0.0;
            if (!std::isfinite(inverse_[axis])) {
                inverse_[axis] = 0.0;
            }
        }
    }

    std::optional<double> run(Interval range) {
        range = clipped_to_top(clipped(clipped(range, 0), 1));
        t_ = range.begin;
        z_ = z_at(t_);
        end_ = range.end;
        while (t_ < end_ && !hit_ && is_inside() && !has_escaped()) {
            step();
        }
        return hit_;
    }

    [[nodiscard]] Side side() const { return side_; }

private:
    [[nodiscard]] int last(int axis) const {
        return (axis == 0 ? heights_.cols() : heights_.rows()) - 1;
    }

    [[nodiscard]] double z_at(double t) const { return ray_.origin.z + t * ray_.direction.z; }

    // The t of the line between cells `line` − 1 and `line`.
    [[nodiscard]] double time_at(int axis, int line) const {
        return (line - ray_.origin[axis]) * inverse_[axis];
    }

    // The part of `range` over the grid, along one axis.
    [[nodiscard]] Interval clipped(Interval range, int axis) const {
        if (inverse_[axis] == 0.0) {
            const double place = ray_.origin[axis];
            return place >= 0.0 && place <= last(axis) ? range : Interval{1.0, 0.0};
        }
        const auto [in, out] = std::minmax({time_at(axis, 0), time_at(axis, last(axis))});
        return {std::max(range.begin, in), std::min(range.end, out)};
    }

    // The part of `range` below the highest sample.
    Interval clipped_to_top(Interval range) {
        const double above = z_at(range.begin) - pyramid_.total().high;
        if (range.begin < range.end && above > 0.0) {
            side_ = Side::above;
            range.begin = ray_.direction.z < 0.0
                              ? std::max(range.begin, range.begin - above / ray_.direction.z)
                              : range.end;
        }
        return range;
    }

    [[nodiscard]] bool is_inside() const {
        const Grid<MinMax>& blocks = pyramid_.level(level_);
        return block_.x >= 0 && block_.y >= 0 && block_.x < blocks.cols() &&
               block_.y < blocks.rows();
    }

    [[nodiscard]] bool has_escaped() const {
        return (side_ == Side::above && ray_.direction.z >= 0.0 && z_ > pyramid_.total().high) ||
               (side_ == Side::below && ray_.direction.z <= 0.0 && z_ < pyramid_.total().low);
    }

    // The t where the ray leaves its block.
    [[nodiscard]] double leaving_time(int axis) const {
        if (inverse_[axis] == 0.0) {
            return std::numeric_limits<double>::infinity();
        }
        return time_at(axis, (block_[axis] + (inverse_[axis] > 0.0 ? 1 : 0)) << level_);
    }

    void step() {
        const double leaving_x = leaving_time(0);
        const double leaving_y = leaving_time(1);
        const double end = std::min({leaving_x, leaving_y, end_});
        if (t_ < end) {
            const double z = z_at(end);
            if (level_ == 0) {
                visit_cell({t_, end}, z);
            } else if (!passes(pyramid_.level(level_)(block_.x, block_.y), z)) {
                descend();
                return;
            }
            t_ = end;
            z_ = z;
        }
        advance(leaving_x <= end, leaving_y <= end);
    }

    // Whether the ray passes above or below a block that it leaves at height `z`.
    bool passes(MinMax bounds, double z) {
        const auto [lowest, highest] = std::minmax({z_, z});
        if (lowest > bounds.high) {
            pass(lowest - bounds.high, t_);
            return true;
        }
        if (highest < bounds.low) {
            pass(highest - bounds.low, t_);
            return true;
        }
        return false;
    }

    void descend() {
        --level_;
        for (int axis = 0; axis < 2; ++axis) {
            const int middle = (2 * block_[axis] + 1) << level_;
            block_[axis] = 2 * block_[axis] + (middle < last(axis) && is_beyond(axis, middle));
        }
    }

    [[nodiscard]] bool is_beyond(int axis, int line) const {
        if (inverse_[axis] == 0.0) {
            return ray_.origin[axis] >= line;
        }
        return inverse_[axis] > 0.0 ? t_ >= time_at(axis, line) : t_ < time_at(axis, line);
    }

    // To the next block, or to its parent if that changes.
    void advance(bool along_x, bool along_y) {
        const bool left_parent_x = along_x && leave_block(0);
        const bool left_parent_y = along_y && leave_block(1);
        if ((left_parent_x || left_parent_y) && level_ + 1 < pyramid_.levels() && is_inside()) {
            ++level_;
            block_ = block_ / 2;
        }
    }

    // Whether the next block has another parent.
    bool leave_block(int axis) {
        const bool forward = inverse_[axis] > 0.0;
        block_[axis] += forward ? 1 : -1;
        return (block_[axis] % 2 == 0) == forward;
    }

    // The height of the ray above the bilinear patch is a quadratic in τ = t − range.begin. Between
    // its roots the sign is constant. The ray leaves the cell at height `z`.
    void visit_cell(Interval range, double z) {
        const double h00 = heights_(block_.x, block_.y);
        const double h10 = heights_(block_.x + 1, block_.y);
        const double h01 = heights_(block_.x, block_.y + 1);
        const double h11 = heights_(block_.x + 1, block_.y + 1);
        if (passes({static_cast<float>(std::min(std::min(h00, h10), std::min(h01, h11))),
                    static_cast<float>(std::max(std::max(h00, h10), std::max(h01, h11)))},
                   z)) {
            return;
        }
        const double twist = h00 - h10 - h01 + h11;
        const glm::dvec3 start = ray_.at(range.begin) - glm::dvec3(block_, 0.0);
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

    // A stretch of the ray that begins at t, `height` above the surface.
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
    glm::dvec2 inverse_{0.0}; // 1 / direction; 0 for a ray that does not move along the axis
    Side side_;
    int level_;
    glm::ivec2 block_{0}; // on level_
    double t_ = 0.0;      // position of the ray
    double z_ = 0.0;      // its height there
    double end_ = 0.0;
    std::optional<double> hit_;
};

} // namespace

std::optional<SurfaceHit> first_hit(GridView<const float> heights, const MinMaxPyramid& pyramid,
                                    const Ray& sample_ray, Interval range) {
    if (!is_finite(sample_ray)) {
        return std::nullopt;
    }
    return follow(heights, pyramid, sample_ray, range, Side::unknown).hit;
}

Stretch follow(GridView<const float> heights, const MinMaxPyramid& pyramid, const Ray& sample_ray,
               Interval range, Side side) {
    Traversal traversal(heights, pyramid, sample_ray, side);
    const auto t = traversal.run(range);
    return {t ? std::optional(SurfaceHit{*t, sample_ray.at(*t)}) : std::nullopt, traversal.side()};
}

} // namespace reljef::terrain
