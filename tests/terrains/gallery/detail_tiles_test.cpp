#include "terrains/gallery/detail_tiles.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/material/noise.h"
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
        EXPECT_TRUE(name == "rings" ? *high > 0.95F && *high <= 1.0F : *high == 1.0F) << name;
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
        EXPECT_NE(one->color, other->color);
    }
}

double hole_share(const material::LayerMap& layers) {
    const auto heights = layers.heights().samples();
    const auto holes = std::count_if(heights.begin(), heights.end(), [](const glm::vec4& at) {
        return at.x == at.y && at.z == at.w;
    });
    return static_cast<double>(holes) / static_cast<double>(heights.size());
}

TEST(DetailTiles, AFenceAndACurtainOfRingsHaveHoles) {
    const auto fence = generate_detail("fence", {.size = 256}).value();
    const auto wires = material::layers_of(fence, material::LayerKind::symmetric);
    EXPECT_GT(hole_share(wires), 0.4);
    EXPECT_LT(hole_share(wires), 0.7);
    const auto rings = generate_detail("rings", {.size = 256}).value();
    EXPECT_GT(hole_share(*rings.layers), 0.3);
    EXPECT_LT(hole_share(*rings.layers), 0.7);
}

// Every ring goes over each of its neighbours once and under it once: as many crossings, all apart.
TEST(DetailTiles, RingsHangInEachOtherAndDoNotTouch) {
    const auto rings = generate_detail("rings", {.size = 256}).value();
    int two = 0;
    for (const glm::vec4& at : rings.layers->heights().samples()) {
        two += at.z > at.w ? 1 : 0;
        ASSERT_TRUE(at.z == at.w || at.y > at.z);
    }
    EXPECT_GT(two, 256 * 256 / 50);
}

TEST(DetailTiles, AnUnknownNameOrSizeIsOneSentence) {
    const auto unknown = generate_detail("wood");
    ASSERT_FALSE(unknown);
    EXPECT_EQ(
        unknown.error().message,
        "texture set 'wood' found, one of brick, rock, cobble, fence, rings, copper was expected");
    for (const int size : {-1, 0, 15, 4097}) {
        EXPECT_FALSE(generate_detail("rock", {.size = size})) << size;
    }
}

TEST(Voronoi, RepeatsAndIsNeverFartherFromAnotherSeedThanFromItsOwn) {
    test::Chance chance(2);
    for (int i = 0; i < 3000; ++i) {
        const glm::vec2 point(chance.between(0.0, 5.0), chance.between(0.0, 5.0));
        const material::VoronoiCell cell = material::voronoi(7, point, 5, 0.8F);
        const material::VoronoiCell copy =
            material::voronoi(7, point + glm::vec2(5.0F, -5.0F), 5, 0.8F);
        ASSERT_EQ(cell.id, copy.id);
        ASSERT_NEAR(cell.to_edge, copy.to_edge, 1e-5F);
        ASSERT_GE(cell.to_edge, -1e-5F);
        ASSERT_LT(cell.to_edge, 1.2F);
    }
}

} // namespace
} // namespace reljef::terrains
