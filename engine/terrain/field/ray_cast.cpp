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

// 1 / direction; 0 along an axis on which the ray does not move.
glm::dvec2 inverse_of(const Ray& ray) {
    glm::dvec2 inverse(0.0);
    for (int axis = 0; axis < 2; ++axis) {
        const double along = ray.direction[axis];
        inverse[axis] = along != 0.0 && std::isfinite(1.0 / along) ? 1.0 / along : 0.0;
    }
    return inverse;
}

// The t of the line between cells `line` − 1 and `line`. Lines count from the surface's first
// sample, so that tiles of any size share the same bits.
double time_at_line(const Ray& ray, double inverse, int axis, int line) {
    return (line - ray.origin[axis]) * inverse;
}

// The part of `range` between two lines of an axis.
Interval clipped_between(const Ray& ray, double inverse, int axis, glm::ivec2 lines,
                         Interval range) {
    if (inverse == 0.0) {
        const double place = ray.origin[axis];
        return place >= lines[0] && place <= lines[1] ? range : Interval{1.0, 0.0};
    }
    const auto [in, out] = std::minmax(
        {time_at_line(ray, inverse, axis, lines[0]), time_at_line(ray, inverse, axis, lines[1])});
    return {std::max(range.begin, in), std::min(range.end, out)};
}

// Whether a ray at `t` is in the cells from a line on.
bool is_past_line(const Ray& ray, double inverse, int axis, int line, double t) {
    if (inverse == 0.0) {
        return ray.origin[axis] >= line;
    }
    const double at_line = time_at_line(ray, inverse, axis, line);
    return inverse > 0.0 ? t >= at_line : t < at_line;
}

// Follows a ray front to back through the blocks of the pyramid and stores on which side of the
// surface it is. It descends where the ray may touch a block, and ascends one level where the ray
// leaves a parent. Neighbours share the t of the plane between them, so that no crossing is missed.
class Traversal {
public:
    // `side`: of the ray before its range begins.
    Traversal(const SurfaceTile& tile, const Ray& ray, Side side)
        : heights_(tile.heights), pyramid_(*tile.pyramid), first_(tile.first), ray_(ray),
          inverse_(inverse_of(ray)), side_(side), level_(pyramid_.last_level()) {}

    std::optional<double> run(Interval range) {
        begin_ = range.begin;
        range = bounded(clipped_to_top(clipped(clipped(range, 0), 1)));
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

    [[nodiscard]] double time_at(int axis, int line) const {
        return time_at_line(ray_, inverse_[axis], axis, first_[axis] + line);
    }

    // The part of `range` over the grid, along one axis.
    [[nodiscard]] Interval clipped(Interval range, int axis) const {
        return clipped_between(ray_, inverse_[axis], axis,
                               {first_[axis], first_[axis] + last(axis)}, range);
    }

    // The part of `range` below the highest sample. It begins above that sample.
    Interval clipped_to_top(Interval range) {
        const double above = z_at(range.begin) - pyramid_.total().high;
        if (range.begin < range.end && above > 0.0) {
            side_ = Side::above;
            if (ray_.direction.z >= 0.0) {
                range.begin = range.end;
                return range;
            }
            constexpr double less = 1.0 - 1e-9; // more than rounding
            const double begin = range.begin - less * above / ray_.direction.z;
            range.begin = z_at(begin) > pyramid_.total().high ? begin : range.begin;
        }
        return range;
    }

    // A vertical ray leaves the tile by its height alone.
    [[nodiscard]] Interval bounded(Interval range) const {
        if (std::isfinite(range.end)) {
            return range;
        }
        constexpr double beyond = 1.0; // metres
        const MinMax total = pyramid_.total();
        const double z = ray_.direction.z > 0.0 ? total.high + beyond : total.low - beyond;
        const double end = (z - ray_.origin.z) / ray_.direction.z;
        return {range.begin, std::isfinite(end) ? end : range.begin};
    }

    [[nodiscard]] bool is_inside() const {
        return block_.x >= 0 && block_.y >= 0 && block_.x << level_ < last(0) &&
               block_.y << level_ < last(1);
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

    // The t where the ray enters its cell. It does not depend on what was skipped before.
    [[nodiscard]] double entering_time() const {
        double t = begin_;
        for (int axis = 0; axis < 2; ++axis) {
            if (inverse_[axis] != 0.0) {
                t = std::max(t, time_at(axis, block_[axis] + (inverse_[axis] > 0.0 ? 0 : 1)));
            }
        }
        return t;
    }

    void step() {
        const double leaving_x = leaving_time(0);
        const double leaving_y = leaving_time(1);
        const double end = std::min({leaving_x, leaving_y, end_});
        if (t_ < end) {
            const double z = z_at(end);
            if (level_ == 0) {
                visit_cell({entering_time(), end}, z);
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
        return is_past_line(ray_, inverse_[axis], axis, first_[axis] + line, t_);
    }

    // To the next block, or to its parent if that changes.
    void advance(bool along_x, bool along_y) {
        const bool left_parent_x = along_x && leave_block(0);
        const bool left_parent_y = along_y && leave_block(1);
        if ((left_parent_x || left_parent_y) && level_ < pyramid_.last_level() && is_inside()) {
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
        const glm::dvec3 start = ray_.at(range.begin) - glm::dvec3(first_ + block_, 0.0);
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
    glm::ivec2 first_; // sample of the tile
    Ray ray_;
    glm::dvec2 inverse_;
    Side side_;
    int level_;
    glm::ivec2 block_{0}; // on level_
    double begin_ = 0.0;  // of the range
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
    return follow({heights, &pyramid}, sample_ray, range, Side::unknown).hit;
}

Stretch follow(const SurfaceTile& tile, const Ray& sample_ray, Interval range, Side side) {
    Traversal traversal(tile, sample_ray, side);
    const auto t = traversal.run(range);
    return {t ? std::optional(SurfaceHit{*t, sample_ray.at(*t)}) : std::nullopt, traversal.side()};
}

TileWalk::TileWalk(const TiledSurface& surface, const Ray& sample_ray, Interval range)
    : ray_(sample_ray), inverse_(inverse_of(sample_ray)), last_(surface.last_sample()),
      cells_(surface.tile_cells()) {
    for (int axis = 0; axis < 2; ++axis) {
        range = clipped_between(ray_, inverse_[axis], axis, {0, last_[axis]}, range);
    }
    t_ = range.begin;
    end_ = range.end;
    for (int axis = 0; axis < 2; ++axis) {
        int behind = (last_[axis] - 1) / cells_ + 1; // the first tile that the ray has not reached
        while (behind - tile_[axis] > 1) {
            const int middle = (tile_[axis] + behind) / 2;
            const bool is_past = is_past_line(ray_, inverse_[axis], axis, middle * cells_, t_);
            (is_past ? tile_[axis] : behind) = middle;
        }
    }
}

bool TileWalk::is_inside() const {
    const glm::ivec2 far = (last_ - 1) / cells_;
    return t_ < end_ && tile_.x >= 0 && tile_.y >= 0 && tile_.x <= far.x && tile_.y <= far.y;
}

double TileWalk::leaving_time(int axis) const {
    if (inverse_[axis] == 0.0) {
        return std::numeric_limits<double>::infinity();
    }
    const int line = (tile_[axis] + (inverse_[axis] > 0.0 ? 1 : 0)) * cells_;
    return time_at_line(ray_, inverse_[axis], axis, std::min(line, last_[axis]));
}

Interval TileWalk::stretch() const {
    return {t_, std::min({leaving_time(0), leaving_time(1), end_})};
}

void TileWalk::advance() {
    const double end = stretch().end;
    const glm::dvec2 leaving(leaving_time(0), leaving_time(1));
    for (int axis = 0; axis < 2; ++axis) {
        if (leaving[axis] <= end) {
            tile_[axis] += inverse_[axis] > 0.0 ? 1 : -1;
        }
    }
    t_ = std::max(t_, end);
}

void TileWalk::resume_at(glm::ivec2 tile) {
    tile_ = tile;
    for (int axis = 0; axis < 2; ++axis) {
        if (inverse_[axis] != 0.0) {
            const int line = (tile[axis] + (inverse_[axis] > 0.0 ? 0 : 1)) * cells_;
            t_ =
                std::max(t_, time_at_line(ray_, inverse_[axis], axis, std::min(line, last_[axis])));
        }
    }
}

} // namespace reljef::terrain
