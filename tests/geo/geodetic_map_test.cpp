#include <functional>
#include <random>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "engine/geo/georeference.h"

namespace reljef::geo {
namespace {

using Exact = std::function<glm::dvec2(glm::dvec2 sample)>;

constexpr glm::dvec2 first(-3.0, 5.0);
constexpr glm::dvec2 step(10.0, 20.0);

Grid<glm::dvec2> controls(const Exact& exact, int cols, int rows) {
    Grid<glm::dvec2> grid(cols, rows);
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            grid(col, row) = exact(first + step * glm::dvec2(col, row));
        }
    }
    return grid;
}

/// A polar stereographic grid of a sphere, 1 km samples, the pole at its middle.
glm::dvec2 polar(glm::dvec2 sample) {
    const glm::dvec2 offset = (sample - glm::dvec2(92.0, 195.0)) * 1000.0;
    const double colatitude = 2.0 * std::atan(glm::length(offset) / (2.0 * 6371000.0));
    return {90.0 - glm::degrees(colatitude), glm::degrees(std::atan2(offset.x, offset.y))};
}

GeodeticMap polar_map() {
    const Grid<glm::dvec2> positions = controls(polar, 20, 20);
    Grid<glm::dvec3> normals(20, 20);
    for (int row = 0; row < 20; ++row) {
        for (int col = 0; col < 20; ++col) {
            normals(col, row) = normal_from_geodetic(positions(col, row).x, positions(col, row).y);
        }
    }
    return {normals, first, step};
}

TEST(GeodeticMap, CubicsAreExactInsideAndBeyondTheControlPoints) {
    const Exact cubic = [](glm::dvec2 s) {
        const double u = s.x / 100.0;
        const double v = s.y / 100.0;
        return glm::dvec2(10.0 + u - 0.5 * v + u * u * v - 0.2 * u * u * u + 0.1 * v * v * v,
                          20.0 + 2.0 * v + 0.3 * u * v * v * v);
    };
    const GeodeticMap map(controls(cubic, 7, 5), first, step);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> places(-60.0, 160.0);
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec2 sample(places(random), places(random));
        ASSERT_LT(glm::distance(map.latitude_longitude(sample), cubic(sample)), 1e-10);
    }
}

TEST(GeodeticMap, ControlPointsThemselvesAreKept) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> values(-1.0, 1.0);
    const Exact rough = [&](glm::dvec2) { return glm::dvec2(values(random), values(random)); };
    const Grid<glm::dvec2> grid = controls(rough, 6, 9);
    const GeodeticMap map(grid, first, step);
    for (int row = 0; row < grid.rows(); ++row) {
        for (int col = 0; col < grid.cols(); ++col) {
            ASSERT_LT(glm::distance(map.latitude_longitude(first + step * glm::dvec2(col, row)),
                                    grid(col, row)),
                      1e-14);
        }
    }
}

TEST(GeodeticMap, SamplesComeBack) {
    const Exact bent = [](glm::dvec2 s) {
        return glm::dvec2(46.0 - s.y * 8e-4 + 1e-7 * s.x * s.x,
                          -122.0 + s.x * 9e-4 + 1e-7 * s.x * s.y);
    };
    const GeodeticMap map(controls(bent, 9, 9), first, step);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> places(-20.0, 180.0);
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec2 sample(places(random), places(random));
        const glm::dvec2 position = map.latitude_longitude(sample);
        const auto again = map.sample(position.x, position.y + 360.0 * (i % 5 - 2));
        ASSERT_TRUE(again);
        ASSERT_LT(glm::distance(*again, sample), 1e-8);
    }
}

TEST(GeodeticMap, AcrossTheAntimeridianLongitudesRunOn) {
    const Exact fiji = [](glm::dvec2 s) {
        return glm::dvec2(-16.0 - s.y * 0.001, 179.95 + s.x * 0.001);
    };
    const GeodeticMap map(controls(fiji, 12, 4), first, step);
    for (const double longitude : {179.99, 180.01, -179.99, -180.01, 540.01}) {
        const auto sample = map.sample(-16.02, longitude);
        ASSERT_TRUE(sample);
        const double east = std::remainder(longitude - 179.95, 360.0);
        EXPECT_NEAR(sample->x, east / 0.001, 1e-6) << longitude;
        EXPECT_NEAR(sample->y, 20.0, 1e-6);
    }
}

TEST(GeodeticMap, NormalsCarryAcrossThePole) {
    const GeodeticMap map = polar_map();
    EXPECT_NEAR(map.latitude_longitude({92.0, 195.0}).x, 90.0, 1e-7);
    std::mt19937 random(8);
    std::uniform_real_distribution<double> cols(first.x, first.x + 19 * step.x);
    std::uniform_real_distribution<double> rows(first.y, first.y + 19 * step.y);
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec2 sample(cols(random), rows(random));
        const glm::dvec2 found = map.latitude_longitude(sample);
        const glm::dvec2 exact = polar(sample);
        ASSERT_LT(6.4e6 * glm::distance(normal_from_geodetic(found.x, found.y),
                                        normal_from_geodetic(exact.x, exact.y)),
                  1e-3); // metres; the control points are 20 km apart
        const auto again = map.sample(found.x, found.y);
        ASSERT_TRUE(again);
        ASSERT_LT(glm::distance(*again, sample), 1e-7);
    }
}

TEST(GeodeticMap, TheOtherSideOfTheEarthIsNoSample) {
    EXPECT_FALSE(polar_map().sample(-90.0, 0.0));
}

TEST(GeodeticMap, NoPositionIsAnError) {
    const GeodeticMap map(controls([](glm::dvec2 s) { return s * 1e-3; }, 4, 4), first, step);
    EXPECT_TRUE(map.sample(0.01, 0.01));
    EXPECT_FALSE(map.sample(90.1, 0.0));
    EXPECT_FALSE(map.sample(std::nan(""), 0.0));
    EXPECT_FALSE(map.sample(0.0, std::numeric_limits<double>::infinity()));
}

TEST(GeodeticMap, AFlatMapHasNoWayBackAndSaysSo) {
    const GeodeticMap map(controls([](glm::dvec2) { return glm::dvec2(1.0, 2.0); }, 4, 4), first,
                          step);
    EXPECT_FALSE(map.sample(10.0, 20.0));
}

// One in degrees is inverted at once, unless it bends by what Newton's method would notice.
TEST(GeodeticMap, InDegreesFindsItsSamplesAndThoseBesideIt) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> places(-60.0, 160.0);
    for (const double bend : {0.0, 1e-13, 1e-9, 1e-5}) {
        const Exact degrees = [&](glm::dvec2 s) {
            return glm::dvec2(47.0 - 0.01 * s.y + bend * s.x * s.y,
                              7.0 + 0.02 * s.x + 0.001 * s.y - bend * s.y * s.y);
        };
        const GeodeticMap map(controls(degrees, 7, 5), first, step);
        for (int i = 0; i < 1000; ++i) {
            const glm::dvec2 sample(places(random), places(random));
            const glm::dvec2 place = degrees(sample);
            const auto found = map.sample(place.x, place.y + 360.0 * (i % 3 - 1));
            ASSERT_TRUE(found);
            // 1e-9 at the control points; what bends unseen grows with the square of the distance.
            ASSERT_LT(glm::distance(*found, sample), 1e-7) << bend;
        }
    }
}

TEST(GeodeticMap, OfAWholeGlobeEndsAtThePoles) {
    Grid<glm::dvec2> degrees(9, 9);
    for (int row = 0; row < 9; ++row) {
        for (int col = 0; col < 9; ++col) {
            degrees(col, row) = {80.0 - 20.0 * row, -170.0 + 42.5 * col};
        }
    }
    // 35×17 samples 10° apart, 36 and 18 with what closes them.
    const GeodeticMap source(degrees, glm::dvec2(0.0), {4.25, 2.0});
    GlobalWrap wrap{.around = true, .east = true, .north = 1.0, .south = 1.0};
    const GeodeticMap whole = source.closed(wrap, 35, 17);
    EXPECT_NEAR(whole.latitude_longitude({3.0, 0.0}).x, 90.0, 1e-12);
    EXPECT_NEAR(whole.latitude_longitude({3.0, 18.0}).x, -90.0, 1e-12);
    EXPECT_EQ(whole.latitude_longitude({3.0, 5.0}), source.latitude_longitude({3.0, 4.0}));
    EXPECT_LE(whole.latitude_longitude({3.0, -1.0}).x, 90.0);
    const WrappedRows rows({.north = 0.25, .south = 0.5}, 17);
    EXPECT_EQ(rows.source_row(0.0), -0.25);
    EXPECT_EQ(rows.source_row(1.0), 0.0);
    EXPECT_EQ(rows.source_row(18.0), 16.5);
    for (double row = -0.5; row < 18.6; row += 0.125) {
        EXPECT_DOUBLE_EQ(rows.closed_row(rows.source_row(row)), row);
    }
}

} // namespace
} // namespace reljef::geo
