#include "engine/cast/tile_nodes.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/mat2x2.hpp>
#include <gtest/gtest.h>

#include "tests/support/release_only.h"
#include "tests/terrain/chance.h"

namespace reljef::cast {
namespace {

constexpr int squares = 8;     // along a side
constexpr double square = 8.0; // samples
constexpr PixelBlock block{{64, 32}, {32, 32}};

// Quarters a square of tiles down to single ones.
int add_nodes(glm::ivec2 first, int side, TileNodes& nodes) {
    const auto index = static_cast<int>(nodes.size());
    nodes.emplace_back();
    TileNode node;
    node.box.add(glm::dvec3(square * glm::dvec2(first), 0.0));
    node.box.add(glm::dvec3(square * glm::dvec2(first + side), 1.0));
    node.seen = {{0, 0}, {128, 128}};
    if (side == 1) {
        node.tile = first.y * squares + first.x;
    } else {
        const int half = side / 2;
        node.lines = square * glm::dvec2(first + half);
        for (int i = 0; i < 4; ++i) {
            node.parts[static_cast<std::size_t>(i)] =
                add_nodes(first + half * glm::ivec2(i & 1, i >> 1), half, nodes);
        }
    }
    nodes[static_cast<std::size_t>(index)] = node;
    return index;
}

// Rays from near a line between tiles, mostly along it, which the curved ground turns.
PictureRays made_rays(test::Chance& chance) {
    const auto turned = [](double angle, glm::dmat2 matrix) {
        return glm::dmat2(std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle)) *
               matrix;
    };
    const bool is_along = chance.one_in(2);
    const double spread = chance.between(3e-4, 2e-3);
    const glm::dmat2 gradient =
        turned(is_along ? chance.between(-0.02, 0.02) : chance.between(0.0, 6.2),
               glm::dmat2(spread, 0.0, 0.1 * spread, 0.3 * spread));
    const glm::dvec2 eye(32.0 + (is_along ? chance.between(-0.02, 0.02) : chance.between(-9, 9)),
                         chance.between(-10.0, 60.0));
    const double way = is_along ? chance.between(-0.02, 0.02) : chance.between(-1.0, 1.0);
    const double turn = chance.between(-0.1, 0.1);
    const double bend = is_along ? chance.between(-1e-3, 1e-3) : chance.between(-0.1, 0.1);
    const glm::dvec2 middle = glm::dvec2(block.first) + 16.0;
    const auto at = [&](double t) {
        const glm::dmat2 by = t * turned(turn * t / 60.0, gradient);
        const glm::dvec2 place =
            eye + t * glm::dvec2(way, 1.0) + glm::dvec2(bend * t * t / 60.0, 0.0);
        return PictureRays::Vectors{glm::dvec3(place - by * middle, 0.5), glm::dvec3(by[0], 0.0),
                                    glm::dvec3(by[1], 0.0)};
    };
    const double begin = chance.one_in(3) ? 0.0 : chance.between(0.0, 40.0);
    const double end = begin + chance.between(1.0, 60.0);
    PictureRays like;
    like.size = {128, 128};
    return straight_between(at(begin), at(end), {begin, end}, like);
}

glm::dvec2 place_of(const PictureRays& rays, glm::dvec2 pixel, double t) {
    return glm::dvec2(places_at(rays, t).at(pixel));
}

// Whether a ray passes tiles in another order, or one that is not there.
bool is_out_of_order(const PictureRays& rays, const std::vector<TileAlong>& tiles, glm::dvec2 pixel,
                     double around = 0.0) {
    auto here = tiles.begin();
    constexpr int steps = 300;
    for (int i = 0; i <= steps; ++i) {
        const double t = glm::mix(rays.range.begin, rays.range.end, i / double{steps});
        glm::dvec2 at = place_of(rays, pixel, t) / square;
        const double turn = around > 0.0 ? std::floor(at.x * square / around) : 0.0;
        at.x -= turn * around / square;
        constexpr double near = 1e-6; // a border
        const glm::dvec2 inside = glm::fract(at);
        if (std::min({at.x, at.y, inside.x - near, inside.y - near, 1.0 - near - inside.x,
                      1.0 - near - inside.y, squares - at.x, squares - at.y}) <= 0.0) {
            continue;
        }
        const auto tile = static_cast<std::size_t>(std::floor(at.y) * squares + std::floor(at.x));
        here = std::find(here, tiles.end(), TileAlong{tile, -turn * around});
        if (here == tiles.end()) {
            return true;
        }
    }
    return false;
}

glm::dvec2 pixel_in_block(test::Chance& chance) {
    return glm::dvec2(block.first) +
           glm::dvec2(chance.between(0.0, 32.0), chance.between(0.0, 32.0));
}

void expect_in_order(const PictureRays& rays, const TilesAlong& along, test::Chance& chance,
                     double around = 0.0) {
    for (int i = 0; i < 20; ++i) {
        EXPECT_FALSE(is_out_of_order(rays, along.tiles, pixel_in_block(chance), around));
    }
}

struct Counts {
    int turned = 0;  // blocks
    int wrong = 0;   // rays
    int turning = 0; // parts
    double moved = 0.0;
};

void check_order(const TileNodes& nodes, const PictureRays& rays, test::Chance& chance,
                 Counts& counts) {
    const TilesAlong along = tiles_along(nodes, rays, block);
    std::vector<PictureRays> parts{rays};
    const int turned = counts.turned;
    constexpr double tolerance = 5e-3; // samples
    if (along.turns.x || along.turns.y) {
        ++counts.turned;
        parts = without_turns(rays, block, along.turns,
                              [](double /*t*/) { return glm::dvec2(tolerance); });
    }
    for (const PictureRays& part : parts) {
        const TilesAlong found = tiles_along(nodes, part, block);
        counts.turning += found.turns.x || found.turns.y ? 1 : 0;
        const int count = counts.turned > turned ? 400 : 20; // few rays of a block turn
        for (int i = 0; i < count; ++i) {
            const glm::dvec2 pixel = pixel_in_block(chance);
            counts.wrong += is_out_of_order(part, found.tiles, pixel) ? 1 : 0;
            for (const double t : {part.range.begin, part.range.end}) {
                counts.moved = std::max(counts.moved, glm::distance(place_of(part, pixel, t),
                                                                    place_of(rays, pixel, t)));
            }
        }
    }
    EXPECT_EQ(parts.front().range.begin, rays.range.begin);
    EXPECT_EQ(parts.back().range.end, rays.range.end);
}

TEST(TileNodes, AreInTheOrderOfAllRays) {
    TileNodes nodes;
    add_nodes({0, 0}, squares, nodes);
    test::Chance chance(51);
    Counts counts;
    const int rounds = test::rounds(5000, 500);
    for (int round = 0; round < rounds; ++round) {
        check_order(nodes, made_rays(chance), chance, counts);
    }
    EXPECT_EQ(counts.wrong, 0);
    EXPECT_EQ(counts.turning, 0);
    EXPECT_GT(counts.turned, rounds / 100);
    EXPECT_LT(counts.moved, 1e-2);
}

// A globe of `around` columns has the same tiles again and again.
TEST(TileNodes, OfAGlobeAreInTheOrderOfRaysAcrossItsSeam) {
    constexpr double around = squares * square;
    TileNodes nodes;
    add_nodes({0, 0}, squares, nodes);
    test::Chance chance(53);
    int across = 0;
    for (int round = 0; round < test::rounds(3000, 300); ++round) {
        PictureRays rays = made_rays(chance);
        rays.origin.first.x += 0.5 * around + around * chance.whole(-2, 2);
        const TilesAlong along = tiles_along(nodes, rays, block, {0.0, around});
        if (along.turns.x || along.turns.y || along.tiles.empty()) {
            continue;
        }
        across += along.tiles.front().by != along.tiles.back().by ? 1 : 0;
        expect_in_order(rays, along, chance, around);
    }
    EXPECT_GT(across, test::rounds(300, 30));
}

// As far as the lattice shows them: rays between its places are off by their bulge.
TEST(TileNodes, AreInTheOrderOfBentRays) {
    TileNodes nodes;
    add_nodes({0, 0}, squares, nodes);
    test::Chance chance(54);
    int in_order = 0;
    for (int round = 0; round < test::rounds(3000, 300); ++round) {
        PictureRays rays = made_rays(chance);
        const glm::dvec2 middle = glm::dvec2(block.first) + 16.0;
        for (glm::dvec3& bend : rays.direction.bends) {
            bend = glm::dvec3(chance.between(-1e-7, 1e-7), chance.between(-1e-7, 1e-7), 0.0);
        }
        rays.direction.first -=
            rays.direction.at(middle) - (rays.direction.first + middle.x * rays.direction.right +
                                         middle.y * rays.direction.down);
        const TilesAlong along = tiles_along(nodes, rays, block);
        if (along.turns.x || along.turns.y) {
            continue;
        }
        ++in_order;
        expect_in_order(rays, along, chance);
    }
    EXPECT_GT(in_order, test::rounds(1000, 100));
}

TEST(TileNodes, AreNoneBesideTheRaysOrBelowThem) {
    TileNodes nodes;
    add_nodes({0, 0}, squares, nodes);
    test::Chance chance(52);
    PictureRays rays = made_rays(chance);
    rays.origin.first.z += 1.0;
    EXPECT_TRUE(tiles_along(nodes, rays, block).tiles.empty());
    rays.origin.first.z -= 1.0;
    EXPECT_TRUE(tiles_along(nodes, rays, {{128, 0}, {32, 32}}).tiles.empty());
    rays.origin.first.x += 1e4;
    EXPECT_TRUE(tiles_along(nodes, rays, block).tiles.empty());
    EXPECT_TRUE(tiles_along({}, rays, block).tiles.empty());
}

} // namespace
} // namespace reljef::cast
