// PROJ's own regression points through the place that reljef gives a raster.
#include <cmath>

#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include "engine/io/raster.h"
#include "tests/io/made_raster.h"
#include "tests/support/gie.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef::io {
namespace {

using test::GiePoint;

/// Written as projections of the Earth's ellipsoid with degrees in and metres out.
bool is_projection(const GiePoint& point) {
    const std::string& text = point.operation;
    const auto has = [&](const char* word) { return text.find(word) != std::string::npos; };
    return has("+ellps=GRS80") && point.input.size() == 2 && point.output.size() == 2 &&
           std::abs(point.input[1]) < 89.999 && !has("+to_meter") && !has("+units") &&
           !has("+axis") && !has("+inv") && !has("+proj=longlat") && !has("+over");
}

/// The latitude and longitude that a raster in the operation's CRS has where the point's output is.
std::optional<glm::dvec2> found_place(const GiePoint& point, const std::filesystem::path& file) {
    constexpr double step = 8.0; // metres
    auto raster = test::made_raster(5, 5, [](int col, int row) { return col + row; });
    raster.crs = point.operation + " +type=crs";
    raster.geotransform = {point.output[0] - 2.5 * step, step, 0.0,
                           point.output[1] + 2.5 * step, 0.0,  -step};
    OGRSpatialReference crs;
    const test::QuietGdal quiet;
    if (crs.SetFromUserInput(raster.crs.c_str()) != OGRERR_NONE || !test::write(raster, file)) {
        return std::nullopt;
    }
    const auto terrain = read_terrain(file);
    if (!terrain || !terrain->heightfield.georeference) {
        return std::nullopt;
    }
    return terrain->heightfield.georeference->geodetic.latitude_longitude({2.0, 2.0});
}

/// Not those whose numbers are no metres (calcofi), that have another meaning as a coordinate
/// system (krovak's longitude counts from elsewhere), or whose inverse PROJ only approaches (lsat,
/// misrsom).
bool is_exact(const GiePoint& point) {
    const auto& text = point.operation;
    return text.find("calcofi") == std::string::npos && text.find("krovak") == std::string::npos &&
           text.find("lsat") == std::string::npos && text.find("misrsom") == std::string::npos;
}

TEST(Gie, RastersLieWhereProjsOwnPointsAre) {
    RELJEF_RELEASE_ONLY("thousands of points by the same few lines");
    RELJEF_NEED_DATA("geodesy/proj_gie/builtins.gie");
    const test::TemporaryFolder folder;
    int checked = 0;
    int operations = 0;
    std::string last; // to set up a coordinate system costs 50 ms: one point of every third
    for (const GiePoint& point : test::read_gie(test::data_path("geodesy/proj_gie/builtins.gie"))) {
        if (!is_projection(point) || !is_exact(point) || point.operation == last) {
            continue;
        }
        last = point.operation;
        if (operations++ % 3 != 0) {
            continue;
        }
        const auto found = found_place(point, folder.path() / "point.tif");
        if (!found) {
            continue;
        }
        // Inverse tests are written to 1e-9 degrees, which is 0.1 mm.
        EXPECT_LT(geo::geodesic_distance({found->x, found->y, 0.0},
                                         {point.input[1], point.input[0], 0.0}),
                  1e-3)
            << point.operation << " line " << point.line;
        ++checked;
    }
    EXPECT_GE(checked, 15);
}

} // namespace
} // namespace reljef::io
