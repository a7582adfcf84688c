#include "engine/geo/georeference.h"

#include <fstream>
#include <random>
#include <sstream>
#include <vector>

#include <GeographicLib/Geocentric.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/test_data.h"

namespace reljef::geo {
namespace {

constexpr double wgs84_a = 6378137.0;
constexpr double wgs84_b = 6356752.314245179;

double turn_between(double a, double b) {
    return std::abs(std::remainder(a - b, 360.0));
}

TEST(Georeference, AffineTakesPixelsToTheCrs) {
    const PixelAffine affine{100.0, 2.0, 0.5, 200.0, -0.25, -3.0};
    const glm::dvec2 point = affine.crs_from_pixel({10.0, 4.0});
    EXPECT_DOUBLE_EQ(point.x, 122.0);
    EXPECT_DOUBLE_EQ(point.y, 185.5);
}

TEST(Georeference, DistancesAgreeWithGeodTest) {
    const std::string file = "geodesy/geographiclib/GeodTest-100.dat";
    RELJEF_NEED_DATA(file);
    std::ifstream stream(test::data_path(file));
    int lines = 0;
    double lat1 = 0.0;
    double lon1 = 0.0;
    double azi1 = 0.0;
    double lat2 = 0.0;
    double lon2 = 0.0;
    double azi2 = 0.0;
    double s12 = 0.0;
    std::string rest;
    while (stream >> lat1 >> lon1 >> azi1 >> lat2 >> lon2 >> azi2 >> s12 &&
           std::getline(stream, rest)) {
        EXPECT_NEAR(geodesic_distance({lat1, lon1, 0.0}, {lat2, lon2, 0.0}), s12, 1e-6)
            << "line " << lines + 1;
        ++lines;
    }
    EXPECT_EQ(lines, 100);
}

TEST(Georeference, DistanceDoesNotLookAtHeights) {
    EXPECT_EQ(geodesic_distance({45.0, 6.0, 0.0}, {45.5, 6.5, 0.0}),
              geodesic_distance({45.0, 6.0, 4000.0}, {45.5, 6.5, -100.0}));
}

TEST(Georeference, MetresPerDegreeAreTheGeodesicOnesOfAShortStep) {
    constexpr double step = 1e-3;
    for (int half_degrees = -178; half_degrees <= 178; ++half_degrees) {
        const double latitude = 0.5 * half_degrees;
        const glm::dvec2 metres = metres_per_degree(latitude);
        const double north =
            geodesic_distance({latitude - step / 2, 20.0, 0.0}, {latitude + step / 2, 20.0, 0.0});
        const double east = geodesic_distance({latitude, 20.0, 0.0}, {latitude, 20.0 + step, 0.0});
        EXPECT_NEAR(metres.y * step, north, 1e-7) << latitude;
        EXPECT_NEAR(metres.x * step, east, 1e-7) << latitude;
    }
}

TEST(Georeference, MetresPerDegreeAtEquatorAndPole) {
    const double degree = std::acos(-1.0) / 180.0;
    EXPECT_NEAR(metres_per_degree(0.0).x, wgs84_a * degree, 1e-8);
    EXPECT_NEAR(metres_per_degree(0.0).y, wgs84_b * wgs84_b / wgs84_a * degree, 1e-8);
    EXPECT_NEAR(metres_per_degree(90.0).x, 0.0, 1e-8);
    EXPECT_NEAR(metres_per_degree(90.0).y, wgs84_a * wgs84_a / wgs84_b * degree, 1e-8);
}

TEST(LocalFrame, OriginIsZeroAndAxesAreEastNorthUp) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> latitudes(-89.9, 89.9);
    std::uniform_real_distribution<double> longitudes(-180.0, 180.0);
    for (int i = 0; i < 1000; ++i) {
        const Geodetic origin{latitudes(random), longitudes(random), 100.0 * i};
        const LocalFrame frame(origin);
        EXPECT_LT(glm::length(frame.local_from_geodetic(origin)), 1e-8);
        const glm::dvec3 up =
            frame.local_from_geodetic({origin.latitude, origin.longitude, origin.height + 1000.0});
        EXPECT_LT(glm::distance(up, glm::dvec3(0.0, 0.0, 1000.0)), 1e-8);
        constexpr double step = 1e-5; // degrees, about a metre
        const glm::dvec3 east =
            frame.local_from_geodetic({origin.latitude, origin.longitude + step, origin.height});
        const glm::dvec3 north =
            frame.local_from_geodetic({origin.latitude + step, origin.longitude, origin.height});
        EXPECT_GT(east.x, 0.0);
        EXPECT_LT(std::abs(east.y), 1e-5 * east.x + 1e-8);
        EXPECT_GT(north.y, 1.0);
        EXPECT_LT(std::abs(north.x), 1e-6);
        EXPECT_LT(std::abs(north.z), 1e-5);
    }
}

TEST(LocalFrame, NearPositionsComeBackWithinTheirDigits) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> latitudes(-90.0, 90.0);
    std::uniform_real_distribution<double> longitudes(-180.0, 180.0);
    std::uniform_real_distribution<double> offsets(-5000.0, 5000.0);
    double worst = 0.0;
    for (int i = 0; i < 20000; ++i) {
        const LocalFrame frame({latitudes(random), longitudes(random), offsets(random)});
        const glm::dvec3 local(offsets(random), offsets(random), offsets(random));
        const glm::dvec3 again = frame.local_from_geodetic(frame.geodetic_from_local(local));
        worst = std::max(worst, glm::distance(local, again));
    }
    EXPECT_LT(worst, 1e-8);
}

TEST(LocalFrame, FarPositionsComeBackWithinAMicrometre) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> latitudes(-89.0, 89.0);
    std::uniform_real_distribution<double> longitudes(-180.0, 180.0);
    std::uniform_real_distribution<double> heights(-10000.0, 1e6);
    const LocalFrame frame({46.0, 6.0, 0.0});
    for (int i = 0; i < 20000; ++i) {
        const Geodetic position{latitudes(random), longitudes(random), heights(random)};
        const Geodetic again = frame.geodetic_from_local(frame.local_from_geodetic(position));
        EXPECT_NEAR(again.latitude, position.latitude, 1e-11);
        EXPECT_LT(turn_between(again.longitude, position.longitude),
                  1e-11 / std::cos(position.latitude / 57.3));
        EXPECT_NEAR(again.height, position.height, 1e-6);
    }
}

TEST(LocalFrame, ChordsAgreeWithTheEllipsoidsOwnRadii) {
    const LocalFrame frame({0.0, 0.0, 0.0});
    const glm::dvec3 pole = frame.local_from_geodetic({90.0, 0.0, 0.0});
    EXPECT_LT(glm::distance(pole, glm::dvec3(0.0, wgs84_b, -wgs84_a)), 1e-8);
    const glm::dvec3 quarter = frame.local_from_geodetic({0.0, 90.0, 0.0});
    EXPECT_LT(glm::distance(quarter, glm::dvec3(wgs84_a, 0.0, -wgs84_a)), 1e-8);
}

TEST(LocalFrame, ThePolesAndTheAntimeridianAreNoSpecialPlaces) {
    for (const Geodetic origin : {Geodetic{90.0, 0.0, 0.0}, Geodetic{-90.0, 30.0, 0.0},
                                  Geodetic{-16.5, 180.0, 0.0}, Geodetic{-16.5, -180.0, 0.0}}) {
        const LocalFrame frame(origin);
        std::mt19937 random(4);
        std::uniform_real_distribution<double> offsets(-2000.0, 2000.0);
        for (int i = 0; i < 1000; ++i) {
            const glm::dvec3 local(offsets(random), offsets(random), offsets(random));
            const glm::dvec3 again = frame.local_from_geodetic(frame.geodetic_from_local(local));
            ASSERT_LT(glm::distance(local, again), 1e-8);
        }
    }
}

TEST(LocalFrame, DirectionsKeepTheirAnglesAndTheNormalIsUp) {
    const LocalFrame frame({-33.9, 151.2, 12.0});
    const glm::dvec3 up = frame.local_direction(normal_from_geodetic(-33.9, 151.2));
    EXPECT_LT(glm::distance(up, glm::dvec3(0.0, 0.0, 1.0)), 1e-15);
    const glm::dvec3 other = normal_from_geodetic(12.0, -70.0);
    EXPECT_NEAR(glm::length(frame.local_direction(other)), 1.0, 1e-15);
    EXPECT_NEAR(frame.local_direction(other).z, glm::dot(other, normal_from_geodetic(-33.9, 151.2)),
                1e-15);
}

TEST(LocalFrame, NorthAndUpAreThoseOfGeographicLibsOwnFrame) {
    for (const double latitude : {-90.0, -33.9, 0.0, 45.8, 89.9, 90.0}) {
        for (const double longitude : {-180.0, -71.0, 0.0, 6.9, 151.2}) {
            std::vector<double> axes(9); // x, y, z of east, north and up, in three rows
            glm::dvec3 ignored;
            const GeographicLib::Geocentric& earth = GeographicLib::Geocentric::WGS84();
            earth.Forward(latitude, longitude, 0.0, ignored.x, ignored.y, ignored.z, axes);
            const glm::dvec3 north(axes[1], axes[4], axes[7]);
            const glm::dvec3 up(axes[2], axes[5], axes[8]);
            EXPECT_LT(glm::distance(north_from_geodetic(latitude, longitude), north), 1e-15);
            EXPECT_LT(glm::distance(normal_from_geodetic(latitude, longitude), up), 1e-15);
        }
    }
}

} // namespace
} // namespace reljef::geo
