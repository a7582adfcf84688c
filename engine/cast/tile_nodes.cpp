#include "engine/cast/tile_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace reljef::cast {
namespace {

constexpr double far_beyond = std::numeric_limits<double>::infinity();

// Floats have errors of 2^-24 of the distance from the rays' anchor, and a ray adds a few of them.
constexpr double place_rounding = 0x1p-24;
constexpr double ray_rounding = 0x1p-20;

// Where the rays at the corners of a block begin and end; of bent ones, at those of a lattice,
// between which they are nearly linear.
class Course {
public:
    Course(const PictureRays& rays, const PixelBlock& block)
        : side_(rays.origin.is_bent() || rays.direction.is_bent() ? course_parts : 1) {
        const PictureRays::Vectors from = places_at(rays, rays.range.begin);
        const PictureRays::Vectors to = places_at(rays, rays.range.end);
        const PictureRays::Vectors anchor = places_at(rays, rays.anchor);
        const glm::dvec2 part = glm::dvec2(block.size) / static_cast<double>(side_);
        const std::size_t count = places_a_row() * places_a_row();
        begin_.reserve(count);
        end_.reserve(count);
        for (int row = 0; row <= side_; ++row) {
            for (int col = 0; col <= side_; ++col) {
                const glm::dvec2 pixel = glm::dvec2(block.first) + part * glm::dvec2(col, row);
                const glm::dvec3 begin = begin_.emplace_back(from.at(pixel));
                const glm::dvec3 end = end_.emplace_back(to.at(pixel));
                box_.add(begin);
                box_.add(end);
                const glm::dvec3 base = anchor.at(pixel);
                reach_ = glm::max(reach_, glm::max(glm::abs(begin - base), glm::abs(end - base)));
            }
        }
        const double height = std::max(std::abs(box_.low.z), std::abs(box_.high.z));
        const glm::dvec3 margin = ray_rounding * (1.0 + reach_ + glm::dvec3(0.0, 0.0, height)) +
                                  glm::max(from.bulge(part), to.bulge(part));
        box_ = {box_.low - margin, box_.high + margin};
    }

    // Around all rays, also rounded ones.
    [[nodiscard]] const Box& box() const { return box_; }

    // Whether rays pass lines of an axis from high to low; `turns`: some, others not.
    [[nodiscard]] bool comes_from_high(int axis, double line, bool& turns) const {
        if (line <= box_.low[axis] || line >= box_.high[axis]) {
            return false; // they pass none
        }
        const double on = past(axis, line, 1.0);
        const double back = past(axis, line, -1.0);
        turns = turns || std::min(on, back) > place_rounding * reach_[axis];
        return back > on;
    }

private:
    // How far the rays that begin before a line end behind it; in the direction of `sign`. The
    // corners' polygons are cut there.
    [[nodiscard]] double past(int axis, double line, double sign) const {
        double farthest = -far_beyond;
        for (int row = 0; row < side_; ++row) {
            for (int col = 0; col < side_; ++col) {
                farthest = std::max(farthest, past_of(corners_of({col, row}), axis, line, sign));
            }
        }
        return farthest;
    }

    [[nodiscard]] std::size_t places_a_row() const { return static_cast<std::size_t>(side_) + 1; }

    // In order around the part.
    [[nodiscard]] std::array<std::size_t, 4> corners_of(glm::ivec2 part) const {
        const std::size_t first =
            static_cast<std::size_t>(part.y) * places_a_row() + static_cast<std::size_t>(part.x);
        const std::size_t below = first + places_a_row();
        return {first, first + 1, below + 1, below};
    }

    [[nodiscard]] double past_of(const std::array<std::size_t, 4>& corners, int axis, double line,
                                 double sign) const {
        double farthest = -far_beyond;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const std::size_t here = corners[i];
            const std::size_t next = corners[(i + 1) % corners.size()];
            const double from = sign * (begin_[here][axis] - line);
            const double next_from = sign * (begin_[next][axis] - line);
            const double to = sign * (end_[here][axis] - line);
            if (from <= 0.0) {
                farthest = std::max(farthest, to);
            }
            if ((from <= 0.0) != (next_from <= 0.0)) {
                const double next_to = sign * (end_[next][axis] - line);
                farthest = std::max(farthest, glm::mix(to, next_to, from / (from - next_from)));
            }
        }
        return farthest;
    }

    int side_; // of the lattice, parts
    std::vector<glm::dvec3> begin_;
    std::vector<glm::dvec3> end_;
    glm::dvec3 reach_{0.0}; // from the anchor
    Box box_;
};

bool are_apart(const PixelBlock& a, const PixelBlock& b) {
    return glm::any(glm::greaterThanEqual(a.first, b.first + b.size)) ||
           glm::any(glm::greaterThanEqual(b.first, a.first + a.size));
}

class NodeWalk {
public:
    NodeWalk(const TileNodes& nodes, const Course& course, const PixelBlock& block)
        : nodes_(nodes), course_(course), block_(block) {}

    TilesAlong run(Interval turn) {
        if (nodes_.empty()) {
            return {};
        }
        if (turn.begin < turn.end) {
            visit_turns(turn);
        } else {
            visit(nodes_.front());
        }
        return std::move(along_);
    }

private:
    // Each turn of a globe is a copy of its nodes. Rays pass no more than a few of them.
    void visit_turns(Interval turn) {
        constexpr double max_turns = 3.0;
        const double around = turn.end - turn.begin;
        const auto number = [&](double col) { return std::floor((col - turn.begin) / around); };
        const double first = number(course_.box().low.x);
        const auto count = static_cast<int>(
            std::clamp(number(course_.box().high.x) - first + 1.0, 1.0, max_turns));
        const double seam = turn.begin + (first + 1.0) * around;
        const bool is_east = count > 1 && course_.comes_from_high(0, seam, along_.turns.x);
        for (int i = 0; i < count; ++i) {
            from_ = around * (first + (is_east ? count - 1 - i : i));
            visit(nodes_.front());
        }
    }

    // A ray passes the side where it begins, perhaps one beside it, and the opposite one last.
    void visit(const TileNode& node) {
        if (!may_hit(node)) {
            return;
        }
        if (node.tile >= 0) {
            along_.tiles.push_back({static_cast<std::size_t>(node.tile), -from_});
            return;
        }
        const auto has = [&](std::size_t a, std::size_t b) {
            return node.parts[a] >= 0 || node.parts[b] >= 0;
        };
        const bool is_east = has(0, 2) && has(1, 3) &&
                             course_.comes_from_high(0, from_ + node.lines.x, along_.turns.x);
        const bool is_south =
            has(0, 1) && has(2, 3) && course_.comes_from_high(1, node.lines.y, along_.turns.y);
        const unsigned first = (is_east ? 1U : 0U) + (is_south ? 2U : 0U);
        for (unsigned order = 0; order < node.parts.size(); ++order) {
            if (const int part = node.parts[first ^ order]; part >= 0) {
                visit(nodes_[static_cast<std::size_t>(part)]);
            }
        }
    }

    // Rays pass above a tile; below one they may be, too, to hit a wall behind it.
    [[nodiscard]] bool may_hit(const TileNode& node) const {
        const Box& rays = course_.box();
        return !are_apart(node.seen, block_) && from_ + node.box.low.x <= rays.high.x &&
               rays.low.x <= from_ + node.box.high.x && node.box.low.y <= rays.high.y &&
               rays.low.y <= node.box.high.y && rays.low.z <= node.box.high.z;
    }

    const TileNodes& nodes_;
    const Course& course_;
    PixelBlock block_;
    double from_ = 0.0; // columns of the turns before
    TilesAlong along_;
};

// Changes of a place for a pixel to the right and a pixel down, along an axis.
glm::dvec2 change(const PictureRays::Vectors& vectors, int axis) {
    return {vectors.right[axis], vectors.down[axis]};
}

// Sets them; the place at the middle pixel remains. Returns by how much a corner is moved.
double set_change(PictureRays::Vectors& vectors, int axis, glm::dvec2 to, const PixelBlock& block) {
    const glm::dvec2 half = 0.5 * glm::dvec2(block.size);
    const glm::dvec2 by = to - change(vectors, axis);
    vectors.right[axis] = to.x;
    vectors.down[axis] = to.y;
    vectors.first[axis] -= glm::dot(by, glm::dvec2(block.first) + half);
    return glm::dot(glm::abs(by), half);
}

class Turns {
public:
    Turns(const PictureRays& rays, const PixelBlock& block, glm::bvec2 axes,
          const std::function<glm::dvec2(double t)>& tolerance)
        : rays_(rays), block_(block), axes_(axes), tolerance_(tolerance) {}

    std::vector<PictureRays> run() {
        constexpr int max_halvings = 8;
        add(rays_.range, max_halvings);
        return std::move(parts_);
    }

private:
    // Along an axis, places at both ends change with the pixel in the same direction.
    void add(Interval depths, int halvings) {
        PictureRays::Vectors from = places_at(rays_, depths.begin);
        PictureRays::Vectors to = places_at(rays_, depths.end);
        bool is_near = true;
        for (int axis = 0; axis < 2; ++axis) {
            const glm::dvec2 before = change(from, axis);
            const glm::dvec2 after = change(to, axis);
            const double length = glm::length(before + after);
            if (!axes_[axis] || !(length > 0.0)) {
                continue;
            }
            const glm::dvec2 way = (before + after) / length;
            is_near = set_change(from, axis, glm::dot(before, way) * way, block_) <=
                          tolerance_(depths.begin)[axis] &&
                      is_near;
            is_near = set_change(to, axis, glm::dot(after, way) * way, block_) <=
                          tolerance_(depths.end)[axis] &&
                      is_near;
        }
        const double middle = 0.5 * (depths.begin + depths.end);
        if (is_near || halvings == 0) {
            parts_.push_back(straight_between(from, to, depths, rays_));
        } else {
            add({depths.begin, middle}, halvings - 1);
            add({middle, depths.end}, halvings - 1);
        }
    }

    const PictureRays& rays_;
    const PixelBlock& block_;
    glm::bvec2 axes_;
    const std::function<glm::dvec2(double t)>& tolerance_;
    std::vector<PictureRays> parts_;
};

} // namespace

TilesAlong tiles_along(const TileNodes& nodes, const PictureRays& rays, const PixelBlock& block,
                       Interval turn) {
    const Course course(rays, block);
    return NodeWalk(nodes, course, block).run(turn);
}

std::vector<PictureRays> without_turns(const PictureRays& rays, const PixelBlock& block,
                                       glm::bvec2 axes,
                                       const std::function<glm::dvec2(double t)>& tolerance) {
    return Turns(rays, block, axes, tolerance).run();
}

} // namespace reljef::cast
