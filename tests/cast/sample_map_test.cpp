#include "engine/cast/sample_map.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::cast {
namespace {

constexpr int side = 601; // samples

// A degree and a half around 45.2 N; with a geoid as rough as that over mountains.
terrain::Heightfield made_terrain(bool has_geoid) {
    terrain::Heightfield heightfield = test::geographic_heightfield(
        test::made_heights(side, side, [](int col, int /*row*/) { return 5.0 * (col % 400); }),
        46.0, 6.0, 0.0025);
    if (has_geoid) {
        Grid<float> undulation = test::made_heights(30, 30, [](int col, int row) {
            return 50.0 + 0.7 * col + 0.5 * std::sin(1.3 * col + 0.4 * row) * std::cos(0.9 * row);
        });
        heightfield.georeference->geoid =
            geo::Geoid("made", std::move(undulation), {42.0, 4.0}, {0.25, 0.25});
    }
    return heightfield;
}

// In pixels of a thousandth of the distance, of places that an eye sees.
double largest_error(bool has_geoid, glm::dvec3 eye_sample) {
    const terrain::Placement placement = test::placed(made_terrain(has_geoid));
    SampleMap::Ground ground;
    ground.samples.add(glm::dvec3(0.0, 0.0, 0.0));
    ground.samples.add(glm::dvec3(side - 1.0, side - 1.0, 2000.0));
    test::Chance chance(61);
    const auto on_ground = [&] {
        return placement.world_from_sample({chance.between(0.0, side - 1.0),
                                            chance.between(0.0, side - 1.0),
                                            chance.between(0.0, 2000.0)});
    };
    for (int i = 0; i < 200; ++i) {
        ground.local.add(on_ground());
    }
    ground.above = 100.0;
    ground.eye = placement.world_from_sample(eye_sample);
    constexpr double pixel = 1e-3; // radians
    constexpr double share = 1e-3; // of a pixel
    const SampleMap map(EarthMap(placement, {}, ground.samples), ground, {0.0, share * pixel}, 0);
    double largest = 0.0;
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 far = on_ground();
        const glm::dvec3 place =
            glm::mix(ground.eye, far, std::exp(chance.between(std::log(1e-4), 0.0)));
        const double distance = glm::distance(place, ground.eye);
        const auto found = map.at(place, share * pixel * distance);
        if (!found) {
            return 1.0;
        }
        largest = std::max(largest, glm::distance(placement.world_from_sample(*found), place) /
                                        (pixel * distance));
    }
    return largest;
}

TEST(SampleMap, IsAsPreciseAsPixelsNeed) {
    for (const bool has_geoid : {false, true}) {
        for (const double above : {0.3, 300.0, 2e4}) {
            // The polynomial and the geoid have a share each, and grow between the checked places.
            EXPECT_LT(largest_error(has_geoid, {310.0, 333.0, 2000.0 + above}), 4e-3)
                << has_geoid << ' ' << above;
        }
    }
}

} // namespace
} // namespace reljef::cast
