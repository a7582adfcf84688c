#include "engine/terrain/mesh/skirt.h"

#include <algorithm>
#include <array>
#include <utility>

#include <glm/geometric.hpp>

namespace reljef::terrain {
namespace {

// From left to right, seen from outside.
struct BorderEdge {
    Steps left{0};
    Steps right{0};
    VertexMove left_move;
    VertexMove right_move;
};

class SkirtWriter {
public:
    SkirtWriter(const Tile& tile, const Heightfield& heightfield, const Placement& placement,
                const Skirt& skirt)
        : first_(steps_of({tile.col, tile.row})),
          last_(steps_of({tile.col + tile.cols, tile.row + tile.rows})), heightfield_(heightfield),
          placement_(placement), skirt_(skirt) {}

    /// Adds an edge of a triangle that is counter-clockwise from above, if it is on a side with
    /// walls.
    void add(const BorderEdge& edge) {
        if (!is_walled(edge.left, edge.right)) {
            return;
        }
        constexpr std::size_t max_vertices = 65532; // four more must fit
        if (walls_.empty() || walls_.back().vertices.size() > max_vertices) {
            walls_.emplace_back();
        }
        const auto first = static_cast<std::uint16_t>(walls_.back().vertices.size());
        add_vertex(edge.left, edge.left_move);
        add_vertex(edge.right, edge.right_move);
        // Upper left, lower left, upper right, lower right.
        for (const int corner : {1, 3, 2, 1, 2, 0}) {
            walls_.back().indices.push_back(static_cast<std::uint16_t>(first + corner));
        }
    }

    std::vector<Triangulation> take() { return std::move(walls_); }

private:
    [[nodiscard]] bool is_walled(Steps a, Steps b) const {
        return (skirt_.west && a.x == first_.x && b.x == first_.x) ||
               (skirt_.east && a.x == last_.x && b.x == last_.x) ||
               (skirt_.north && a.y == first_.y && b.y == first_.y) ||
               (skirt_.south && a.y == last_.y && b.y == last_.y);
    }

    // From above, an error of the view is higher than it is wide.
    [[nodiscard]] double depth_at(glm::dvec3 place) const {
        if (skirt_.slope == 0.0) {
            return skirt_.depth;
        }
        constexpr double min_sine = 1.0 / 8.0;
        const glm::dvec3 way = place - skirt_.eye;
        const double distance = glm::length(way);
        const double across = glm::length(glm::cross(way, placement_.up(place)));
        const double sine = distance > 0.0 ? std::max(across / distance, min_sine) : 1.0;
        return skirt_.depth + skirt_.slope * distance / sine;
    }

    void add_vertex(Steps place, const VertexMove& move) {
        const glm::dvec2 sample = samples_of(place);
        const double height = bilinear_height(heightfield_.heights.view(), sample);
        const glm::dvec3 upper = placement_.world_from_sample({sample, height});
        const double down = depth_at(upper) / placement_.exaggeration(); // true metres
        const glm::dvec3 fall = placement_.world_from_sample({sample, height - down}) - upper;
        Triangulation& walls = walls_.back();
        walls.vertices.push_back(place);
        walls.moves.push_back(move);
        walls.vertices.push_back(place);
        walls.moves.push_back({move.offset + fall, move.height - down});
    }

    Steps first_;
    Steps last_;
    const Heightfield& heightfield_;
    const Placement& placement_;
    const Skirt& skirt_;
    std::vector<Triangulation> walls_;
};

} // namespace

std::vector<Triangulation> skirt_below(std::span<const Triangulation> parts, const Tile& tile,
                                       const Heightfield& heightfield, const Placement& placement,
                                       const Skirt& skirt) {
    SkirtWriter walls(tile, heightfield, placement, skirt);
    for (const Triangulation& part : parts) {
        const auto end_of = [&](std::size_t index) {
            const std::size_t vertex = part.indices[index];
            return std::pair{part.vertices[vertex],
                             part.moves.empty() ? VertexMove{} : part.moves[vertex]};
        };
        for (std::size_t i = 0; i < part.indices.size(); i += 3) {
            const std::array corners{end_of(i), end_of(i + 1), end_of(i + 2)};
            for (std::size_t k = 0; k < 3; ++k) {
                const auto& [left, left_move] = corners[k];
                const auto& [right, right_move] = corners[(k + 1) % 3];
                walls.add({left, right, left_move, right_move});
            }
        }
    }
    return walls.take();
}

std::vector<Triangulation> skirt_below_samples(const Tile& tile, const Heightfield& heightfield,
                                               const Placement& placement, const Skirt& skirt) {
    SkirtWriter walls(tile, heightfield, placement, skirt);
    const glm::ivec2 first(tile.col, tile.row);
    const glm::ivec2 last = first + glm::ivec2(tile.cols, tile.rows);
    for (int col = first.x; col < last.x; ++col) {
        walls.add({steps_of({col, last.y}), steps_of({col + 1, last.y}), {}, {}});
        walls.add({steps_of({col + 1, first.y}), steps_of({col, first.y}), {}, {}});
    }
    for (int row = first.y; row < last.y; ++row) {
        walls.add({steps_of({first.x, row}), steps_of({first.x, row + 1}), {}, {}});
        walls.add({steps_of({last.x, row + 1}), steps_of({last.x, row}), {}, {}});
    }
    return walls.take();
}

} // namespace reljef::terrain
