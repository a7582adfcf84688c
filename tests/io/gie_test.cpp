// PROJ's own regression points through reljef's ways between coordinate systems and degrees, and
// through the place that it gives a raster.
#include <array>
#include <cmath>
#include <map>
#include <span>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include "engine/core/parallel_for.h"
#include "engine/geo/place.h"
#include "engine/io/raster/crs_transform.h"
#include "engine/io/raster/raster.h"
#include "engine/io/terrain_file.h"
#include "tests/io/made_raster.h"
#include "tests/support/gie.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef::io {
namespace {

using test::GiePoint;

constexpr double millimetre = 1e-3;

// What becomes of a point.
constexpr const char* right = "right";
constexpr const char* no_system = "no coordinate system of two degrees and metres";
constexpr const char* no_earth = "a globe of 1 m, which GDAL does not take for the Earth";
constexpr const char* no_place = "no way back in PROJ, or none from there";
constexpr const char* ambiguous = "where the way back is ambiguous, or from numbers of few digits";

/// Whether one of some words is in an operation.
bool has_one(const GiePoint& point, std::span<const char* const> words) {
    return std::any_of(words.begin(), words.end(), [&](const char* word) {
        return point.operation.find(word) != std::string::npos;
    });
}
constexpr std::array no_systems{"+proj=pipeline", "+proj=geocent", "+proj=topocentric",
                                "+o_proj=latlon"};
constexpr std::array ambiguous_back{"+proj=krovak",
                                    "+proj=lee_os",
                                    "+proj=lsat",
                                    "+proj=misrsom",
                                    "+proj=calcofi",
                                    "+proj=ortho +ellps=WGS84",
                                    "+proj=lagrng +R=1 +lat_1=56"};

/// From degrees to the operation's coordinates, or back.
enum class Way { there, back };

/// Metres between what is found and what is expected.
double error_of(const GiePoint& point, Way way, glm::dvec2 found) {
    return way == Way::there ? glm::distance(found, glm::dvec2(point.output[0], point.output[1]))
                             : geo::geodesic_distance({found.y, found.x, 0.0},
                                                      {point.input[1], point.input[0], 0.0});
}

std::string outcome_of(const GiePoint& point, Way way, const CrsTransform& transform) {
    const auto& from = way == Way::there ? point.input : point.output;
    std::array found{glm::dvec2(from[0], from[1])};
    transform.apply(found);
    if (std::isnan(found[0].x)) {
        return no_place;
    }
    const double error = error_of(point, way, found[0]);
    if (error <= std::max(millimetre, point.tolerance)) {
        return right;
    }
    return way == Way::back && has_one(point, ambiguous_back)
               ? ambiguous
               : fmt::format("line {}, {}: {} m off", point.line, point.operation, error);
}

/// How many points came out how.
using Tally = std::map<std::string, int>;

/// Of points of one operation.
Tally tally_of(std::span<const GiePoint> points, Way way) {
    const auto all = [&](const char* reason) {
        return Tally{{reason, static_cast<int>(points.size())}};
    };
    if (has_one(points.front(), no_systems)) {
        return all(no_system);
    }
    const test::QuietGdal quiet;
    const std::string system = points.front().operation + " +type=crs";
    const auto transform = way == Way::there ? CrsTransform::create(wgs84_degrees, system)
                                             : CrsTransform::create(system, wgs84_degrees);
    if (!transform) {
        return all(no_earth);
    }
    Tally tally;
    for (const GiePoint& point : points) {
        ++tally[outcome_of(point, way, *transform)];
    }
    return tally;
}

/// The points of each operation: to set up a coordinate system takes longer than to use it.
std::vector<std::span<const GiePoint>> by_operation(std::span<const GiePoint> points) {
    std::vector<std::span<const GiePoint>> groups;
    while (!points.empty()) {
        const auto end = std::find_if(points.begin(), points.end(), [&](const GiePoint& point) {
            return point.operation != points.front().operation;
        });
        const auto count = static_cast<std::size_t>(end - points.begin());
        groups.push_back(points.first(count));
        points = points.subspan(count);
    }
    return groups;
}

Tally tally_of_all(std::span<const GiePoint> points, Way way) {
    const auto groups = by_operation(points);
    std::vector<Tally> tallies(groups.size());
    parallel_for(static_cast<int>(groups.size()), [&](int i) {
        const auto group = static_cast<std::size_t>(i);
        tallies[group] = tally_of(groups[group], way);
    });
    Tally sum;
    for (const Tally& tally : tallies) {
        for (const auto& [outcome, count] : tally) {
            sum[outcome] += count;
        }
    }
    return sum;
}

/// At least so many are right, and of the others at most so many for each known reason.
void expect_tally(const Tally& tally, const Tally& limits) {
    for (const auto& [outcome, count] : tally) {
        const auto limit = limits.find(outcome);
        ASSERT_NE(limit, limits.end()) << outcome << " (" << count << ")";
        if (outcome == right) {
            EXPECT_GE(count, limit->second);
        } else {
            EXPECT_LE(count, limit->second) << outcome;
        }
    }
    EXPECT_EQ(tally.count(right), 1U);
}

std::vector<GiePoint> all_points() {
    return test::read_gie(test::data_path("geodesy/proj_gie/builtins.gie"));
}

/// Half of the points, for the time that they take.
struct Half {
    bool names_ellipsoid = true; ///< else their operations tell radii
    std::size_t points = 0;
    Tally there; ///< of those that are written that way
    Tally back;  ///< of all
};

class GiePoints : public ::testing::TestWithParam<Half> {
protected:
    static std::vector<GiePoint> points() {
        auto points = all_points();
        std::erase_if(points, [](const GiePoint& point) {
            return (point.operation.find("+ellps=") != std::string::npos) !=
                   GetParam().names_ellipsoid;
        });
        EXPECT_EQ(points.size(), GetParam().points);
        return points;
    }
};

TEST_P(GiePoints, HaveTheCoordinatesThatProjGivesThem) {
    RELJEF_RELEASE_ONLY("thousands of points by the same few lines");
    RELJEF_NEED_DATA("geodesy/proj_gie/builtins.gie");
    auto written = points();
    std::erase_if(written, [](const GiePoint& point) { return point.inverse; });
    expect_tally(tally_of_all(written, Way::there), GetParam().there);
}

TEST_P(GiePoints, AreThePlacesThatProjGivesTheirCoordinates) {
    RELJEF_RELEASE_ONLY("thousands of points by the same few lines");
    RELJEF_NEED_DATA("geodesy/proj_gie/builtins.gie");
    expect_tally(tally_of_all(points(), Way::back), GetParam().back);
}

INSTANTIATE_TEST_SUITE_P(
    Builtins, GiePoints,
    ::testing::Values(
        Half{true,
             647,
             {{right, 376}, {no_system, 6}},
             {{right, 612}, {no_system, 7}, {no_place, 7}, {ambiguous, 21}}},
        Half{false,
             1172,
             {{right, 639}, {no_system, 8}, {no_earth, 92}},
             {{right, 958}, {no_system, 17}, {no_earth, 97}, {no_place, 90}, {ambiguous, 10}}}),
    [](const auto& half) {
        return std::string(half.param.names_ellipsoid ? "ellipsoids" : "radii");
    });

/// Written as projections of the Earth's ellipsoid with degrees in and metres out, and with a way
/// back from there and from all around (nzmg's points are far from New Zealand, imw_p's at the
/// origin).
bool is_projection(const GiePoint& point) {
    const std::string& text = point.operation;
    const auto has = [&](const char* word) { return text.find(word) != std::string::npos; };
    return has("+ellps=GRS80") && point.input.size() == 2 && point.output.size() == 2 &&
           std::abs(point.input[1]) < 89.999 && !has("+to_meter") && !has("+units") &&
           !has("+axis") && !has("+inv") && !has("+proj=longlat") && !has("+over") &&
           !has("+proj=nzmg") && !has("+proj=imw_p") && !has_one(point, no_systems) &&
           !has_one(point, ambiguous_back);
}

/// The latitude and longitude that a raster in the operation's CRS has where the point's output is.
std::optional<glm::dvec2> found_place(const GiePoint& point, const std::filesystem::path& file) {
    constexpr double step = 8.0; // metres
    auto raster = test::made_raster(5, 5, [](int col, int row) { return col + row; });
    raster.crs = point.operation + " +type=crs";
    raster.geotransform = {point.output[0] - 2.5 * step, step, 0.0,
                           point.output[1] + 2.5 * step, 0.0,  -step};
    const test::QuietGdal quiet;
    if (!test::write(raster, file)) {
        return std::nullopt;
    }
    const auto terrain = read_terrain(file);
    if (!terrain || !terrain->heightfield.georeference) {
        return std::nullopt;
    }
    return terrain->heightfield.georeference->geodetic.latitude_longitude({2.0, 2.0});
}

TEST(Gie, RastersLieWhereProjsOwnPointsAre) {
    RELJEF_RELEASE_ONLY("thousands of points by the same few lines");
    RELJEF_NEED_DATA("geodesy/proj_gie/builtins.gie");
    const test::TemporaryFolder folder;
    auto points = all_points();
    std::erase_if(points, [](const GiePoint& point) { return !is_projection(point); });
    const auto groups = by_operation(points);
    ASSERT_GE(groups.size(), 59U);
    for (std::size_t i = 0; i < groups.size(); i += 3) { // to make and read a raster takes 50 ms
        const GiePoint& point = groups[i].front();
        const auto found = found_place(point, folder.path() / "point.tif");
        ASSERT_TRUE(found) << point.operation << " line " << point.line;
        // Inverse tests are written to 1e-9 degrees, which is 0.1 mm.
        EXPECT_LT(geo::geodesic_distance({found->x, found->y, 0.0},
                                         {point.input[1], point.input[0], 0.0}),
                  millimetre)
            << point.operation << " line " << point.line;
    }
}

} // namespace
} // namespace reljef::io
