#include "engine/terrain/mesh/bisection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/terrain/mesh/bisection_mesh.h"
#include "tests/support/release_only.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_bisection.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

using test::all_triangles;
using test::doubled_area;
using test::MadeTerrain;
using test::open_edges;
using test::PlacedTerrain;
using test::rough_hills;
using test::Triangle;

// A hole across the border of two tiles, one in a corner, and single ones.
Heightfield with_voids(Grid<float> heights) {
    Grid<std::uint8_t> voids(heights.cols(), heights.rows());
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            const bool is_void = (std::abs(col - 128) < 20 && std::abs(row - 60) < 15) ||
                                 col + row < 9 || (col * 31 + row * 17) % 97 == 0;
            voids(col, row) = is_void ? 1 : 0;
            heights(col, row) = is_void ? -32768.0F : heights(col, row);
        }
    }
    fill_voids(heights, voids);
    Heightfield heightfield = test::plane_heightfield(std::move(heights), {3.0, 3.0});
    heightfield.void_mask = std::move(voids);
    heightfield.range = height_range(heightfield.heights, heightfield.void_mask);
    return heightfield;
}

// Where bisection goes wrong: any size, nothing to find, one thing to find, the curved Earth.
std::vector<MadeTerrain> hard_terrains() {
    std::vector<MadeTerrain> terrains;
    terrains.push_back({"hills", test::plane_heightfield(rough_hills(161, 130, 1), {5.0, 7.0})});
    terrains.push_back({"least", test::plane_heightfield(test::random_heights(2, 2, 0, 9, 2))});
    terrains.push_back(
        {"strip", test::plane_heightfield(rough_hills(1000, 3, 3), {2.0, 2.0}), 4.0});
    terrains.push_back({"voids", with_voids(rough_hills(260, 140, 6))});
    terrains.push_back({"level", test::plane_heightfield(Grid<float>(140, 33, 7.0F))});
    Grid<float> spike(129, 129, 0.0F);
    spike(37, 100) = 1e3F;
    spike(38, 100) = -1e3F;
    terrains.push_back({"spike", test::plane_heightfield(std::move(spike), {30.0, 30.0})});
    terrains.push_back({"checkerboard", test::plane_heightfield(test::made_heights(
                                            40, 40, [](int c, int r) { return (c + r) % 2; }))});
    terrains.push_back(
        {"Earth", test::geographic_heightfield(rough_hills(140, 131, 4), 46.0, 7.0, 0.01)});
    terrains.push_back(
        {"turned Earth",
         test::geographic_heightfield(rough_hills(70, 50, 5), -60.0, 179.9, 0.03, 25.0), 3.0});
    return terrains;
}

// A view from anywhere around, or one of a uniform error.
ErrorView random_view(test::Chance& chance, const Heightfield& heightfield) {
    ErrorView view;
    view.max_error = std::exp(chance.between(0.0, 4.0));
    view.perspective = !chance.one_in(4);
    if (view.perspective) {
        const glm::dvec2 half = 0.5 * heightfield.spacing *
                                glm::dvec2(heightfield.heights.cols(), heightfield.heights.rows());
        const glm::dvec3 eye(
            chance.between(-half.x, half.x), chance.between(-half.y, half.y),
            chance.between(heightfield.range.low, heightfield.range.high + half.x));
        const glm::dvec3 forward = glm::normalize(
            glm::dvec3(chance.between(-1, 1), chance.between(-1, 1), chance.between(-1.0, 0.3)));
        const glm::dvec3 right = glm::normalize(glm::cross(forward, {0.0, 0.0, 1.0}));
        const glm::dvec3 up = glm::cross(right, forward);
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::dvec3 side =
                glm::normalize(forward + (i % 2 == 0 ? 1.0 : -1.0) * (i < 2 ? right : up));
            view.sides[i] = glm::dvec4(side, -glm::dot(side, eye));
        }
        view.scale = 700.0;
        view.depth = glm::dvec4(forward, -glm::dot(forward, eye));
        view.lateral_origin = -eye;
        view.near = 0.01;
        view.sides[4] = view.depth - glm::dvec4(0.0, 0.0, 0.0, view.near);
    }
    return view;
}

TEST(Bisection, CoversTheHeightfieldOnceWithTrianglesThatMeetEdgeToEdge) {
    RELJEF_RELEASE_ONLY("thousands of covers by the same few lines");
    test::Chance chance(3);
    for (MadeTerrain& made : hard_terrains()) {
        const PlacedTerrain terrain(std::move(made));
        for (int i = 0; i < 10; ++i) {
            const auto triangles = all_triangles(terrain, random_view(chance, terrain.heightfield));
            std::int64_t area = 0;
            for (const Triangle& triangle : triangles) {
                ASSERT_GT(doubled_area(triangle), 0) << terrain.name;
                area += doubled_area(triangle);
            }
            const Steps end = terrain.bisection.end();
            ASSERT_EQ(area, 2 * end.x * end.y) << terrain.name;
            ASSERT_EQ(open_edges(terrain, triangles), 0U) << terrain.name << ' ' << i;
        }
    }
}

TEST(Bisection, AViewThatAllowsEverythingTakesFourTrianglesATile) {
    const PlacedTerrain terrain({"", test::plane_heightfield(rough_hills(257, 129, 1)), 1.0});
    ErrorView view;
    view.perspective = false;
    view.max_error = 1e6;
    EXPECT_EQ(all_triangles(terrain, view).size(), 8U);
}

glm::dvec3 weights(test::Chance& chance) {
    const double u = chance.between(0.0, 1.0);
    const double v = chance.between(0.0, 1.0);
    return u + v > 1.0 ? glm::dvec3(1.0 - u, 1.0 - v, u + v - 1.0) : glm::dvec3(u, v, 1.0 - u - v);
}

// Metres from a point of a triangle to where it belongs on the surface.
double displacement(const PlacedTerrain& terrain, const Triangle& triangle, glm::dvec3 weight) {
    glm::dvec3 shown(0.0);
    glm::dvec2 place(0.0);
    for (int i = 0; i < 3; ++i) {
        const Steps corner = triangle[static_cast<std::size_t>(i)];
        shown += weight[i] * terrain.bisection.world(corner);
        place += weight[i] * samples_of(corner);
    }
    const double height = bilinear_height(terrain.heightfield.heights.view(), place);
    return glm::distance(shown, terrain.placement.world_from_sample({place, height}));
}

// Places of samples are kept as floats relative to their tile's origin: of up to 100 km here.
constexpr double place_rounding = 1e5 * 0x1p-23;

// The largest displacement of a triangulation whose error is the same everywhere.
double farthest_displacement(const PlacedTerrain& terrain, double allowed, int points,
                             test::Chance& chance) {
    ErrorView view;
    view.perspective = false;
    view.max_error = allowed;
    const auto triangles = all_triangles(terrain, view);
    double farthest = 0.0;
    for (int i = 0; i < points; ++i) {
        const auto index =
            static_cast<std::size_t>(chance.whole(0, static_cast<int>(triangles.size()) - 1));
        farthest = std::max(farthest, displacement(terrain, triangles[index], weights(chance)));
    }
    return farthest;
}

TEST(Bisection, NoPointIsFartherFromTheSurfaceThanTheViewAllows) {
    RELJEF_RELEASE_ONLY("thousands of points by the same few lines");
    test::Chance chance(4);
    int points = 0;
    for (MadeTerrain& made : hard_terrains()) {
        const PlacedTerrain terrain(std::move(made));
        const double flat = terrain.name == "Earth" ? 1e-3 : 1e-6;
        for (const double most : {0.05, 0.3, 1.0, 4.0, 20.0, 1000.0}) {
            ASSERT_LE(farthest_displacement(terrain, most, 4000, chance),
                      most + place_rounding + flat)
                << terrain.name << ' ' << most;
            points += 4000;
        }
    }
    EXPECT_GT(points, 100000);
}

// The rows of samples that close a globe at its poles are nearer to their neighbours than others.
TEST(Bisection, NoPointIsFartherOffThanAllowedNextToTheShorterRowsAtThePoles) {
    RELJEF_RELEASE_ONLY("thousands of points by the same few lines");
    test::Chance chance(6);
    for (const glm::dvec2 ends :
         {glm::dvec2(0.5, 0.5), glm::dvec2(0.1, 0.9), glm::dvec2(1.0, 0.5), glm::dvec2(0.0, 0.5)}) {
        for (const int cells : {15, 36, 61}) {
            const PlacedTerrain globe({"globe", test::closed_globe(cells, ends.x, ends.y, 3)});
            for (const double allowed : {1e4, 3e4, 1e5, 3e5, 1e6}) {
                constexpr double rounding = 1e7 * 0x1p-23; // of floats relative to tiles, metres
                EXPECT_LE(farthest_displacement(globe, allowed, 20'000, chance), allowed + rounding)
                    << cells << ' ' << ends.x << ' ' << ends.y;
            }
        }
    }
}

// The last cells of a tile are shorter where its terrain ends.
TEST(Bisection, NoPointIsFartherOffThanAllowedOverTheShorterLastCellsOfATile) {
    RELJEF_RELEASE_ONLY("thousands of points by the same few lines");
    test::Chance chance(7);
    const Heightfield level = test::plane_heightfield(rough_hills(160, 160, 6), {5.0, 7.0});
    const Heightfield earth =
        test::geographic_heightfield(rough_hills(160, 160, 6), 46.0, 7.0, 0.01);
    for (const Heightfield& whole : {level, earth}) {
        const TileLattice lattice{{8.0, 16.0}, {131.0, 159.0}, 4.0, {31, 36}};
        Heightfield samples = test::plane_heightfield(rough_hills(32, 37, 7), 4.0 * whole.spacing);
        const PlacedTerrain tile({"tile", std::move(samples)},
                                 test::placed(whole).of_tile({1, {}, {}}, lattice));
        for (const double allowed : {0.3, 3.0, 10.0, 30.0, 300.0, 3000.0}) {
            EXPECT_LE(farthest_displacement(tile, allowed, 20'000, chance),
                      allowed + place_rounding)
                << whole.spacing.x;
        }
    }
}

bool is_seen(const ErrorView& view, glm::dvec3 place) {
    return std::all_of(view.sides.begin(), view.sides.end(), [&](const glm::dvec4& side) {
        return glm::dot(glm::dvec3(side), place) + side.w >= 0.0;
    });
}

// The claim of exceeds() about perspective: the displacement over the depths.
// Of some points of the triangles in perspective.
void expect_seen_within(double error, const ErrorView& view, const PlacedTerrain& terrain,
                        const std::vector<Triangle>& triangles, test::Chance& chance) {
    for (int k = 0; k < 500; ++k) {
        const auto index =
            static_cast<std::size_t>(chance.whole(0, static_cast<int>(triangles.size()) - 1));
        const glm::dvec3 weight = weights(chance);
        glm::dvec3 shown(0.0);
        for (int j = 0; j < 3; ++j) {
            shown +=
                weight[j] * terrain.bisection.world(triangles[index][static_cast<std::size_t>(j)]);
        }
        const double off = displacement(terrain, triangles[index], weight);
        const double depth = glm::dot(glm::dvec3(view.depth), shown) + view.depth.w;
        if (depth >= view.near && depth - off > 0.0 && is_seen(view, shown)) {
            const double lateral = glm::length(shown + view.lateral_origin);
            ASSERT_LE(view.scale * (off - place_rounding) * lateral,
                      error * depth * (depth - off) * (1.0 + 1e-9))
                << terrain.name << ' ' << depth;
        }
    }
}

TEST(Bisection, NoVisiblePointIsSeenFartherOffThanTheViewAllows) {
    test::Chance chance(5);
    for (MadeTerrain& made : hard_terrains()) {
        const PlacedTerrain terrain(std::move(made));
        for (int i = 0; i < 20; ++i) {
            const ErrorView view = random_view(chance, terrain.heightfield);
            if (view.perspective) {
                expect_seen_within(view.max_error, view, terrain, all_triangles(terrain, view),
                                   chance);
            }
        }
    }
}

TEST(Bisection, NoVisiblePointIsSeenFartherOffThanItsTrianglesError) {
    test::Chance chance(11);
    int small = 0;
    for (MadeTerrain& made : hard_terrains()) {
        const PlacedTerrain terrain(std::move(made));
        for (int i = 0; i < test::rounds(20, 5); ++i) {
            const ErrorView view = random_view(chance, terrain.heightfield);
            const auto triangles = all_triangles(terrain, view);
            for (int j = 0; view.perspective && j < 10; ++j) {
                const auto index = static_cast<std::size_t>(
                    chance.whole(0, static_cast<int>(triangles.size()) - 1));
                const double error = triangle_error_in(view, terrain.bisection, triangles[index]);
                small += error < 0.5 * view.max_error ? 1 : 0;
                expect_seen_within(error, view, terrain, {triangles[index]}, chance);
            }
        }
    }
    EXPECT_GT(small, test::rounds(300, 60));
}

TEST(Bisection, StatesTheErrorOfTheSmallestSquares) {
    RELJEF_RELEASE_ONLY("thousands of covers by the same few lines");
    test::Chance chance(7);
    int larger = 0;
    for (MadeTerrain& made : hard_terrains()) {
        const PlacedTerrain terrain(std::move(made));
        for (int i = 0; i < 20; ++i) {
            ErrorView view = random_view(chance, terrain.heightfield);
            view.near = 1.0;
            view.min_size = steps_per_sample / 4 << chance.whole(0, 6);
            const auto triangles = all_triangles(terrain, view);
            ASSERT_EQ(test::open_edges(terrain, triangles), 0U) << terrain.name;
            double error = 0.0;
            for (const TileCells& tile : terrain.tiles) {
                error = std::max(error, triangulate(terrain.bisection, tile, view).error);
            }
            larger += error > view.max_error ? 1 : 0;
            if (view.perspective && std::isfinite(error)) {
                expect_seen_within(error, view, terrain, triangles, chance);
            }
            view.min_size = 0;
            ASSERT_LE(triangles.size(), all_triangles(terrain, view).size());
        }
    }
    EXPECT_GT(larger, 10);
}

TEST(Bisection, EndsOnceItsBudgetIsExceededAndNotBefore) {
    const PlacedTerrain terrain({"", test::plane_heightfield(rough_hills(129, 129, 1)), 1.0});
    ErrorView view;
    view.perspective = false;
    view.max_error = 1e-9;
    view.min_size = steps_per_sample;
    const std::size_t all = all_triangles(terrain, view).size();
    ASSERT_GT(all, 2U * 128U * 128U - 1U);
    TriangleBudget enough(all);
    const auto whole = triangulate(terrain.bisection, terrain.tiles.front(), view, &enough);
    EXPECT_FALSE(enough.is_exceeded());
    EXPECT_EQ(whole.parts, triangulate(terrain.bisection, terrain.tiles.front(), view).parts);
    TriangleBudget one_less(all - 1);
    triangulate(terrain.bisection, terrain.tiles.front(), view, &one_less);
    EXPECT_TRUE(one_less.is_exceeded());
    TriangleBudget small(5000);
    std::size_t drawn = 0;
    for (const Triangulation& part :
         triangulate(terrain.bisection, terrain.tiles.front(), view, &small).parts) {
        drawn += part.indices.size() / 3;
    }
    EXPECT_TRUE(small.is_exceeded());
    EXPECT_LT(drawn, 8000U);
}

void expect_below(const Split& split, const Split& needs_it, const std::string& name) {
    ASSERT_LE(needs_it.error, split.error) << name;
    if (needs_it.error > 0.0) {
        ASSERT_LE(glm::distance(split.center, needs_it.center) + needs_it.radius, split.radius)
            << name;
    }
}

TEST(Bisection, NoSplitIsGreaterThanTheOneItNeeds) {
    test::Chance chance(6);
    for (MadeTerrain& made : hard_terrains()) {
        const PlacedTerrain terrain(std::move(made));
        const Steps end = terrain.bisection.end();
        for (int i = 0; i < 3000; ++i) {
            const std::int64_t size = 2 << chance.whole(1, 22);
            const Steps square(chance.whole(0, static_cast<int>(end.x / size)),
                               chance.whole(0, static_cast<int>(end.y / size)));
            const Steps middle = size * square + size / 2;
            const Steps side = middle + Steps(chance.one_in(2) ? size / 2 : -size / 2, 0);
            const Steps quarter = side + Steps(0, chance.one_in(2) ? size / 4 : -size / 4) +
                                  Steps(side.x > middle.x ? -size / 4 : size / 4, 0);
            const auto inside = [&](Steps at) {
                return at.x >= 0 && at.y >= 0 && at.x <= end.x && at.y <= end.y;
            };
            if (inside(middle) && inside(side) && size < steps_per_sample * tile_cells) {
                expect_below(terrain.bisection.split(middle, static_cast<int>(size), false),
                             terrain.bisection.split(side, static_cast<int>(size), true),
                             terrain.name);
            }
            if (inside(quarter) && inside(side) && size > 2) {
                expect_below(terrain.bisection.split(side, static_cast<int>(size), true),
                             terrain.bisection.split(quarter, static_cast<int>(size / 2), false),
                             terrain.name);
            }
        }
    }
}

TEST(Bisection, ALowerErrorNeverTakesFewerTriangles) {
    const PlacedTerrain terrain({"", test::plane_heightfield(rough_hills(161, 130, 1)), 1.0});
    ErrorView view;
    view.perspective = false;
    std::size_t before = std::numeric_limits<std::size_t>::max();
    for (const double most : {0.2, 0.5, 1.0, 2.0, 10.0, 100.0}) {
        view.max_error = most;
        const std::size_t count = all_triangles(terrain, view).size();
        EXPECT_LT(count, before) << most;
        before = count;
    }
}

} // namespace
} // namespace reljef::terrain
