#include "engine/terrain/field/horizon.h"

#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "engine/terrain/field/surface_caster.h"
#include "engine/terrain/mesh/tile_layout.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/landscape.h"

namespace reljef::terrain {
namespace {

using test::Landscape;

std::optional<Horizon> horizon_of(const Landscape& land, const HorizonView& view) {
    return Horizon::create(land.heightfield, land.pyramid, land.placement, view);
}

// Waves from west to east, `across` samples long, that rise and fall along their crests too.
Grid<float> wave_crests(int side, double height, double across) {
    return test::made_heights(side, side, [&](int col, int row) {
        return height * (std::sin(col / across) + 0.2 * std::sin(0.05 * row) +
                         0.05 * std::sin(1.7 * col + 0.9 * row));
    });
}

// The part of a grid's cells from (col, row) on, so many a side.
Box block_of(const Landscape& land, glm::ivec2 first, int side) {
    Box box;
    for (int row = first.y; row <= first.y + side; ++row) {
        for (int col = first.x; col <= first.x + side; ++col) {
            box.add(land.at({col, row}));
        }
    }
    return box;
}

struct Count {
    int hidden = 0;
    int shown = 0;
};

// Each block that is said to be hidden is looked for at random places: the exact ray to each must
// meet other ground before.
Count count_hidden(const Landscape& land, int views, unsigned seed) {
    constexpr int block = 16;
    test::Chance chance(seed);
    const GridView<const float> heights = land.heightfield.heights.view();
    const SurfaceCaster caster(heights, land.pyramid, land.placement);
    Count count;
    for (int i = 0; i < views; ++i) {
        const glm::dvec2 at(chance.between(2, heights.cols() - 3),
                            chance.between(2, heights.rows() - 3));
        const glm::dvec3 eye = land.at(at) + glm::dvec3(0, 0, chance.between(1.0, 60.0));
        auto horizon = horizon_of(land, {eye, 0.1, 1e-3});
        for (int j = 0; horizon && j < 40; ++j) {
            const glm::ivec2 first(chance.whole(0, heights.cols() - block - 1),
                                   chance.whole(0, heights.rows() - block - 1));
            if (!horizon->hides(block_of(land, first, block))) {
                ++count.shown;
                continue;
            }
            ++count.hidden;
            for (int k = 0; k < 30; ++k) {
                const glm::dvec3 place =
                    land.at(glm::dvec2(first) +
                            glm::dvec2(chance.between(0, block), chance.between(0, block)));
                const auto hit = caster.first_hit({eye, place - eye});
                EXPECT_TRUE(hit && hit->t < 1.0 - 1e-9) << land.name << ' ' << i;
            }
        }
    }
    return count;
}

TEST(Horizon, NothingThatItHidesIsMetFirstByAnyRay) {
    const Landscape waves("waves",
                          test::plane_heightfield(wave_crests(513, 60.0, 9.0), {5.0, 7.0}));
    const Landscape steep("steep", test::plane_heightfield(wave_crests(300, 20.0, 30.0)), 4.0);
    const Landscape rough(
        "rough", test::plane_heightfield(test::random_heights(200, 333, 0, 40, 2), {9.0, 9.0}));
    int hidden = 0;
    for (const Landscape* land : {&waves, &steep, &rough}) {
        const Count count = count_hidden(*land, 60, 5);
        EXPECT_GT(count.shown, 0) << land->name;
        hidden += count.hidden;
    }
    EXPECT_GT(hidden, 300);
}

TEST(Horizon, AWallHidesWhatIsBehindItAndNotWhatIsBesideItOrAbove) {
    const Landscape land(
        "wall", test::plane_heightfield(test::made_heights(257, 257, [](int col, int /*row*/) {
            return col >= 140 && col < 150 ? 50.0 : 0.0;
        })));
    auto horizon = horizon_of(land, {land.at({128.0, 128.0}) + glm::dvec3(0, 0, 5), 0.1, 1e-3});
    ASSERT_TRUE(horizon);
    EXPECT_TRUE(horizon->hides(block_of(land, {200, 120}, 16)));
    EXPECT_FALSE(horizon->hides(block_of(land, {40, 120}, 16)));
    EXPECT_FALSE(horizon->hides(block_of(land, {141, 120}, 5)));
    Box tower = block_of(land, {200, 120}, 16);
    tower.high.z = 500.0;
    EXPECT_FALSE(horizon->hides(tower));
    tower.low.x = -1e3; // holds the eye
    EXPECT_FALSE(horizon->hides(tower));
}

TEST(Horizon, LevelGroundHidesNothing) {
    const Landscape land("level", test::plane_heightfield(Grid<float>(200, 200, 3.0F)));
    auto horizon = horizon_of(land, {land.at({100.0, 100.0}) + glm::dvec3(0, 0, 2), 0.1, 1e-3});
    ASSERT_TRUE(horizon);
    EXPECT_FALSE(horizon->hides(block_of(land, {150, 100}, 16)));
}

TEST(Horizon, NothingIsSaidFromBelowFromBesideFromTooCloseOrOnTheEarth) {
    const Landscape land("hill", test::plane_heightfield(wave_crests(65, 10.0, 9.0)));
    const glm::dvec3 ground = land.at({32.0, 32.0});
    EXPECT_TRUE(horizon_of(land, {ground + glm::dvec3(0, 0, 20), 0.1, 0.0}));
    EXPECT_FALSE(horizon_of(land, {ground - glm::dvec3(0, 0, 20), 0.1, 0.0}));
    EXPECT_FALSE(horizon_of(land, {ground + glm::dvec3(200, 0, 20), 0.1, 0.0}));
    EXPECT_FALSE(horizon_of(land, {ground + glm::dvec3(0, 0, 20), 25.0, 0.0}));
    const Landscape earth(
        "Earth", test::geographic_heightfield(wave_crests(65, 10.0, 9.0), 46.0, 7.0, 0.001));
    EXPECT_FALSE(horizon_of(earth, {earth.at({32.0, 32.0}) + glm::dvec3(0, 0, 20), 0.1, 0.0}));
}

} // namespace
} // namespace reljef::terrain
