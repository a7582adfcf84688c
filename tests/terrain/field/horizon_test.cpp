#include "engine/terrain/field/horizon.h"

#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "engine/terrain/field/surface_caster.h"
#include "tests/support/release_only.h"
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
Count count_hidden(const Landscape& land, int views, unsigned seed, double max_above = 60.0) {
    constexpr int block = 16;
    test::Chance chance(seed);
    const GridView<const float> heights = land.heightfield.heights.view();
    const SurfaceCaster caster(heights, land.pyramid, land.placement);
    Count count;
    for (int i = 0; i < views; ++i) {
        const glm::dvec2 at(chance.between(2, heights.cols() - 3),
                            chance.between(2, heights.rows() - 3));
        const glm::dvec3 eye = land.at(at, chance.between(1.0, max_above));
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

TEST(Horizon, OnTheEarthNothingThatItHidesIsMetFirstByAnyRay) {
    const auto geographic = [](Grid<float> heights, double latitude, double step) {
        return test::geographic_heightfield(std::move(heights), latitude, 7.0, step);
    };
    const Landscape equator("equator", geographic(wave_crests(300, 900.0, 9.0), 0.1, 0.001));
    const Landscape alps("alps", geographic(wave_crests(300, 900.0, 5.0), 46.0, 0.0005), 2.0);
    const Landscape wide("wide", geographic(wave_crests(200, 4000.0, 4.0), 52.0, 0.02));
    const Landscape north("north", geographic(wave_crests(300, 1500.0, 9.0), 74.0, 0.004));
    const Landscape cliffs("cliffs", geographic(test::made_heights(300, 300,
                                                                   [](int col, int row) {
                                                                       return (col + row) % 50 < 20
                                                                                  ? 300.0
                                                                                  : 0.0;
                                                                   }),
                                                -33.0, 0.0002));
    const Landscape high_cells(
        "high cells",
        test::geographic_heightfield(wave_crests(300, 4000.0, 5.0), 77.0, 7.0, 0.002, 0.0, 12.0));
    const int views = test::rounds(30, 8);
    int hidden = 0;
    for (const Landscape* land : {&equator, &alps, &wide, &north, &cliffs, &high_cells}) {
        const Count low = count_hidden(*land, views, 6);
        const Count high = count_hidden(*land, views, 7, 3000.0);
        EXPECT_GT(low.shown + high.shown, 0) << land->name;
        EXPECT_GT(low.hidden + high.hidden, 0) << land->name;
        hidden += low.hidden + high.hidden;
    }
    EXPECT_GT(hidden, 30 * views);
    RecordProperty("hidden", hidden);
}

TEST(Horizon, OnTheEarthAboutAsMuchIsHiddenAsOnAPlane) {
    Grid<float> crests = wave_crests(300, 900.0, 9.0);
    const Landscape earth("earth", test::geographic_heightfield(crests, 46.0, 7.0, 0.0005));
    const Landscape plane("plane",
                          test::plane_heightfield(std::move(crests), earth.heightfield.spacing));
    const Count on_earth = count_hidden(earth, 60, 8);
    const Count on_plane = count_hidden(plane, 60, 8);
    EXPECT_GT(on_earth.hidden, 0.8 * on_plane.hidden); // with half as many sectors
    RecordProperty("earth", on_earth.hidden);
    RecordProperty("plane", on_plane.hidden);
}

// A crest of 500 m at 58 km is seen 0.0046 below the horizontal of an eye at its height. Behind it
// the ground is 1.1 km lower at 120 km: places there are seen from 0.002 below to 0.011 below.
TEST(Horizon, TheEarthLowersWhatHidesAndWhatIsHidden) {
    const Landscape land("crest", test::geographic_heightfield(
                                      test::made_heights(400, 200,
                                                         [](int col, int /*row*/) {
                                                             return col >= 160 && col < 220 ? 500.0
                                                                                            : 0.0;
                                                         }),
                                      46.0, 7.0, 0.005));
    auto horizon = horizon_of(land, {land.at({10.0, 100.0}, 500.0), 0.1, 1e-5});
    ASSERT_TRUE(horizon);
    Box low;
    Box high;
    for (const double row : {99.0, 101.0}) {
        for (const double col : {320.0, 322.0}) {
            low.add(land.at({col, row}, 300.0));
            high.add(land.at({col, row}, 1390.0));
        }
    }
    EXPECT_TRUE(horizon->hides(low));
    EXPECT_FALSE(horizon->hides(high));
}

TEST(Horizon, NearAPoleNothingIsSaid) {
    const Landscape pole(
        "pole", test::geographic_heightfield(wave_crests(65, 10.0, 9.0), 85.0, 7.0, 0.001));
    EXPECT_FALSE(horizon_of(pole, {pole.at({32.0, 32.0}, 20.0), 0.1, 0.0}));
}

TEST(Horizon, NothingIsSaidFromBelowFromBesideOrFromTooClose) {
    const Landscape land("hill", test::plane_heightfield(wave_crests(65, 10.0, 9.0)));
    const glm::dvec3 ground = land.at({32.0, 32.0});
    EXPECT_TRUE(horizon_of(land, {ground + glm::dvec3(0, 0, 20), 0.1, 0.0}));
    EXPECT_FALSE(horizon_of(land, {ground - glm::dvec3(0, 0, 20), 0.1, 0.0}));
    EXPECT_FALSE(horizon_of(land, {ground + glm::dvec3(200, 0, 20), 0.1, 0.0}));
    EXPECT_FALSE(horizon_of(land, {ground + glm::dvec3(0, 0, 20), 25.0, 0.0}));
}

TEST(EyeFrame, SamplesAlongALineOfAPlaneAreEvenlySpaced) {
    const Landscape land("plane", test::plane_heightfield(wave_crests(65, 10.0, 9.0), {30.0, 7.0}),
                         2.0);
    test::Chance chance(5);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 eye =
            land.at({chance.between(0.0, 64.0), chance.between(0.0, 64.0)}, 20.0);
        const auto frame = EyeFrame::create(land.placement, eye);
        const double azimuth = chance.between(-4.0, 4.0);
        const glm::dvec2 direction(std::cos(azimuth), std::sin(azimuth));
        const double along = std::pow(10.0, chance.between(0.0, 6.0));
        const auto step = frame->samples_a_metre(direction);
        ASSERT_TRUE(step);
        const glm::dvec2 expected = *frame->sample_at(direction, along);
        const glm::dvec2 found = *frame->sample_at(direction, 0.0) + along * *step;
        // Samples are rounded at 2^-52 of a million metres, seven or thirty to a sample.
        EXPECT_LT(glm::distance(expected, found), 1e-9) << along;
    }
}

TEST(EyeFrame, SamplesAlongALineOfTheEarthAreNot) {
    const Landscape land(
        "earth", test::geographic_heightfield(wave_crests(65, 10.0, 9.0), 46.0, 7.0, 0.001));
    const auto frame = EyeFrame::create(land.placement, land.at({32.0, 32.0}, 20.0));
    ASSERT_TRUE(frame);
    EXPECT_FALSE(frame->samples_a_metre({1.0, 0.0}));
}

} // namespace
} // namespace reljef::terrain
