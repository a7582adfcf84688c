#include "engine/cast/earth_map.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::cast {
namespace {

struct MadeGlobe {
    terrain::Heightfield heightfield;
    terrain::Placement placement;
    geo::WrappedRows rows;
    Box samples; // all of it

    explicit MadeGlobe(double north, double south)
        : heightfield(test::closed_globe(180, north, south, 31)),
          placement(test::placed(heightfield)), rows(heightfield.georeference->geodetic.rows()) {
        samples.add(glm::dvec3(0.0, rows.even_row(0.0), -500.0));
        samples.add(glm::dvec3(heightfield.heights.cols() - 1.0,
                               rows.even_row(heightfield.heights.rows() - 1.0), 8000.0));
    }
    [[nodiscard]] EarthMap map() const { return {placement, rows, samples}; }
};

glm::dvec3 random_sample(test::Chance& chance, const Box& box) {
    return {chance.between(box.low.x, box.high.x), chance.between(box.low.y, box.high.y),
            chance.between(box.low.z, box.high.z)};
}

TEST(EarthMap, RowsAreEvenUpToThePoles) {
    const MadeGlobe globe(0.5, 0.3);
    const EarthMap map = globe.map();
    test::Chance chance(32);
    const double first = globe.placement.geodetic_from_world(map.world({3.0, 10.0, 0.0}))->latitude;
    const double a_row =
        globe.placement.geodetic_from_world(map.world({3.0, 11.0, 0.0}))->latitude - first;
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 sample = random_sample(chance, globe.samples);
        const glm::dvec3 world = map.world(sample);
        EXPECT_NEAR(globe.placement.geodetic_from_world(world)->latitude,
                    first + a_row * (sample.y - 10.0), 1e-7);
        EXPECT_NEAR(map.sample(world)->y, sample.y, 1e-6);
    }
}

// No two places are farther apart than a column and a row are wide there.
TEST(EarthMap, NoSampleIsLargerThanItsMetres) {
    const MadeGlobe globe(0.5, 0.5);
    const EarthMap map = globe.map();
    test::Chance chance(33);
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec3 from = random_sample(chance, globe.samples);
        glm::dvec3 to =
            from + glm::dvec3(chance.between(-0.2, 0.2), chance.between(-0.2, 0.2), 0.0);
        to.y = std::clamp(to.y, globe.samples.low.y, globe.samples.high.y);
        const glm::dvec3 metres =
            map.metres_a_sample({std::min(from.y, to.y), std::max(from.y, to.y)});
        EXPECT_LE(glm::distance(map.world(from), map.world(to)),
                  1.0001 * glm::length((to - from) * metres))
            << from.y;
    }
}

TEST(EarthMap, ColumnsAreNarrowAtThePoles) {
    const MadeGlobe globe(0.5, 0.5);
    const EarthMap map = globe.map();
    const double at_pole = globe.samples.low.y;
    EXPECT_LT(map.metres_a_sample({at_pole, at_pole}).x, 1.0);
    EXPECT_GT(map.metres_a_sample({at_pole, globe.samples.high.y}).x, 1e5);
    EXPECT_NEAR(map.columns_around(), *globe.placement.columns_all_around(), 1e-6);
    EXPECT_NEAR(map.rows_between_poles().begin, at_pole + 1.0, 1e-6);
    EXPECT_NEAR(map.rows_between_poles().end, globe.samples.high.y - 1.0, 1e-6);
}

// A turned raster: its columns are no meridians.
TEST(EarthMap, ElsewhereAllSamplesCountAsTheLargest) {
    terrain::Heightfield turned =
        test::geographic_heightfield(test::random_heights(40, 40, 0.0F, 10.0F, 34), 60.0, 5.0, 0.1);
    Grid<glm::dvec2> control(4, 4);
    for (int row = 0; row < 4; ++row) {
        for (int col = 0; col < 4; ++col) {
            control(col, row) = {60.0 - 1.3 * row - 0.4 * col, 5.0 + 1.3 * col - 0.4 * row};
        }
    }
    turned.georeference->geodetic = geo::GeodeticMap(control, {0.0, 0.0}, {13.0, 13.0});
    Box samples;
    samples.add(glm::dvec3(0.0));
    samples.add(glm::dvec3(39.0, 39.0, 10.0));
    const EarthMap map(test::placed(turned), {}, samples);
    EXPECT_EQ(map.columns_around(), 0.0);
    EXPECT_EQ(map.metres_a_sample({1.0, 2.0}), map.metres_a_sample({30.0, 31.0}));
}

} // namespace
} // namespace reljef::cast
