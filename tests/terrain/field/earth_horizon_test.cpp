#include "engine/terrain/field/earth_horizon.h"

#include <cmath>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "engine/terrain/field/surface_caster.h"
#include "tests/support/release_only.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/landscape.h"

namespace reljef::terrain {
namespace {

using test::Landscape;

std::optional<EarthHorizon> earth_horizon_of(const Landscape& ground, const HorizonView& view) {
    const double exaggeration = ground.placement.exaggeration();
    const HeightRange drawn{exaggeration * ground.heightfield.range.low,
                            exaggeration * ground.heightfield.range.high};
    return EarthHorizon::create(ground.placement, ground.samples(), drawn, 0.0, view);
}

struct Seen {
    int hidden = 0;
    int shown = 0;
    int blind = 0; // views without a horizon
};

glm::dvec2 any_sample(test::Chance& chance, glm::ivec2 samples, glm::ivec2 margin) {
    return {chance.between(margin.x, samples.x - 1.0 - margin.x),
            chance.between(margin.y, samples.y - 1.0 - margin.y)};
}

// Each cell that is said to be hidden is looked for at random places: the exact ray to each must
// meet other ground before.
Seen look_around(const Landscape& ground, int views, glm::ivec2 margin, unsigned seed) {
    test::Chance chance(seed);
    const SurfaceCaster caster(ground.heightfield.heights.view(), ground.pyramid, ground.placement);
    Seen seen;
    for (int i = 0; i < views; ++i) {
        const double above = 2e4 * std::pow(2e3, chance.between(0.0, 1.0));
        const glm::dvec3 eye = ground.at(any_sample(chance, ground.samples(), margin), above);
        const auto horizon = earth_horizon_of(ground, {eye, 0.1, 1e-3});
        seen.blind += horizon ? 0 : 1;
        for (int j = 0; horizon && j < 60; ++j) {
            const glm::dvec2 cell = glm::floor(any_sample(chance, ground.samples(), {1, 1}));
            Box box;
            for (int k = 0; k < 20; ++k) {
                box.add(ground.at(cell + glm::dvec2(chance.between(0, 1), chance.between(0, 1))));
            }
            if (!horizon->hides(box)) {
                ++seen.shown;
                continue;
            }
            ++seen.hidden;
            for (int k = 0; k < 5; ++k) {
                const glm::dvec3 place(chance.between(box.low.x, box.high.x),
                                       chance.between(box.low.y, box.high.y),
                                       chance.between(box.low.z, box.high.z));
                const auto hit = caster.first_hit({eye, place - eye});
                EXPECT_TRUE(hit && hit->t < 1.0) << ground.name << ' ' << i << ' ' << j;
            }
        }
    }
    return seen;
}

TEST(EarthHorizon, NothingThatItHidesIsMetFirstByAnyRay) {
    const Landscape globe("globe", test::closed_globe(90, 0.5, 0.5, 1));
    const Landscape high("exaggerated globe", test::closed_globe(60, 1.0, 1.0, 2), 20.0);
    for (const Landscape* ground : {&globe, &high}) {
        const Seen seen = look_around(*ground, test::rounds(30, 10), {1, 1}, 3);
        EXPECT_GT(seen.hidden, test::rounds(200, 60)) << ground->name;
        EXPECT_GT(seen.shown, test::rounds(200, 60)) << ground->name;
    }
}

// Where the eye sees past the terrain's end, rays beneath it meet nothing.
TEST(EarthHorizon, HidesNothingWhereTheTerrainEndsBeforeIt) {
    const Landscape part("part of the Earth",
                         test::geographic_heightfield(
                             test::random_heights(161, 161, 0.0F, 5000.0F, 4), 40.0, -30.0, 0.5));
    const Seen seen = look_around(part, 100, {0, 0}, 5);
    EXPECT_GT(seen.blind, 30);
    EXPECT_GT(seen.hidden, 30);
    Heightfield belt = test::geographic_heightfield(test::random_heights(361, 81, 0.0F, 5000.0F, 6),
                                                    40.0, -180.0, 1.0);
    belt.georeference->geodetic = belt.georeference->geodetic.closed({.around = true}, 361, 81);
    const Landscape without_poles("belt", std::move(belt));
    const Seen around = look_around(without_poles, 100, {0, 0}, 7);
    EXPECT_GT(around.blind, 30);
    EXPECT_GT(around.hidden, 30);
}

TEST(EarthHorizon, SaysNothingOnAPlaneFromBelowOrFromInside) {
    const Landscape plane("plane", test::plane_heightfield(Grid<float>(9, 9, 0.0F), {1e5, 1e5}));
    EXPECT_FALSE(earth_horizon_of(plane, {plane.at({4.0, 4.0}, 1e4), 0.1, 0.0}));
    const Landscape globe("globe", test::closed_globe(30, 0.5, 0.5, 1));
    EXPECT_TRUE(earth_horizon_of(globe, {globe.at({20.0, 9.0}, 2e4), 0.1, 0.0}));
    EXPECT_FALSE(earth_horizon_of(globe, {globe.at({20.0, 9.0}, 2e4), 1e6, 0.0}));
    EXPECT_FALSE(earth_horizon_of(globe, {globe.at({20.0, 9.0}, -2e4), 0.1, 0.0}));
    EXPECT_FALSE(earth_horizon_of(globe, {globe.at({20.0, 9.0}, 2e4), 0.1, 2.0}));
}

} // namespace
} // namespace reljef::terrain
