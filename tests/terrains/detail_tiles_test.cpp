#include "terrains/detail_tiles.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrains/detail_cells.h"
#include "tests/terrain/chance.h"

namespace reljef::terrains {
namespace {

TEST(DetailTiles, FillTheirRangeAndFitTogetherAtTheirBorders) {
    for (const std::string_view name : detail_names()) {
        const auto set = generate_detail(name, {.size = 128});
        ASSERT_TRUE(set) << name;
        EXPECT_EQ(set->name, name);
        EXPECT_EQ(set->color.cols(), 128);
        const auto [low, high] =
            std::minmax_element(set->heights.samples().begin(), set->heights.samples().end());
        EXPECT_EQ(*low, 0.0F);
        EXPECT_EQ(*high, 1.0F);
        EXPECT_THAT(set->notes, testing::IsEmpty()) << name; // a seam would be one
    }
}

TEST(DetailTiles, AreTheSameForTheSameSeedOnAnyNumberOfThreads) {
    for (const std::string_view name : detail_names()) {
        const auto one = generate_detail(name, {.size = 64, .seed = 3, .threads = 1});
        const auto two = generate_detail(name, {.size = 64, .seed = 3, .threads = 2});
        const auto other = generate_detail(name, {.size = 64, .seed = 4});
        ASSERT_TRUE(one && two && other);
        EXPECT_EQ(one->heights, two->heights);
        EXPECT_EQ(one->color, two->color);
        EXPECT_NE(one->heights, other->heights);
    }
}

TEST(DetailTiles, AnUnknownNameOrSizeIsOneSentence) {
    const auto unknown = generate_detail("wood");
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().message,
              "texture set 'wood' found, one of brick, rock, cobble was expected");
    for (const int size : {-1, 0, 15, 4097}) {
        EXPECT_FALSE(generate_detail("rock", {.size = size})) << size;
    }
}

TEST(Voronoi, RepeatsAndIsNeverFartherFromAnotherSeedThanFromItsOwn) {
    test::Chance chance(2);
    for (int i = 0; i < 3000; ++i) {
        const glm::vec2 point(chance.between(0.0, 5.0), chance.between(0.0, 5.0));
        const VoronoiCell cell = voronoi(7, point, 5, 0.8F);
        const VoronoiCell copy = voronoi(7, point + glm::vec2(5.0F, -5.0F), 5, 0.8F);
        ASSERT_EQ(cell.id, copy.id);
        ASSERT_NEAR(cell.to_edge, copy.to_edge, 1e-5F);
        ASSERT_GE(cell.to_edge, -1e-5F);
        ASSERT_LT(cell.to_edge, 1.2F);
    }
}

} // namespace
} // namespace reljef::terrains
