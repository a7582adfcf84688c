#include "engine/scene/streaming/tile_voids.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "engine/core/check.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::scene {
namespace {

// Vertices along a side of the border, in a tile with one step around it.
std::vector<glm::ivec2> side_of(glm::ivec2 from, glm::ivec2 to) {
    const glm::ivec2 step = (to - from) / std::max(to.x - from.x, to.y - from.y);
    std::vector<glm::ivec2> side;
    for (glm::ivec2 at = from; at != to; at += step) {
        side.push_back(at);
    }
    side.push_back(to);
    return side;
}

class VoidFill {
public:
    VoidFill(FilledHeights& filled, const Grid<float>& coarse, double reach)
        : heights_(filled.heights), was_void_(filled.was_void), coarse_(coarse), reach_(reach),
          last_(heights_.cols() - 2, heights_.rows() - 2) {}

    void run() {
        const glm::ivec2 north_east(last_.x, 1);
        const glm::ivec2 south_west(1, last_.y);
        fill_side(side_of({1, 1}, north_east));
        fill_side(side_of({1, 1}, south_west));
        fill_side(side_of(south_west, last_));
        fill_side(side_of(north_east, last_));
        fill_inside();
        fill_around();
    }

private:
    struct Range {
        float low = std::numeric_limits<float>::infinity();
        float high = -std::numeric_limits<float>::infinity();
        void add(float height) {
            low = std::min(low, height);
            high = std::max(high, height);
        }
    };

    [[nodiscard]] bool is_void(glm::ivec2 at) const { return was_void_(at.x, at.y) != 0; }
    void add_to(Range& range, glm::ivec2 at) const {
        range.add(is_void(at) ? coarse_(at.x, at.y) : heights_(at.x, at.y));
    }
    [[nodiscard]] float correction(glm::ivec2 at) const {
        return heights_(at.x, at.y) - coarse_(at.x, at.y);
    }
    void set(glm::ivec2 at, float correction, const Range& range) {
        heights_(at.x, at.y) = std::clamp(coarse_(at.x, at.y) + correction, range.low, range.high);
    }

    void fill_side(const std::vector<glm::ivec2>& side) {
        Range range;
        for (const glm::ivec2 at : side) {
            add_to(range, at);
        }
        for (const glm::ivec2 corner : {side.front(), side.back()}) {
            if (is_void(corner)) {
                set(corner, 0.0F, range);
            }
        }
        std::size_t known = 0;
        for (std::size_t i = 1; i < side.size(); ++i) {
            if (!is_void(side[i]) || i + 1 == side.size()) {
                fill_between(side, known, i, range);
                known = i;
            }
        }
    }
    // Between the corrections at two vertices of a side: nearly linear if they are near each other.
    // Linear ones would stand as ridges in wide voids, whose inside the heights around smooth.
    void fill_between(const std::vector<glm::ivec2>& side, std::size_t first, std::size_t last,
                      const Range& range) {
        const double from = static_cast<double>(correction(side[first]));
        const double to = static_cast<double>(correction(side[last]));
        const auto share = [this](std::size_t steps) {
            return std::sinh(static_cast<double>(steps) / reach_);
        };
        for (std::size_t i = first + 1; i < last; ++i) {
            const double correction =
                (from * share(last - i) + to * share(i - first)) / share(last - first);
            set(side[i], static_cast<float>(correction), range);
        }
    }

    [[nodiscard]] bool is_inside(glm::ivec2 at) const {
        return at.x > 1 && at.y > 1 && at.x < last_.x && at.y < last_.y;
    }

    void fill_inside() {
        Range range;
        Grid<float> corrections(last_.x, last_.y);
        Grid<std::uint8_t> open(last_.x, last_.y);
        for (int row = 0; row < last_.y; ++row) {
            for (int col = 0; col < last_.x; ++col) {
                const glm::ivec2 at(col + 1, row + 1);
                add_to(range, at);
                open(col, row) = is_inside(at) && is_void(at) ? 1 : 0;
                corrections(col, row) = open(col, row) != 0 ? 0.0F : correction(at);
            }
        }
        terrain::fill_voids(corrections, open);
        set_inside(corrections, open, range);
    }

    void set_inside(const Grid<float>& corrections, const Grid<std::uint8_t>& open,
                    const Range& range) {
        for (int row = 0; row < last_.y; ++row) {
            for (int col = 0; col < last_.x; ++col) {
                if (open(col, row) != 0) {
                    set({col + 1, row + 1}, corrections(col, row), range);
                }
            }
        }
    }

    // No vertices lie there; normals need them.
    void fill_around() {
        for (int row = 0; row < heights_.rows(); ++row) {
            for (int col = 0; col < heights_.cols(); ++col) {
                const glm::ivec2 at(col, row);
                const glm::ivec2 vertex = glm::clamp(at, glm::ivec2(1), last_);
                if (vertex != at && is_void(at)) {
                    heights_(col, row) = coarse_(col, row) + correction(vertex);
                }
            }
        }
    }

    Grid<float>& heights_;
    const Grid<std::uint8_t>& was_void_;
    const Grid<float>& coarse_;
    double reach_;
    glm::ivec2 last_; // vertex, in the grid
};

} // namespace

FilledHeights fill_tile_voids(Grid<float> heights, const Grid<float>& coarse, double reach) {
    check(reach > 0.0, "a reach above 0 was expected");
    check(heights.cols() >= 4 && heights.rows() >= 4 && heights.cols() == coarse.cols() &&
              heights.rows() == coarse.rows(),
          "heights of equal sizes with one step around were expected");
    FilledHeights filled{std::move(heights), {}};
    filled.was_void = Grid<std::uint8_t>(filled.heights.cols(), filled.heights.rows());
    for (std::size_t i = 0; i < filled.heights.size(); ++i) {
        filled.was_void.samples()[i] = std::isfinite(filled.heights.samples()[i]) ? 0 : 1;
    }
    VoidFill(filled, coarse, reach).run();
    return filled;
}

} // namespace reljef::scene
