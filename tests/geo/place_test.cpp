#include "engine/geo/place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/gie.h"
#include "tests/support/test_data.h"

namespace reljef::geo {
namespace {

using test::GiePoint;

constexpr double millimetre = 1e-3;
const char* const gie_folder = "geodesy/proj_gie/";

std::vector<GiePoint> gie_points(const std::string& file, const std::string& operation) {
    std::vector<GiePoint> points = test::read_gie(test::data_path(gie_folder + file));
    std::erase_if(points, [&](const GiePoint& point) { return point.operation != operation; });
    return points;
}

Geodetic anywhere(std::mt19937& random) {
    std::uniform_real_distribution<double> sines(-1.0, 1.0);
    std::uniform_real_distribution<double> longitudes(-180.0, 180.0);
    std::uniform_real_distribution<double> heights(-10e3, 1e6);
    return {std::asin(sines(random)) * 57.29577951308232, longitudes(random), heights(random)};
}

TEST(Place, GeocentricPositionsAreThoseOfProj) {
    RELJEF_NEED_DATA("geodesy/proj_gie/more_builtins.gie");
    const auto points = gie_points("more_builtins.gie", "+proj=cart +ellps=GRS80");
    ASSERT_GE(points.size(), 10U);
    for (const GiePoint& point : points) {
        const glm::dvec3 expected(point.output[0], point.output[1], point.output[2]);
        const glm::dvec3 found =
            geocentric_from_geodetic({point.input[1], point.input[0], point.input[2]});
        EXPECT_LT(glm::distance(found, expected), millimetre) << "line " << point.line;
    }
}

TEST(Place, LocalCoordinatesAreThoseOfProjsTopocentricExample) {
    // builtins.gie: +proj=topocentric +ellps=WGS84 +lon_0=5 +lat_0=55 +h_0=200, given to 1 mm.
    const LocalFrame frame({55.0, 5.0, 200.0});
    const glm::dvec3 found = frame.local_from_geodetic({53.80939444444444, 2.12955, 73.0});
    EXPECT_LT(glm::distance(found, {-189013.869, -128642.040, -4220.171}), millimetre);
}

TEST(Place, GeocentricAndBackIsTheSamePlace) {
    std::mt19937 random(5);
    for (int i = 0; i < 10000; ++i) {
        const Geodetic from = anywhere(random);
        const glm::dvec3 there = geocentric_from_geodetic(from);
        const glm::dvec3 again = geocentric_from_geodetic(geodetic_from_geocentric(there));
        ASSERT_LT(glm::distance(there, again), 1e-8); // 2^-27 of a metre: doubles at 7,000 km
    }
}

// GeographicLib's manual (GeoConvert): 33.3N 44.4E is 38SMB4414084706.
TEST(Place, ReadOutIsThatOfGeographicLibsManual) {
    const Geodetic baghdad{33.3, 44.4, 0.0};
    EXPECT_EQ(mgrs_text(baghdad), "38SMB4414084706");
    EXPECT_EQ(mgrs_text({90.0, 0.0, 0.0}, 2), "ZAH0000");
}

/// Geocentric in long double, by the ellipsoid's own formula.
std::array<long double, 3> oracle_geocentric(const Geodetic& position) {
    const long double degree = std::acos(-1.0L) / 180.0L;
    const long double flattening = 1.0L / 298.257223563L;
    const long double squared = flattening * (2.0L - flattening);
    const long double phi = position.latitude * degree;
    const long double lambda = position.longitude * degree;
    const long double normal =
        6378137.0L / std::sqrt(1.0L - squared * std::sin(phi) * std::sin(phi));
    const long double height = position.height;
    return {(normal + height) * std::cos(phi) * std::cos(lambda),
            (normal + height) * std::cos(phi) * std::sin(lambda),
            (normal * (1.0L - squared) + height) * std::sin(phi)};
}

// On a picture of 768 rows over 57.3° a metre away, 0.01 px are 14 µm. The scene's own part of
// that, positions in double around the terrain's middle, has to be far below.
TEST(Place, OffsetsBetweenNeighboursAreThoseOfLongDoublesAnywhere) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> near(-0.01, 0.01);
    double worst = 0.0;
    for (int i = 0; i < 20000; ++i) {
        Geodetic origin = anywhere(random);
        origin.latitude = i % 4 == 0 ? std::copysign(89.999, origin.latitude) : origin.latitude;
        origin.longitude = i % 3 == 0 ? 180.0 : origin.longitude;
        const LocalFrame frame(origin);
        const Geodetic eye{std::clamp(origin.latitude + near(random), -90.0, 90.0),
                           origin.longitude + near(random), origin.height + 1.0};
        const Geodetic vertex{std::clamp(eye.latitude + 1e-3 * near(random), -90.0, 90.0),
                              eye.longitude + 1e-3 * near(random), origin.height};
        const auto from = oracle_geocentric(eye);
        const auto to = oracle_geocentric(vertex);
        const glm::dvec3 expected = frame.local_direction({static_cast<double>(to[0] - from[0]),
                                                           static_cast<double>(to[1] - from[1]),
                                                           static_cast<double>(to[2] - from[2])});
        const glm::dvec3 found = frame.local_from_geodetic(vertex) - frame.local_from_geodetic(eye);
        worst = std::max(worst, glm::distance(found, expected));
    }
    EXPECT_LT(worst, 1e-8);
}

class GeodTest : public ::testing::Test {
protected:
    struct Line {
        Geodetic from;
        Geodetic to;
        Geodesic geodesic;
    };
    static std::vector<Line> lines() {
        std::ifstream stream(test::data_path("geodesy/geographiclib/GeodTest-100.dat"));
        std::vector<Line> lines;
        Line line;
        std::string rest;
        while (stream >> line.from.latitude >> line.from.longitude >> line.geodesic.azimuth_start >>
                   line.to.latitude >> line.to.longitude >> line.geodesic.azimuth_end >>
                   line.geodesic.distance &&
               std::getline(stream, rest)) {
            lines.push_back(line);
        }
        return lines;
    }
};

TEST_F(GeodTest, EndsLieWhereDistanceAndAzimuthLead) {
    RELJEF_NEED_DATA("geodesy/geographiclib/GeodTest-100.dat");
    const auto all = lines();
    ASSERT_EQ(all.size(), 100U);
    for (const Line& line : all) {
        const auto& [azimuth_start, azimuth_end] =
            std::pair(line.geodesic.azimuth_start, line.geodesic.azimuth_end);
        EXPECT_LT(geodesic_distance(geodesic_end(line.from, azimuth_start, line.geodesic.distance),
                                    line.to),
                  1e-6);
        EXPECT_LT(geodesic_distance(geodesic_end(line.to, azimuth_end, -line.geodesic.distance),
                                    line.from),
                  1e-6);
    }
}

TEST_F(GeodTest, DistancesAndAzimuthsBetweenTheEnds) {
    RELJEF_NEED_DATA("geodesy/geographiclib/GeodTest-100.dat");
    for (const Line& line : lines()) {
        const Geodesic found = geodesic_between(line.from, line.to);
        EXPECT_NEAR(found.distance, line.geodesic.distance, 1e-6);
        // The azimuth as what it is for: where one comes to who goes there by it.
        EXPECT_LT(geodesic_distance(geodesic_end(line.from, found.azimuth_start, found.distance),
                                    line.to),
                  1e-6);
    }
}

} // namespace
} // namespace reljef::geo
