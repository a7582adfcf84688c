#include "engine/terrain/field/coarse_terrain.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/release_only.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

// Any size, on a plane or on the Earth, with voids or without.
Terrain any_terrain(test::Chance& chance) {
    Grid<float> heights =
        test::random_heights(chance.whole(2, 300), chance.whole(2, 300), -100.0F, 3000.0F,
                             static_cast<unsigned>(chance.whole(0, 1 << 20)));
    Terrain terrain;
    terrain.name = "any";
    terrain.errors.emplace_back("a file that cannot be read");
    terrain.color = Image(3, 2, Rgba8{1, 2, 3, 255});
    terrain.heightfield =
        chance.one_in(2)
            ? test::plane_heightfield(std::move(heights), {chance.between(0.1, 9.0), 7.0})
            : test::geographic_heightfield(std::move(heights), chance.between(-60.0, 70.0),
                                           chance.between(-170.0, 170.0), 1e-3,
                                           chance.between(-40.0, 40.0));
    Heightfield& field = terrain.heightfield;
    if (chance.one_in(2)) {
        field.void_mask = Grid<std::uint8_t>(field.heights.cols(), field.heights.rows());
        field.void_mask(0, 0) = 1;
        field.void_count = 1;
    }
    return terrain;
}

TEST(CoarseTerrain, IsTheSameGroundWithFewerSamples) {
    test::Chance chance(1);
    for (int i = 0; i < test::rounds(1000, 200); ++i) {
        const Terrain fine = any_terrain(chance);
        const auto max_samples = static_cast<std::size_t>(chance.whole(4, 20000));
        const Terrain coarse = coarse_terrain(fine, max_samples);
        const Heightfield& a = fine.heightfield;
        const Heightfield& b = coarse.heightfield;
        const bool is_narrow = std::min(b.heights.cols(), b.heights.rows()) == 2;
        EXPECT_TRUE(b.heights.size() <= max_samples || is_narrow);
        EXPECT_EQ(b.reduction > 1.0, b.heights.size() < a.heights.size());
        EXPECT_EQ(b.range.high, a.range.high);
        EXPECT_EQ(coarse.color, fine.color);
        EXPECT_EQ(coarse.errors, fine.errors);
        EXPECT_EQ(b.void_mask.empty(), a.void_mask.empty());
        EXPECT_EQ(b.void_count, a.void_count);
        const Placement place_a = test::placed(a);
        const Placement place_b = test::placed(b);
        const glm::dvec2 last_a(test::cells_of(a));
        const glm::dvec2 last_b(test::cells_of(b));
        for (int k = 0; k < 4; ++k) {
            const glm::dvec2 part(chance.between(0.0, 1.0), chance.between(0.0, 1.0));
            const glm::dvec3 at_a = place_a.world_from_sample({part * last_a, 10.0});
            const glm::dvec3 at_b = place_b.world_from_sample({part * last_b, 10.0});
            EXPECT_LE(glm::distance(at_a, at_b), 1e-6) << "metres, of 20 km";
        }
        const glm::ivec2 sample(chance.whole(0, test::cells_of(b).x),
                                chance.whole(0, test::cells_of(b).y));
        EXPECT_NEAR(b.heights(sample.x, sample.y),
                    bilinear_height(a.heights.view(), glm::dvec2(sample) / last_b * last_a), 2e-3);
    }
}

} // namespace
} // namespace reljef::terrain
