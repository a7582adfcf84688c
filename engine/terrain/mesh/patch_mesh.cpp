#include "engine/terrain/mesh/patch_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace reljef::terrain {
namespace {

constexpr int patch_samples = patch_cells + 1;

int level_at(double distance, double patch_size, int levels) {
    int level = 0;
    for (int i = 1; i < std::min(levels, max_patch_levels); ++i) {
        const int patches = i + 1 + i / 2;
        level = distance >= patch_size * patches ? i : level;
    }
    return level;
}

// One patch of a tile; places count samples from the tile's first.
class Patch {
public:
    Patch(const Grid<std::uint8_t>& levels, glm::ivec2 patch, const TileCells& tile)
        : first_(patch_cells * patch - tile.first),
          cells_(glm::min(tile.count - first_, glm::ivec2(patch_cells))),
          step_(1 << levels(patch.x, patch.y)) {
        constexpr std::array<glm::ivec2, 4> sides{glm::ivec2(0, -1), glm::ivec2(0, 1),
                                                  glm::ivec2(-1, 0), glm::ivec2(1, 0)};
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::ivec2 next = patch + sides[i];
            const bool exists =
                next.x >= 0 && next.y >= 0 && next.x < levels.cols() && next.y < levels.rows();
            border_step_[i] = exists ? std::max(step_, 1 << levels(next.x, next.y)) : step_;
        }
    }

    template <class Add> void add_triangles(const Add& add) const {
        for (int row = 0; row < cells_.y; row += step_) {
            for (int col = 0; col < cells_.x; col += step_) {
                add_quad({col, row}, glm::min(glm::ivec2(col, row) + step_, cells_), add);
            }
        }
    }

private:
    template <class Add> void add_quad(glm::ivec2 low, glm::ivec2 high, const Add& add) const {
        const glm::ivec2 north_west = snapped(low);
        const glm::ivec2 south_east = snapped(high);
        add(north_west, snapped({low.x, high.y}), south_east);
        add(north_west, south_east, snapped({high.x, low.y}));
    }

    // Onto the vertices of the neighbours' side.
    [[nodiscard]] glm::ivec2 snapped(glm::ivec2 place) const {
        glm::ivec2 on = place;
        if (place.y == 0 || place.y == cells_.y) {
            on.x = along(place.x, cells_.x, border_step_[place.y == 0 ? 0 : 1]);
        }
        if (place.x == 0 || place.x == cells_.x) {
            on.y = along(place.y, cells_.y, border_step_[place.x == 0 ? 2 : 3]);
        }
        return first_ + on;
    }

    static int along(int place, int end, int step) {
        return place == end ? end : place - place % step;
    }

    glm::ivec2 first_;
    glm::ivec2 cells_;
    int step_;
    std::array<int, 4> border_step_{}; // north, south, west, east
};

bool has_area(glm::ivec2 a, glm::ivec2 b, glm::ivec2 c) {
    return (b.x - a.x) * (c.y - a.y) != (b.y - a.y) * (c.x - a.x);
}

} // namespace

Grid<std::uint8_t> patch_levels(const Heightfield& heightfield, const Placement& placement,
                                glm::dvec3 eye, int levels) {
    check(levels >= 1, "patches without a level");
    const Grid<float>& heights = heightfield.heights;
    const glm::ivec2 cells(heights.cols() - 1, heights.rows() - 1);
    const glm::ivec2 patches = (cells + patch_cells - 1) / patch_cells;
    const double patch_size =
        patch_samples * std::sqrt(heightfield.spacing.x * heightfield.spacing.y);
    Grid<std::uint8_t> chosen(patches.x, patches.y);
    for (int row = 0; row < patches.y; ++row) {
        for (int col = 0; col < patches.x; ++col) {
            const glm::ivec2 middle =
                glm::min(patch_cells * glm::ivec2(col, row) + patch_cells / 2, cells);
            const glm::dvec3 place =
                placement.world_from_sample({middle.x, middle.y, heights(middle.x, middle.y)});
            chosen(col, row) =
                static_cast<std::uint8_t>(level_at(glm::distance(eye, place), patch_size, levels));
        }
    }
    return chosen;
}

Triangulation triangulate_patches(const Grid<std::uint8_t>& levels, const TileCells& tile) {
    Triangulation result;
    constexpr std::uint16_t no_number = std::numeric_limits<std::uint16_t>::max();
    Grid<std::uint16_t> numbers(tile.count.x + 1, tile.count.y + 1, no_number);
    const auto number_of = [&](glm::ivec2 place) {
        std::uint16_t& number = numbers(place.x, place.y);
        if (number == no_number) {
            number = static_cast<std::uint16_t>(result.vertices.size());
            result.vertices.push_back(steps_of(place + tile.first));
        }
        return number;
    };
    const auto add = [&](glm::ivec2 a, glm::ivec2 b, glm::ivec2 c) {
        if (has_area(a, b, c)) {
            for (const glm::ivec2 corner : {a, b, c}) {
                const std::uint16_t number = number_of(corner);
                result.indices.push_back(number);
            }
        }
    };
    for (int row = tile.first.y; row < tile.last().y; row += patch_cells) {
        for (int col = tile.first.x; col < tile.last().x; col += patch_cells) {
            Patch(levels, glm::ivec2(col, row) / patch_cells, tile).add_triangles(add);
        }
    }
    return result;
}

} // namespace reljef::terrain
