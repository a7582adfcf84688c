#include "engine/terrain/mesh/bisection_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

// Geomorphing. M(t) is the mesh for the error bound t, E is max_error and f is morph_from. The
// drawn mesh is the mean of M(t) over all t from f E to E. Its error is at most E, as that of each
// M(t), and it changes continuously with the view. Each M(t) has a subset of the splits of M(f E),
// so the mean is linear over the triangles of M(f E). A vertex v splits the edge from a to b. It is
// a vertex of M(t), as are a and b, for the share w of these t that lies below its own error. For
// the others it is the middle of a and b. So
//   mean(v) = w v + (mean(a) - w a + mean(b) - w b) / 2, or, with the moves d = mean - position,
//   d(v) = (d(a) + d(b)) / 2 - (1 - w) (v - (a + b) / 2).

namespace reljef::terrain {
namespace {

// A right triangle, counter-clockwise from above; its longest edge runs from left to right.
struct BisectionTriangle {
    Steps apex;
    Steps left;
    Steps right;
};

// The split of a triangle: in the middle of a square of `size` steps, or of one of its sides.
struct SplitKind {
    int size = 0;
    bool on_side = true;
};

SplitKind kind_below(SplitKind kind) {
    return kind.on_side ? SplitKind{kind.size / 2, false} : SplitKind{kind.size, true};
}

constexpr std::uint16_t no_vertex = std::numeric_limits<std::uint16_t>::max();
constexpr std::size_t max_vertices = no_vertex - 3; // a triangle more must fit

std::uint64_t key_of(Steps from_tile) {
    return (static_cast<std::uint64_t>(from_tile.x) << 32U) |
           static_cast<std::uint64_t>(from_tile.y);
}

class TriangulationWriter {
public:
    explicit TriangulationWriter(const TileCells& tile)
        : first_(steps_of(tile.first)), at_samples_(tile.count.x + 1, tile.count.y + 1, no_vertex) {
    }

    void add(const BisectionTriangle& triangle) {
        if (parts_.empty() || parts_.back().vertices.size() > max_vertices) {
            begin_part();
        }
        for (const Steps corner : {triangle.apex, triangle.left, triangle.right}) {
            const std::uint16_t number = number_of(corner);
            parts_.back().indices.push_back(number);
        }
    }

    std::vector<Triangulation> take() { return std::move(parts_); }

private:
    void begin_part() {
        std::fill(at_samples_.samples().begin(), at_samples_.samples().end(), no_vertex);
        between_.clear();
        parts_.emplace_back();
    }

    std::uint16_t number_of(Steps place) {
        const Steps from_tile = place - first_;
        const glm::ivec2 sample = sample_before(from_tile);
        if (steps_of(sample) == from_tile) {
            std::uint16_t& number = at_samples_(sample.x, sample.y);
            number = number == no_vertex ? add_vertex(place) : number;
            return number;
        }
        const auto [entry, is_new] = between_.try_emplace(key_of(from_tile), no_vertex);
        if (is_new) {
            entry->second = add_vertex(place);
        }
        return entry->second;
    }

    std::uint16_t add_vertex(Steps place) {
        parts_.back().vertices.push_back(place);
        return static_cast<std::uint16_t>(parts_.back().vertices.size() - 1);
    }

    Steps first_;
    Grid<std::uint16_t> at_samples_;
    std::unordered_map<std::uint64_t, std::uint16_t> between_;
    std::vector<Triangulation> parts_;
};

enum class Visibility { none, part, whole };

Visibility visibility_of(const ErrorView& view, const Split& split) {
    double min_distance = std::numeric_limits<double>::infinity();
    for (const glm::dvec4& side : view.sides) {
        min_distance = std::min(min_distance, glm::dot(glm::dvec3(side), split.center) + side.w);
    }
    return min_distance < -split.radius  ? Visibility::none
           : min_distance > split.radius ? Visibility::whole
                                         : Visibility::part;
}

// Smallest depth of a split's sphere.
double depth_of(const ErrorView& view, const Split& split) {
    const double reach = view.stretch * split.radius;
    return glm::dot(glm::dvec3(view.depth), split.center) + view.depth.w - reach;
}

// Pixels by which floats round the corners of a visible split's triangles more than what is seen.
double rounding_of(const ErrorView& view, const Split& split, double depth) {
    return view.rounding_between * view.stretch * split.radius / std::max(depth, view.near);
}

// Bounds the screen-space error of a visible split by where the picture may show it, pixels: the
// only bound for what reaches the eye. For a place p that is shown and a displacement d, the error
// is the focal length times |p x d| / (depths of both places), and |p| is at most
// distance_per_depth times its depth. Preconditions: perspective; an error > 0.
double error_in_picture(const ErrorView& view, const Split& split) {
    const double depth = std::max(depth_of(view, split), view.near) - view.stretch * split.error;
    return depth > 0.0 ? view.scale * split.error * view.distance_per_depth / depth
                       : std::numeric_limits<double>::infinity();
}

// Whether the screen-space error of a visible split may exceed the bound. Precondition: its error
// is finite.
bool exceeds_bound(const ErrorView& view, const Split& split) {
    const double scaled = view.scale * split.error;
    if (!view.perspective) {
        return scaled > view.max_error;
    }
    const double depth = depth_of(view, split);
    if (rounding_of(view, split, depth) > view.max_rounding) {
        return true;
    }
    // scaled * (lateral + reach) > max_error * depth², without a root.
    const double room = view.max_error * depth * depth - scaled * (view.stretch * split.radius);
    const glm::dvec3 lateral = view.lateral_axes * split.center + view.lateral_origin;
    const bool may_exceed =
        depth <= 0.0 || room < 0.0 || scaled * scaled * glm::dot(lateral, lateral) > room * room;
    return split.error > 0.0 && may_exceed && !(error_in_picture(view, split) <= view.max_error);
}

// Screen-space error over max_error. Precondition: visible, with a finite error.
double relative_error(const ErrorView& view, const Split& split) {
    if (!view.perspective) {
        return view.scale * split.error / view.max_error;
    }
    const double depth = depth_of(view, split);
    const double lateral = glm::length(view.lateral_axes * split.center + view.lateral_origin) +
                           view.stretch * split.radius;
    if (split.error == 0.0) {
        return 0.0;
    }
    const double in_picture = error_in_picture(view, split) / view.max_error;
    return depth <= 0.0 ? in_picture
                        : std::min(in_picture, view.scale * split.error * lateral /
                                                   (view.max_error * depth * depth));
}

// Bounds the screen-space error in the visible part of a split, pixels. Precondition: a finite
// error.
double visible_error(const ErrorView& view, const Split& split) {
    if (!view.perspective) {
        return view.scale * split.error;
    }
    const double rounding = rounding_of(view, split, depth_of(view, split));
    const double depth = std::max(depth_of(view, split), view.near);
    const double depth_of_true_place = depth - view.stretch * split.error;
    const double lateral = glm::length(view.lateral_axes * split.center + view.lateral_origin) +
                           view.stretch * split.radius;
    if (split.error == 0.0) {
        return rounding;
    }
    return depth_of_true_place > 0.0 ? rounding + std::min(error_in_picture(view, split),
                                                           view.scale * split.error * lateral /
                                                               (depth * depth_of_true_place))
                                     : std::numeric_limits<double>::infinity();
}

// The vertices of a tile that are not at their own positions.
class MorphedVertices {
public:
    MorphedVertices(const Bisection& bisection, Steps first)
        : bisection_(bisection), first_(first) {}

    // `share`: of the move from the edge to the own position, in [0, 1].
    void add(Steps place, Steps from, Steps to, double share) {
        const VertexMove a = move_of(from);
        const VertexMove b = move_of(to);
        const auto between = [](const auto& p, const auto& q) { return 0.5 * (p + q); };
        VertexMove move{between(a.offset, b.offset), between(a.height, b.height)};
        if (share < 1.0) {
            move.offset -= (1.0 - share) * (bisection_.world(place) -
                                            between(bisection_.world(from), bisection_.world(to)));
            move.height -=
                (1.0 - share) * (bisection_.height(place) -
                                 between(bisection_.height(from), bisection_.height(to)));
        }
        if (move != VertexMove{}) {
            moves_.emplace(key_of(place - first_), move);
        }
    }

    [[nodiscard]] VertexMove move_of(Steps place) const {
        const auto found = moves_.find(key_of(place - first_));
        return found == moves_.end() ? VertexMove{} : found->second;
    }

private:
    const Bisection& bisection_;
    Steps first_; // of the tile
    std::unordered_map<std::uint64_t, VertexMove> moves_;
};

class TileBisector {
public:
    TileBisector(const Bisection& bisection, const TileCells& tile, const ErrorView& view,
                 TriangleBudget* budget)
        : bisection_(bisection), budget_(budget), morphed_(view), view_(view),
          morphs_(view.morph_from < 1.0), morphed_vertices_(bisection, steps_of(tile.first)),
          first_(tile.first), is_whole_(tile.count.x == tile_cells && tile.count.y == tile_cells),
          at_samples_(tile.count.x + 1, tile.count.y + 1, Choice{false, false, false}),
          error_(view.max_error), writer_(tile) {
        view_.max_error *= view.morph_from;
    }

    TileTriangles bisect(const TileCells& tile) {
        constexpr int side = steps_per_sample * tile_cells;
        const Steps first = steps_of(tile.first);
        const Steps middle = first + std::int64_t{side / 2};
        const std::array corners{first, first + Steps(0, side), first + std::int64_t{side},
                                 first + Steps(side, 0)};
        for (std::size_t i = 0; i < 4; ++i) {
            add({middle, corners[i], corners[(i + 1) % 4]}, {side, true});
        }
        report_count();
        return {take(), error_};
    }

private:
    // `is_seen`: the parent's sphere is completely visible, and so are all descendants'.
    void add(const BisectionTriangle& triangle, SplitKind kind, bool is_seen = false) {
        const Reach reach = is_whole_ ? Reach::inside : reach_of(triangle);
        if (reach == Reach::outside || has_ended_) {
            return;
        }
        const Steps middle = (triangle.left + triangle.right) / std::int64_t{2};
        const Choice choice =
            reach == Reach::across ? Choice{true, is_seen} : choice_at(middle, kind, is_seen);
        if (choice.splits) {
            if (is_whole_) {
                prefetch_below(triangle, middle, kind);
            }
            if (morphs_) {
                morphed_vertices_.add(middle, triangle.left, triangle.right, choice.share);
            }
            add({middle, triangle.apex, triangle.left}, kind_below(kind), choice.is_seen);
            add({middle, triangle.right, triangle.apex}, kind_below(kind), choice.is_seen);
        } else {
            writer_.add(triangle);
            if (++unreported_ == triangles_a_report) {
                report_count();
            }
        }
    }

    void report_count() {
        if (budget_ != nullptr) {
            budget_->add(unreported_);
            has_ended_ = budget_->is_exceeded();
        }
        unreported_ = 0;
    }

    std::vector<Triangulation> take() {
        std::vector<Triangulation> parts = writer_.take();
        for (Triangulation& part : parts) {
            for (std::size_t i = 0; morphs_ && i < part.vertices.size(); ++i) {
                part.moves.push_back(morphed_vertices_.move_of(part.vertices[i]));
            }
        }
        return parts;
    }

    enum class Reach { inside, across, outside }; // of the heightfield
    struct Choice {
        bool splits = false;
        bool is_seen = false; // the split's sphere is completely visible
        bool is_made = true;
        double share = 1.0; // of the vertex's move to its own position
    };

    // The splits of children and grandchildren lie far apart in memory.
    void prefetch_below(const BisectionTriangle& triangle, Steps middle, SplitKind kind) const {
        const SplitKind next = kind_below(kind);
        const auto prefetch = [&](Steps a, Steps b, SplitKind at) {
            bisection_.prefetch((a + b) / std::int64_t{2}, at.size, at.on_side);
        };
        const SplitKind last = kind_below(next);
        for (const Steps end : {triangle.left, triangle.right}) {
            prefetch(triangle.apex, end, next);
            prefetch(middle, triangle.apex, last);
            prefetch(middle, end, last);
        }
    }

    [[nodiscard]] Reach reach_of(const BisectionTriangle& triangle) const {
        const Steps high = glm::max(triangle.apex, glm::max(triangle.left, triangle.right));
        const Steps end = bisection_.end();
        if (high.x <= end.x && high.y <= end.y) {
            return Reach::inside;
        }
        const Steps low = glm::min(triangle.apex, glm::min(triangle.left, triangle.right));
        return low.x < end.x && low.y < end.y ? Reach::across : Reach::outside;
    }

    [[nodiscard]] Choice choice_at(Steps middle, SplitKind kind, bool is_seen) {
        if (kind.size <= steps_per_sample) {
            const Split split = bisection_.split(middle, kind.size, kind.on_side);
            return kind.size >= std::max(bisection_.min_size(), view_.min_size)
                       ? choice_of(split, is_seen)
                       : choice_below_min_size(split, is_seen);
        }
        const glm::ivec2 sample = sample_before(middle) - first_;
        // The triangles on both sides need it.
        Choice& choice = at_samples_(sample.x, sample.y);
        if (!choice.is_made) {
            const Split split = bisection_.split(middle, kind.size, kind.on_side);
            choice = kind.size >= view_.min_size ? choice_of(split, is_seen)
                                                 : choice_below_min_size(split, is_seen);
        }
        return choice;
    }

    [[nodiscard]] Choice choice_of(const Split& split, bool is_seen) const {
        if (std::isinf(split.error)) {
            return {true, is_seen};
        }
        if (!exceeds_bound(view_, split)) {
            return {false, is_seen};
        }
        const Visibility seen = is_seen ? Visibility::whole : visibility_of(view_, split);
        return {seen != Visibility::none, seen == Visibility::whole, true, share_of(split)};
    }

    Choice choice_below_min_size(const Split& split, bool is_seen) {
        if (std::isinf(split.error)) {
            return {true, is_seen};
        }
        if (is_seen || visibility_of(view_, split) != Visibility::none) {
            error_ = std::max(error_, visible_error(view_, split));
        }
        return {false, is_seen};
    }

    [[nodiscard]] double share_of(const Split& split) const {
        const double from = morphed_.morph_from;
        return morphs_
                   ? std::clamp((relative_error(morphed_, split) - from) / (1.0 - from), 0.0, 1.0)
                   : 1.0;
    }

    static constexpr std::size_t triangles_a_report = 1024;

    const Bisection& bisection_;
    TriangleBudget* budget_; // null: none
    std::size_t unreported_ = 0;
    bool has_ended_ = false;
    const ErrorView& morphed_;
    ErrorView view_; // its max_error is the error where morphing begins
    bool morphs_;
    MorphedVertices morphed_vertices_;
    glm::ivec2 first_;        // sample of the tile
    bool is_whole_;           // the tile has tile_cells cells on each side
    Grid<Choice> at_samples_; // by sample of the tile
    double error_;            // pixels
    TriangulationWriter writer_;
};

} // namespace

bool exceeds(const ErrorView& view, const Split& split) {
    return std::isinf(split.error) ||
           (visibility_of(view, split) != Visibility::none && exceeds_bound(view, split));
}

double triangle_error_in(const ErrorView& view, const Bisection& bisection,
                         const std::array<Steps, 3>& corners) {
    const auto& [apex, left, right] = corners;
    const Steps edge = glm::abs(right - left);
    const bool on_side = edge.x == 0 || edge.y == 0;
    const Split split = bisection.split((left + right) / std::int64_t{2},
                                        static_cast<int>(std::max(edge.x, edge.y)), on_side);
    if (view.morph_from < 1.0 || std::isinf(split.error)) {
        return view.max_error;
    }
    return visibility_of(view, split) == Visibility::none ? 0.0 : visible_error(view, split);
}

TileTriangles triangulate(const Bisection& bisection, const TileCells& tile, const ErrorView& view,
                          TriangleBudget* budget) {
    return TileBisector(bisection, tile, view, budget).bisect(tile);
}

} // namespace reljef::terrain
