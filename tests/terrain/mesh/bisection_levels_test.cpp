// What holds between levels of detail: tiles side by side, and a tile at one error and the next.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stop_token>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/release_only.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_bisection.h"

namespace reljef::terrain {
namespace {

using test::all_triangles;
using test::PlacedTerrain;
using test::Triangle;

ErrorView uniform_view(double max_error) {
    ErrorView view;
    view.perspective = false;
    view.max_error = max_error;
    return view;
}

// Heights that need every split of the first levels and none of those below: each split down to
// the level that `level_at` gives moves the middle of the longest edge by a metre.
template <class LevelAt> class SplitHeights {
public:
    SplitHeights(int cols, int rows, const LevelAt& level_at)
        : heights_(cols, rows), level_at_(level_at) {}

    Grid<float> made() {
        int level = 0;
        for (int size = tile_cells; size > 1; size /= 2) {
            split_sides(size, ++level);
            split_middles(size / 2, ++level);
        }
        return std::move(heights_);
    }

private:
    void split_sides(int size, int level) {
        const int half = size / 2;
        for (int y = 0; y < heights_.rows(); y += half) {
            const bool is_row = y % size == 0;
            for (int x = is_row ? half : 0; x < heights_.cols(); x += size) {
                split(level, {x, y}, is_row ? glm::ivec2(half, 0) : glm::ivec2(0, half));
            }
        }
    }

    void split_middles(int size, int level) {
        const int half = size / 2;
        for (int y = half; half > 0 && y < heights_.rows(); y += size) {
            for (int x = half; x < heights_.cols(); x += size) {
                const bool falls = (x / size + y / size) % 2 == 0;
                split(level, {x, y}, {half, falls ? half : -half});
            }
        }
    }

    void split(int level, glm::ivec2 place, glm::ivec2 along) {
        const glm::ivec2 a = place - along;
        const glm::ivec2 b = place + along;
        heights_(place.x, place.y) = 0.5F * (heights_(a.x, a.y) + heights_(b.x, b.y)) +
                                     (level <= level_at_(place) ? 1.0F : 0.0F);
    }

    Grid<float> heights_;
    const LevelAt& level_at_;
};

PlacedTerrain two_tiles(int western_level, int eastern_level) {
    const auto level_at = [&](glm::ivec2 place) {
        const int west = place.x <= tile_cells ? western_level : eastern_level;
        const int east = place.x >= tile_cells ? eastern_level : western_level;
        return std::min(west, east);
    };
    return PlacedTerrain(
        {"two tiles",
         test::plane_heightfield(SplitHeights(2 * tile_cells + 1, tile_cells + 1, level_at).made()),
         1.0});
}

// Of the smallest triangle at a column (steps): 0 is a quarter of a tile.
int finest_level(const std::vector<Triangle>& triangles, std::int64_t col) {
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    for (const Triangle& triangle : triangles) {
        const auto [low, high] = std::minmax({triangle[0].x, triangle[1].x, triangle[2].x});
        if (low <= col && high >= col) {
            least = std::min(least, test::doubled_area(triangle));
        }
    }
    const double quarter = 0.5 * std::pow(steps_per_sample * tile_cells, 2.0);
    return static_cast<int>(std::lround(std::log2(quarter / static_cast<double>(least))));
}

TEST(BisectionLevels, TilesOfEveryPairOfLevelsMeetEdgeToEdge) {
    RELJEF_RELEASE_ONLY("every pair by the same few lines");
    constexpr int levels = 13; // down to the samples
    for (int west = 0; west <= levels; ++west) {
        for (int east = west; east <= levels; ++east) {
            const PlacedTerrain terrain = two_tiles(west, east);
            const auto triangles = all_triangles(terrain, uniform_view(0.9));
            ASSERT_EQ(test::open_edges(terrain, triangles), 0U) << west << ' ' << east;
            // What the finer tile needs of the border reaches the far side once at most.
            const int at_far_side = finest_level(triangles, 0);
            ASSERT_TRUE(at_far_side == west || (west == 0 && at_far_side == 1)) << east;
            ASSERT_EQ(finest_level(triangles, terrain.bisection.end().x), east);
        }
    }
}

using VertexPlace = std::pair<std::int64_t, std::int64_t>;

std::vector<VertexPlace> vertices_of(const std::vector<Triangle>& triangles) {
    std::vector<VertexPlace> places;
    for (const Triangle& triangle : triangles) {
        for (const Steps corner : triangle) {
            places.emplace_back(corner.x, corner.y);
        }
    }
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    return places;
}

TEST(BisectionLevels, ASmallerErrorOnlyAddsVertices) {
    RELJEF_RELEASE_ONLY("many covers by the lines of the next test");
    for (const unsigned seed : {1U, 2U, 3U}) {
        const PlacedTerrain terrain(
            {"", test::plane_heightfield(test::rough_hills(150, 140, seed), {3.0, 3.0}), 1.0});
        std::vector<VertexPlace> before;
        for (const double most : {1000.0, 60.0, 20.0, 8.0, 3.0, 1.0, 0.5, 0.25}) {
            const auto places = vertices_of(all_triangles(terrain, uniform_view(most)));
            EXPECT_GE(places.size(), before.size());
            EXPECT_TRUE(std::includes(places.begin(), places.end(), before.begin(), before.end()))
                << most;
            before = places;
        }
    }
}

using SplitFigures = std::vector<std::tuple<double, double>>;

SplitFigures all_splits(const Bisection& bisection, int min_size = steps_per_sample) {
    SplitFigures figures;
    const Steps end = bisection.end();
    for (int size = min_size; size <= steps_per_sample * tile_cells; size *= 2) {
        for (std::int64_t y = 0; y <= end.y; y += size / 2) {
            for (std::int64_t x = 0; x <= end.x; x += size / 2) {
                const bool in_col = x % size != 0;
                const bool in_row = y % size != 0;
                const bool is_in_middle = in_col && in_row && size < steps_per_sample * tile_cells;
                if (is_in_middle || in_col != in_row) {
                    const Split split = bisection.split({x, y}, size, !is_in_middle);
                    figures.emplace_back(split.error, split.radius);
                }
            }
        }
    }
    return figures;
}

TEST(BisectionLevels, AreTheSameToTheBitForAnyNumberOfThreads) {
    const Heightfield plane = test::plane_heightfield(test::rough_hills(261, 180, 8));
    const Heightfield earth =
        test::geographic_heightfield(test::rough_hills(140, 131, 4), 46.0, 7.0, 0.01);
    for (const Heightfield* heightfield : {&plane, &earth}) {
        const Placement placement = test::placed(*heightfield);
        const auto expected = all_splits(Bisection(*heightfield, placement, {1, {}, {}}));
        for (const unsigned threads : {2U, 3U, 7U}) {
            EXPECT_EQ(all_splits(Bisection(*heightfield, placement, {threads, {}, {}})), expected)
                << threads;
        }
    }
}

TEST(BisectionLevels, AStopEndsTheBuildingEarly) {
    const Heightfield heightfield = test::plane_heightfield(test::rough_hills(600, 600, 8));
    const Placement placement = test::placed(heightfield);
    std::stop_source stop;
    stop.request_stop();
    const Bisection stopped(heightfield, placement, {2, stop.get_token(), {}});
    const auto figures = all_splits(stopped, 2 * steps_per_sample);
    EXPECT_TRUE(std::all_of(figures.begin(), figures.end(),
                            [](const auto& split) { return std::get<0>(split) == 0.0; }));
}

} // namespace
} // namespace reljef::terrain
