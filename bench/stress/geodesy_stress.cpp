// Positions and geodesics against published figures.
#include <array>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>

#include "bench/stress/stress_run.h"
#include "engine/geo/place.h"

namespace reljef::bench {
namespace {

constexpr double max_position_error = 1e-3; // metres
constexpr double max_geodesic_error = 1e-6; // metres

struct KnownGeodesic {
    geo::Geodetic from;
    double azimuth; ///< degrees
    geo::Geodetic to;
    double distance; ///< metres
};

// Lines of GeodTest.dat (Karney, "Test set for geodesics", 2010): short, along a meridian, nearly
// antipodal, from pole to pole.
constexpr std::array known_geodesics{
    KnownGeodesic{{18.725775553796, 0.0, 0.0},
                  98.927919777265,
                  {18.724785210853172866, 0.006615636046166963, 0.0},
                  706.2676803},
    KnownGeodesic{{60.077425015363, 0.0, 0.0},
                  81.639916890942,
                  {60.078197903525388982, 0.010531670881733178, 0.0},
                  592.5766309},
    KnownGeodesic{{22.367284344899, 0.0, 0.0},
                  179.996666424849,
                  {-36.938244357766476763, 0.003565430381119167, 0.0},
                  6564128.4134201},
    KnownGeodesic{{14.225351873668, 0.0, 0.0},
                  90.032623328236,
                  {-14.225351873709766362, 179.41491082111612486, 0.0},
                  19972345.2829332},
    KnownGeodesic{{0.001379365755, 0.0, 0.0},
                  89.998608137015,
                  {0.000753702665148418, 112.396451668205406084, 0.0},
                  12511915.7635091},
    KnownGeodesic{{89.997121349605, 0.0, 0.0},
                  66.596353832361,
                  {-89.989768047293380893, 128.36650593520996481, 0.0},
                  20002955.0741735},
};

double metres_between(const geo::Geodetic& a, const geo::Geodetic& b) {
    return glm::distance(geo::geocentric_from_geodetic(a), geo::geocentric_from_geodetic(b));
}

// EPSG Guidance Note 7-2, topocentric conversion.
double local_frame_error() {
    const geo::LocalFrame frame({55.0, 5.0, 200.0});
    const glm::dvec3 found = frame.local_from_geodetic({53.80939444444444, 2.12955, 73.0});
    return glm::distance(found, {-189013.869, -128642.040, -4220.171});
}

double round_trip_error(int count, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random()) /
                         static_cast<double>(std::mt19937::max());
    };
    double worst = 0.0;
    for (int i = 0; i < count; ++i) {
        const std::array latitudes{between(-90.0, 90.0), -90.0, 90.0, 0.0, 89.9999999};
        const std::array longitudes{between(-180.0, 180.0), 180.0, -180.0, 0.0};
        const geo::Geodetic position{latitudes[random() % latitudes.size()],
                                     longitudes[random() % longitudes.size()], between(-6e6, 1e7)};
        const glm::dvec3 geocentric = geo::geocentric_from_geodetic(position);
        worst =
            std::max(worst, metres_between(geo::geodetic_from_geocentric(geocentric), position));
    }
    return worst;
}

} // namespace

Result<void> stress_geodesy(StressRun& run) {
    double distance_error = 0.0;
    double end_error = 0.0;
    for (const KnownGeodesic& known : known_geodesics) {
        distance_error =
            std::max(distance_error, std::abs(geo::geodesic_between(known.from, known.to).distance -
                                              known.distance));
        end_error = std::max(
            end_error,
            metres_between(geo::geodesic_end(known.from, known.azimuth, known.distance), known.to));
    }
    const auto add = [&](const char* figure, double value, double limit, const char* at) {
        run.add({.stress = "geodesy", .figure = figure, .value = value, .limit = limit, .at = at});
    };
    add("length of a geodesic, m off", distance_error, max_geodesic_error, "GeodTest");
    add("end of a geodesic, m off", end_error, max_geodesic_error, "GeodTest");
    add("local frame, m off", local_frame_error(), max_position_error, "EPSG 7-2");
    // GeographicLib's manual of GeoConvert.
    add("MGRS of a known place, wrong",
        geo::mgrs_text({33.3, 44.4, 0.0}) == "38SMB4414084706" ? 0.0 : 1.0, 0.0, "33.3N 44.4E");
    add("there and back to geocentric, m off",
        round_trip_error(run.cases(20'000, 1'000'000), run.options().seed), max_position_error,
        "any position, poles, antimeridian");
    return {};
}

} // namespace reljef::bench
