#include "engine/terrain/mesh/bisection_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

// Vertices that rise. M(t) be the triangles for the error t, and what is drawn their mean over all
// t from f E to E, for the most error E: no point of it is farther from its place than E, as none
// of those is, and it follows the view without a step. The splits of each M(t) are among those of
// M(f E), so the mean is linear over the triangles of that one. A vertex v that splits the edge
// from a to b is a vertex of M(t) for the share w of these t that lies below its own error, and so
// are then a and b; else it is in their middle. So
//   mean(v) = w v + (mean(a) - w a + mean(b) - w b) / 2, or, with the moves d = mean - own place,
//   d(v) = (d(a) + d(b)) / 2 - (1 - w) (v - (a + b) / 2).

namespace reljef::terrain {
namespace {

// A right triangle, counter-clockwise from above; its longest edge runs from left to right.
struct BisectionTriangle {
    glm::ivec2 apex;
    glm::ivec2 left;
    glm::ivec2 right;
};

// Which split halves a triangle: in the middle of a square of `size` steps, or of one of its sides.
struct SplitKind {
    int size = 0;
    bool on_side = true;
};

SplitKind kind_below(SplitKind kind) {
    return kind.on_side ? SplitKind{kind.size / 2, false} : SplitKind{kind.size, true};
}

constexpr std::uint16_t no_vertex = std::numeric_limits<std::uint16_t>::max();
// Three vertices more must fit.
constexpr std::size_t max_vertices = no_vertex - 3;

std::uint64_t key_of(glm::ivec2 place) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(place.x)) << 32U) |
           static_cast<std::uint32_t>(place.y);
}

// Numbers the vertices that triangles name.
class TriangulationWriter {
public:
    explicit TriangulationWriter(const Tile& tile)
        : first_(steps_per_sample * glm::ivec2(tile.col, tile.row)),
          at_samples_(tile.cols + 1, tile.rows + 1, no_vertex) {}

    void add(const BisectionTriangle& triangle) {
        if (parts_.empty() || parts_.back().vertices.size() > max_vertices) {
            begin_part();
        }
        for (const glm::ivec2 corner : {triangle.apex, triangle.left, triangle.right}) {
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

    std::uint16_t number_of(glm::ivec2 place) {
        const glm::ivec2 sample = (place - first_) / steps_per_sample;
        if (first_ + steps_per_sample * sample == place) {
            std::uint16_t& number = at_samples_(sample.x, sample.y);
            number = number == no_vertex ? add_vertex(place) : number;
            return number;
        }
        const auto [entry, is_new] = between_.try_emplace(key_of(place), no_vertex);
        if (is_new) {
            entry->second = add_vertex(place);
        }
        return entry->second;
    }

    std::uint16_t add_vertex(glm::ivec2 place) {
        parts_.back().vertices.push_back(place);
        return static_cast<std::uint16_t>(parts_.back().vertices.size() - 1);
    }

    glm::ivec2 first_;
    Grid<std::uint16_t> at_samples_;
    std::unordered_map<std::uint64_t, std::uint16_t> between_;
    std::vector<Triangulation> parts_;
};

enum class Sight { none, part, whole };

Sight sight_of(const ErrorView& view, const Split& split) {
    double least = std::numeric_limits<double>::infinity();
    for (const glm::dvec4& side : view.sides) {
        least = std::min(least, glm::dot(glm::dvec3(side), split.center) + side.w);
    }
    return least < -split.radius ? Sight::none : least > split.radius ? Sight::whole : Sight::part;
}

// Whether more than the most error may be seen of a split that is in sight. Precondition: its error
// is finite.
bool shows_more(const ErrorView& view, const Split& split) {
    if (!view.perspective) {
        return view.scale * split.error > view.max_error;
    }
    const double reach = view.stretch * split.radius;
    const double depth = glm::dot(glm::dvec3(view.depth), split.center) + view.depth.w - reach;
    const double shown = view.scale * split.error;
    // shown * (lateral + reach) > max_error * depth², without a root.
    const double room = view.max_error * depth * depth - shown * reach;
    const glm::dvec3 lateral = view.lateral_axes * split.center + view.lateral_origin;
    return split.error > 0.0 &&
           (depth <= 0.0 || room < 0.0 || shown * shown * glm::dot(lateral, lateral) > room * room);
}

// The error that is seen over the most. Precondition: it is seen, and finite.
double shown_share(const ErrorView& view, const Split& split) {
    if (!view.perspective) {
        return view.scale * split.error / view.max_error;
    }
    const double reach = view.stretch * split.radius;
    const double depth = glm::dot(glm::dvec3(view.depth), split.center) + view.depth.w - reach;
    const double lateral =
        glm::length(view.lateral_axes * split.center + view.lateral_origin) + reach;
    return depth <= 0.0 ? std::numeric_limits<double>::infinity()
                        : view.scale * split.error * lateral / (view.max_error * depth * depth);
}

// The vertices of a tile that are not at their places.
class RisingVertices {
public:
    explicit RisingVertices(const Bisection& bisection) : bisection_(bisection) {}

    // `share`: of its rise, in [0, 1].
    void add(glm::ivec2 place, glm::ivec2 from, glm::ivec2 to, double share) {
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
            moves_.emplace(key_of(place), move);
        }
    }

    [[nodiscard]] VertexMove move_of(glm::ivec2 place) const {
        const auto found = moves_.find(key_of(place));
        return found == moves_.end() ? VertexMove{} : found->second;
    }

private:
    const Bisection& bisection_;
    std::unordered_map<std::uint64_t, VertexMove> moves_;
};

ErrorView view_of_first_rise(ErrorView view) {
    view.max_error *= view.morph_from;
    return view;
}

class TileBisector {
public:
    // `kept`: the splits that are made anyway; then none below the samples are.
    TileBisector(const Bisection& bisection, const Tile& tile, const ErrorView& view,
                 const Grid<std::uint8_t>* kept = nullptr)
        : bisection_(bisection), morphed_(view), view_(view_of_first_rise(view)),
          morphs_(view.morph_from < 1.0), kept_(kept), rising_(bisection),
          first_(tile.col, tile.row), is_whole_(tile.cols == tile_cells && tile.rows == tile_cells),
          at_samples_(tile.cols + 1, tile.rows + 1, Choice{false, false, false}), writer_(tile) {}

    std::vector<Triangulation> bisect(const Tile& tile) {
        const glm::ivec2 first = steps_per_sample * glm::ivec2(tile.col, tile.row);
        const int side = steps_per_sample * tile_cells;
        const glm::ivec2 middle = first + side / 2;
        const std::array corners{first, first + glm::ivec2(0, side), first + side,
                                 first + glm::ivec2(side, 0)};
        for (std::size_t i = 0; i < 4; ++i) {
            add({middle, corners[i], corners[(i + 1) % 4]}, {side, true});
        }
        return take();
    }

private:
    // `kind` is that of the split that halves it; `is_seen`: the ball of the split that made it is
    // seen as a whole, and so are those below.
    void add(const BisectionTriangle& triangle, SplitKind kind, bool is_seen = false) {
        const Reach reach = is_whole_ ? Reach::inside : reach_of(triangle);
        if (reach == Reach::outside) {
            return;
        }
        const glm::ivec2 middle = (triangle.left + triangle.right) / 2;
        const Choice choice =
            reach == Reach::across ? Choice{true, is_seen} : choice_at(middle, kind, is_seen);
        if (choice.splits) {
            if (is_whole_) {
                prefetch_below(triangle, middle, kind);
            }
            if (morphs_) {
                rising_.add(middle, triangle.left, triangle.right, choice.risen);
            }
            add({middle, triangle.apex, triangle.left}, kind_below(kind), choice.is_seen);
            add({middle, triangle.right, triangle.apex}, kind_below(kind), choice.is_seen);
        } else {
            writer_.add(triangle);
        }
    }

    std::vector<Triangulation> take() {
        std::vector<Triangulation> parts = writer_.take();
        for (Triangulation& part : parts) {
            for (std::size_t i = 0; morphs_ && i < part.vertices.size(); ++i) {
                part.moves.push_back(rising_.move_of(part.vertices[i]));
            }
        }
        return parts;
    }

    enum class Reach { inside, across, outside }; // of the heightfield
    struct Choice {
        bool splits = false;
        bool is_seen = false; // the split's ball as a whole
        bool is_made = true;
        double risen = 1.0; // share of the vertex's way to its place
    };

    // The splits of the two halves, and of theirs: they lie far apart in memory.
    void prefetch_below(const BisectionTriangle& triangle, glm::ivec2 middle,
                        SplitKind kind) const {
        const SplitKind next = kind_below(kind);
        for (const glm::ivec2 end : {triangle.left, triangle.right}) {
            bisection_.prefetch((triangle.apex + end) / 2, next.size, next.on_side);
            const SplitKind last = kind_below(next);
            bisection_.prefetch((middle + triangle.apex) / 2, last.size, last.on_side);
            bisection_.prefetch((middle + end) / 2, last.size, last.on_side);
        }
    }

    [[nodiscard]] Reach reach_of(const BisectionTriangle& triangle) const {
        const glm::ivec2 high = glm::max(triangle.apex, glm::max(triangle.left, triangle.right));
        const glm::ivec2 end = bisection_.end();
        if (high.x <= end.x && high.y <= end.y) {
            return Reach::inside;
        }
        const glm::ivec2 low = glm::min(triangle.apex, glm::min(triangle.left, triangle.right));
        return low.x < end.x && low.y < end.y ? Reach::across : Reach::outside;
    }

    [[nodiscard]] Choice choice_at(glm::ivec2 middle, SplitKind kind, bool is_seen) {
        constexpr int min_size = 2; // steps: their middle is a step
        if (kind.size < min_size) {
            return {false, is_seen};
        }
        if (kind.size <= steps_per_sample) {
            return kept_ != nullptr
                       ? Choice{false, is_seen}
                       : choice_of(bisection_.split(middle, kind.size, kind.on_side), is_seen);
        }
        // Each is asked for by the triangles on its two sides.
        const glm::ivec2 sample = middle / steps_per_sample - first_;
        if (kept_ != nullptr && (*kept_)(sample.x, sample.y) != 0) {
            return {true, is_seen};
        }
        Choice& choice = at_samples_(sample.x, sample.y);
        if (!choice.is_made) {
            choice = choice_of(bisection_.split(middle, kind.size, kind.on_side), is_seen);
        }
        return choice;
    }

    [[nodiscard]] Choice choice_of(const Split& split, bool is_seen) const {
        if (std::isinf(split.error)) {
            return {true, is_seen};
        }
        if (!shows_more(view_, split)) {
            return {false, is_seen};
        }
        const Sight sight = is_seen ? Sight::whole : sight_of(view_, split);
        return {sight != Sight::none, sight == Sight::whole, true, risen_by(split)};
    }

    [[nodiscard]] double risen_by(const Split& split) const {
        const double from = morphed_.morph_from;
        return morphs_ ? std::clamp((shown_share(morphed_, split) - from) / (1.0 - from), 0.0, 1.0)
                       : 1.0;
    }

    const Bisection& bisection_;
    const ErrorView& morphed_;
    ErrorView view_; // of the error where vertices begin to rise
    bool morphs_;
    const Grid<std::uint8_t>* kept_;
    RisingVertices rising_;
    glm::ivec2 first_;        // sample of the tile
    bool is_whole_;           // no triangle of it ends beyond the heightfield
    Grid<Choice> at_samples_; // of the tile, where made
    TriangulationWriter writer_;
};

} // namespace

bool exceeds(const ErrorView& view, const Split& split) {
    return std::isinf(split.error) ||
           (sight_of(view, split) != Sight::none && shows_more(view, split));
}

std::vector<Triangulation> triangulate(const Bisection& bisection, const Tile& tile,
                                       const ErrorView& view) {
    return TileBisector(bisection, tile, view).bisect(tile);
}

Triangulation triangulate_samples(const Bisection& bisection, const Tile& tile,
                                  const ErrorView& view, const Grid<std::uint8_t>& kept) {
    return TileBisector(bisection, tile, view, &kept).bisect(tile).front();
}

} // namespace reljef::terrain
