#include "engine/material/tile_cones.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include "engine/core/bilinear.h"
#include "tests/terrain/chance.h"

namespace reljef::terrain {
namespace {

int index_in(int index, int count) {
    return ((index % count) + count) % count;
}

// Of the tile and its copies.
double height_in_copies(const Grid<float>& heights, glm::dvec2 place) {
    const glm::ivec2 cell(glm::floor(place));
    const glm::dvec2 part = place - glm::dvec2(cell);
    const auto at = [&](int right, int down) {
        return static_cast<double>(heights(index_in(cell.x + right, heights.cols()),
                                           index_in(cell.y + down, heights.rows())));
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), part.x), glm::mix(at(0, 1), at(1, 1), part.x),
                    part.y);
}

// Every plain cone on a random point of its cell, against random points of the copies around.
TEST(TileCones, HoldNothingOfTheNextCopiesEither) {
    test::Chance chance(3);
    for (const auto& [cols, rows] : {std::pair{16, 16}, std::pair{13, 7}, std::pair{1, 1}}) {
        Grid<float> heights(cols, rows);
        for (float& height : heights.samples()) {
            height = static_cast<float>(std::pow(chance.between(0.0, 1.0), 4.0));
        }
        const material::ConeMaps cones = material::tile_cones(
            *material::cone_maps(
                material::cone_field(heights.view(), material::WrapMode::wrap).view()),
            cols, rows, material::WrapMode::wrap);
        ASSERT_EQ(cones.plain.cols(), cols);
        ASSERT_EQ(cones.relaxed.rows(), rows);
        for (int i = 0; i < 200'000; ++i) {
            const glm::ivec2 cell(chance.whole(0, cols - 1), chance.whole(0, rows - 1));
            const glm::dvec2 tip =
                glm::dvec2(cell) + glm::dvec2(chance.between(0.0, 1.0), chance.between(0.0, 1.0));
            const glm::dvec2 way(chance.between(-2.0 * cols, 2.0 * cols),
                                 chance.between(-2.0 * rows, 2.0 * rows));
            const double rise =
                height_in_copies(heights, tip + way) - height_in_copies(heights, tip);
            ASSERT_LE(cones.plain(cell.x, cell.y) * rise, glm::length(way) + 1e-6);
            ASSERT_LE(cones.plain(cell.x, cell.y), cones.relaxed(cell.x, cell.y));
        }
    }
}

TEST(TileCones, OfATileThatDoesNotRepeatHaveACellBetweenEachTwoTexels) {
    const Grid<float> heights(5, 1, 0.5F);
    const material::ConeMaps cones = material::tile_cones(
        *material::cone_maps(
            material::cone_field(heights.view(), material::WrapMode::clamp).view()),
        5, 1, material::WrapMode::clamp);
    EXPECT_EQ(cones.plain.cols(), 4);
    EXPECT_EQ(cones.plain.rows(), 1);
    EXPECT_NEAR(cones.plain(3, 0), material::max_cone_ratio, 1e-3F); // rounded down
}

// A ridge that rises towards the tile's border is a wall beyond it: what rises along every way on
// the tile falls out there.
TEST(TileCones, OfATileThatDoesNotRepeatTrustNothingBeyondItsBorder) {
    Grid<float> ridge(24, 24, 0.0F);
    for (int col = 0; col < 24; ++col) {
        ridge(col, 0) = 1.0F - 0.04F * static_cast<float>(col);
    }
    for (const material::WrapMode border :
         {material::WrapMode::clamp, material::WrapMode::discard}) {
        const material::ConeMaps cones = material::tile_cones(
            *material::cone_maps(material::cone_field(ridge.view(), border).view()), 24, 24,
            border);
        for (std::size_t i = 0; i < cones.plain.size(); ++i) {
            EXPECT_EQ(cones.relaxed.samples()[i], cones.plain.samples()[i]);
        }
    }
}

} // namespace
} // namespace reljef::terrain
