#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <random>

#include <cpl_conv.h>
#include <gdal_alg.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include "engine/io/formats/raster_writer.h"
#include "engine/io/raster/raster.h"
#include "engine/io/terrain_file.h"
#include "engine/terrain/field/placement.h"
#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using test::joined;
using test::made_raster;
using test::MadeRaster;
using ::testing::HasSubstr;

double distance(glm::dvec2 a, glm::dvec2 b) {
    return geo::geodesic_distance({a.x, a.y, 0.0}, {b.x, b.y, 0.0});
}

class Georeferencing : public ::testing::Test {
protected:
    [[nodiscard]] terrain::Terrain read(MadeRaster raster, const std::string& crs,
                                        std::array<double, 6> geotransform,
                                        const RasterOptions& options = {}) const {
        raster.crs = crs;
        raster.geotransform = geotransform;
        EXPECT_TRUE(test::write(raster, path()));
        auto terrain = read_terrain(path(), options);
        EXPECT_TRUE(terrain) << (terrain ? "" : terrain.error().message);
        return terrain ? std::move(*terrain) : terrain::Terrain{};
    }
    [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "made.tif"; }

    test::TemporaryFolder folder_;
};

MadeRaster ramp(int cols = 60, int rows = 40) {
    return made_raster(cols, rows, [](int col, int row) { return 1000.0 * row + col; });
}

/// PROJ's answers for points of a CRS, through a transform made here.
class Exact {
public:
    explicit Exact(const std::string& crs) {
        OGRSpatialReference from;
        from.SetFromUserInput(crs.c_str());
        from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        OGRSpatialReference to;
        to.importFromEPSG(4326);
        to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        transform_.reset(OGRCreateCoordinateTransformation(&from, &to));
    }
    glm::dvec2 latitude_longitude(glm::dvec2 point) {
        transform_->Transform(1, &point.x, &point.y);
        return {point.y, point.x};
    }

private:
    std::unique_ptr<OGRCoordinateTransformation> transform_;
};

TEST_F(Georeferencing, SampleCentresAreHalfAPixelFromTheCorner) {
    const auto heightfield =
        read(ramp(), "EPSG:32631", {500000.0, 10.0, 0.0, 5100000.0, 0.0, -10.0}).heightfield;
    ASSERT_TRUE(heightfield.georeference);
    const geo::PixelAffine& affine = heightfield.georeference->crs_from_pixel;
    EXPECT_EQ(affine.crs_from_pixel(glm::dvec2(0.0)), glm::dvec2(500005.0, 5099995.0));
    EXPECT_EQ(affine.crs_from_pixel(glm::dvec2(59.0, 39.0)), glm::dvec2(500595.0, 5099605.0));
    EXPECT_EQ(heightfield.spacing, glm::dvec2(10.0));
    EXPECT_EQ(heightfield.georeference->crs_name, "WGS 84 / UTM zone 31N");
    EXPECT_EQ(heightfield.georeference->crs_code, "EPSG:32631");
    EXPECT_EQ(heightfield.georeference->horizontal_unit, "metre");
    EXPECT_THAT(heightfield.georeference->wkt, HasSubstr("PROJCRS"));
}

TEST_F(Georeferencing, PositionsAreWithinATenthOfAMillimetreBetweenControlPoints) {
    struct Case {
        const char* crs;
        std::array<double, 6> geotransform;
    };
    const std::vector<Case> cases{
        {"EPSG:32631", {400000.0, 2000.0, 0.0, 5100000.0, 0.0, -2000.0}},
        {"EPSG:4326", {6.0, 0.02, 0.0, 46.0, 0.0, -0.02}},
        {"EPSG:3857", {600000.0, 3000.0, 0.0, 6000000.0, 0.0, -3000.0}},
        {"EPSG:2253", {13292817.0, 2.0, 0.0, 283377.0, 0.0, -2.0}},
        {"EPSG:3413", {-60000.0, 2000.0, 0.0, 40000.0, 0.0, -2000.0}}, // the north pole inside
        {"EPSG:3031", {-300000.0, 2000.0, 100.0, 240000.0, 50.0, -2000.0}},
        {"EPSG:27700", {250000.0, 1000.0, 0.0, 700000.0, 0.0, -1000.0}},
        {"EPSG:3035", {4000000.0, 1000.0, 0.0, 3000000.0, 0.0, -1000.0}}, // northing is first
        {"EPSG:2193", {1600000.0, 1000.0, 0.0, 5500000.0, 0.0, -1000.0}}, // here, too
        {"EPSG:4258", {6.0, 0.02, 0.0, 46.0, 0.0, -0.02}},                // latitude is first
        {"EPSG:4807", {2.0, 0.01, 0.0, 51.0, 0.0, -0.01}},                // grads from Paris
        {"EPSG:32660", {800000.0, 5000.0, 0.0, 8100000.0, 0.0, -5000.0}}, // across 180°
    };
    for (const Case& c : cases) {
        const auto terrain = read(ramp(), c.crs, c.geotransform);
        ASSERT_TRUE(terrain.heightfield.georeference) << c.crs << joined(terrain.notes);
        const geo::Georeference& place = *terrain.heightfield.georeference;
        Exact exact(c.crs);
        std::mt19937 random(1);
        std::uniform_real_distribution<double> cols(0.0, 59.0);
        std::uniform_real_distribution<double> rows(0.0, 39.0);
        for (int i = 0; i < 500; ++i) {
            const glm::dvec2 sample(cols(random), rows(random));
            const glm::dvec2 found = place.geodetic.latitude_longitude(sample);
            const glm::dvec2 requested =
                exact.latitude_longitude(place.crs_from_pixel.crs_from_pixel(sample));
            ASSERT_LT(distance(found, requested), 1e-4) << c.crs;
            const auto again = place.geodetic.sample(found.x, found.y);
            ASSERT_TRUE(again) << c.crs;
            ASSERT_LT(glm::distance(*again, sample), 1e-6) << c.crs;
        }
    }
}

// Rows run to the right of columns, as seen from above, however the file is turned or mirrored.
TEST_F(Georeferencing, NoTurnOfARasterMirrorsItsGround) {
    const auto expect_unmirrored = [this](const char* crs, std::array<double, 6> geotransform) {
        const auto terrain = read(ramp(), crs, geotransform);
        ASSERT_TRUE(terrain.heightfield.georeference) << crs << joined(terrain.notes);
        const auto placement =
            terrain::Placement::create(terrain.heightfield, terrain::PlacementKind::ellipsoid);
        ASSERT_TRUE(placement);
        const auto at = [&](double col, double row) {
            return placement->world_from_sample({col, row, 0.0});
        };
        const glm::dvec3 along = at(40.0, 20.0) - at(20.0, 20.0);
        const glm::dvec3 down = at(30.0, 30.0) - at(30.0, 10.0);
        EXPECT_LT(glm::cross(along, down).z, 0.0) << crs << ' ' << geotransform[1];
    };
    expect_unmirrored("EPSG:3031", {1e6, 60.0, 0.0, -1e6, 0.0, -60.0}); // rows 135° from east
    for (int eighth = 0; eighth < 8; ++eighth) {
        const double angle = eighth * std::numbers::pi / 4.0;
        const double x = 10.0 * std::cos(angle);
        const double y = 10.0 * std::sin(angle);
        expect_unmirrored("EPSG:32631", {5e5, x, y, 5.1e6, y, -x});
        expect_unmirrored("EPSG:32631", {5e5, x, -y, 5.1e6, y, x}); // mirrored
    }
}

TEST_F(Georeferencing, AWholeGlobeOfDegreesIsExact) {
    const auto heightfield =
        read(ramp(72, 36), "EPSG:4326", {-180.0, 5.0, 0.0, 90.0, 0.0, -5.0}).heightfield;
    ASSERT_TRUE(heightfield.georeference);
    const glm::dvec2 found = heightfield.georeference->geodetic.latitude_longitude(
        {10.25, 7.5 + 1.0}); // row 0 is the pole
    EXPECT_NEAR(found.x, 90.0 - 2.5 - 7.5 * 5.0, 1e-12);
    EXPECT_NEAR(found.y, -180.0 + 2.5 + 10.25 * 5.0, 1e-12);
}

TEST_F(Georeferencing, StepsOverAPoleAreMeasuredStraight) {
    const auto spacing = [this](double shift) {
        return read(ramp(50, 50), "EPSG:3413", {-5000.0 + shift, 200.0, 0.0, 5000.0, 0.0, -200.0})
            .heightfield.spacing;
    };
    // True scale is at 70 degrees north; at the pole the projection shrinks by 0.97.
    for (const double shift : {0.0, 100.0, 5000.0, 50000.0}) {
        EXPECT_NEAR(spacing(shift).x, 200.0 / 0.96985, 0.1) << shift;
        EXPECT_NEAR(spacing(shift).y, 200.0 / 0.96985, 0.1) << shift;
    }
}

TEST_F(Georeferencing, DegreesGiveMetresAtTheMiddle) {
    const auto heightfield =
        read(ramp(), "EPSG:4326", {6.0, 0.001, 0.0, 46.0, 0.0, -0.002}).heightfield;
    const glm::dvec2 metres = geo::metres_per_degree(46.0 - 0.002 * 20.0);
    EXPECT_NEAR(heightfield.spacing.x, 0.001 * metres.x, 1e-9);
    EXPECT_NEAR(heightfield.spacing.y, 0.002 * metres.y, 1e-9);
    EXPECT_EQ(heightfield.georeference->horizontal_unit, "degree");
}

TEST_F(Georeferencing, GradsAreNotDegrees) {
    const auto heightfield =
        read(ramp(), "EPSG:4807", {2.0, 0.001, 0.0, 51.0, 0.0, -0.001}).heightfield;
    const glm::dvec2 metres = geo::metres_per_degree(0.9 * (51.0 - 0.001 * 20.0));
    // 0.1 %: the ellipsoid of this system is not that of WGS 84.
    EXPECT_NEAR(heightfield.spacing.x, 0.0009 * metres.x, 0.001 * heightfield.spacing.x);
    EXPECT_NEAR(heightfield.spacing.y, 0.0009 * metres.y, 0.001 * heightfield.spacing.y);
    EXPECT_EQ(heightfield.georeference->horizontal_unit, "grad");
}

// In a GeoTIFF whose pixels are points the tie point is the first sample's centre: half a cell,
// tens of metres, from where it is in one whose pixels are areas.
TEST_F(Georeferencing, PixelIsPointAndPixelIsAreaAreHalfACellApart) {
    auto raster = ramp();
    raster.crs = "EPSG:32631";
    raster.geotransform = {500000.0, 30.0, 0.0, 5100000.0, 0.0, -30.0};
    for (const bool points : {false, true}) {
        ASSERT_TRUE(test::write(raster, path()));
        {
            // What the file itself says: its tie point stays where the area's corner was.
            const CPLConfigOptionSetter as_it_is("GTIFF_POINT_GEO_IGNORE", "TRUE", false);
            GDALDatasetUniquePtr file(GDALDataset::Open(path().c_str(), GDAL_OF_UPDATE));
            ASSERT_NE(file, nullptr);
            file->SetMetadataItem("AREA_OR_POINT", points ? "Point" : "Area");
            std::array<double, 6> t = *raster.geotransform;
            file->SetGeoTransform(t.data());
        }
        const auto terrain = read_terrain(path());
        ASSERT_TRUE(terrain) << terrain.error().message;
        const glm::dvec2 first =
            terrain->heightfield.georeference->crs_from_pixel.crs_from_pixel(glm::dvec2(0.0));
        EXPECT_EQ(first,
                  points ? glm::dvec2(500000.0, 5100000.0) : glm::dvec2(500015.0, 5099985.0));
    }
}

TEST_F(Georeferencing, FeetAreNotMetres) {
    const auto international =
        read(ramp(), "EPSG:2253", {13292817.0, 2.0, 0.0, 283377.0, 0.0, -2.0}).heightfield;
    EXPECT_NEAR(international.spacing.x, 0.6096, 1e-12);
    const auto survey =
        read(ramp(), "EPSG:2263", {980000.0, 3.0, 0.0, 200000.0, 0.0, -3.0}).heightfield;
    EXPECT_NEAR(survey.spacing.y, 3.0 * 1200.0 / 3937.0, 1e-12);
    EXPECT_EQ(survey.georeference->horizontal_unit, "US survey foot");
}

TEST_F(Georeferencing, WebMercatorIsNotTakenAtItsWord) {
    const auto terrain =
        read(ramp(), "EPSG:3857", {600000.0, 30.0, 0.0, 8399737.9, 0.0, -30.0}); // about 60° north
    EXPECT_NEAR(terrain.heightfield.spacing.x, 15.0, 0.1);
    EXPECT_THAT(joined(terrain.notes), HasSubstr("its projection stretches by 1.99"));
}

TEST_F(Georeferencing, TheVerticalAxisOfACompoundCrsCounts) {
    const auto heightfield =
        read(ramp(), "EPSG:26710+5702", {559605.0, 30.0, 0.0, 5120205.0, 0.0, -30.0}).heightfield;
    EXPECT_FLOAT_EQ(heightfield.heights(0, 39), static_cast<float>(39000.0 * 1200.0 / 3937.0));
    EXPECT_EQ(heightfield.georeference->vertical_datum, "NGVD29 height (ftUS)");
    EXPECT_EQ(heightfield.georeference->crs_code, "EPSG:26710");
}

TEST_F(Georeferencing, WrittenHeightsAreMetresAlsoOfACrsInFeet) {
    for (const char* const crs : {"EPSG:26710+5702", "EPSG:26710+5703", "EPSG:26710"}) {
        const auto before =
            read(ramp(), crs, {559605.0, 30.0, 0.0, 5120205.0, 0.0, -30.0}).heightfield;
        const auto path = folder_.path() / "metres.tif";
        ASSERT_TRUE(write_heightfield(path, before));
        const auto after = read_terrain(path);
        ASSERT_TRUE(after) << after.error().message;
        EXPECT_EQ(after->heightfield.heights, before.heights) << crs;
        EXPECT_EQ(after->heightfield.georeference->crs_code, "EPSG:26710") << crs;
    }
}

TEST_F(Georeferencing, HeightsOfACrsWithThreeAxesAreAboveTheEllipsoid) {
    const std::array<double, 6> corner{10.0, 0.01, 0.0, 50.0, 0.0, -0.01};
    const auto datum = [&](const char* crs) {
        return read(ramp(), crs, corner).heightfield.georeference->vertical_datum;
    };
    EXPECT_TRUE(geo::is_ellipsoidal(datum("EPSG:4979")));
    EXPECT_FALSE(geo::is_ellipsoidal(datum("EPSG:4326+3855")));
    EXPECT_FALSE(geo::is_ellipsoidal(datum("EPSG:4326")));
}

TEST_F(Georeferencing, SouthUpRastersAreTurned) {
    const auto heightfield =
        read(ramp(), "EPSG:32631", {500000.0, 10.0, 0.0, 5100000.0, 0.0, 10.0}).heightfield;
    EXPECT_EQ(heightfield.heights(3, 0), 39003.0F);
    EXPECT_EQ(heightfield.heights(3, 39), 3.0F);
    const geo::PixelAffine& affine = heightfield.georeference->crs_from_pixel;
    EXPECT_EQ(affine.crs_from_pixel(glm::dvec2(0.0)), glm::dvec2(500005.0, 5100395.0));
    EXPECT_LT(affine.y_row, 0.0);
    EXPECT_GT(heightfield.georeference->geodetic.latitude_longitude({0.0, 0.0}).x,
              heightfield.georeference->geodetic.latitude_longitude({0.0, 39.0}).x);
}

TEST_F(Georeferencing, EastWestMirroredRastersAreTurned) {
    const auto heightfield =
        read(ramp(), "EPSG:32631", {500600.0, -10.0, 0.0, 5100000.0, 0.0, -10.0}).heightfield;
    EXPECT_EQ(heightfield.heights(0, 1), 1059.0F);
    EXPECT_EQ(heightfield.georeference->crs_from_pixel.crs_from_pixel(glm::dvec2(0.0)),
              glm::dvec2(500005.0, 5099995.0));
}

TEST_F(Georeferencing, SouthUpVoidsAreTurnedWithTheHeights) {
    MadeRaster raster = ramp();
    raster.nodata = -9999.0;
    raster.values[2] = -9999.0;
    const auto heightfield =
        read(raster, "EPSG:32631", {500000.0, 10.0, 0.0, 5100000.0, 0.0, 10.0}).heightfield;
    EXPECT_EQ(heightfield.void_mask(2, 39), 1);
    EXPECT_EQ(heightfield.void_mask(2, 0), 0);
}

TEST_F(Georeferencing, RotatedRastersKeepTheirAffine) {
    const auto terrain = read(ramp(), "EPSG:32631", {500000.0, 8.0, 6.0, 5100000.0, 6.0, -8.0});
    EXPECT_EQ(terrain.heightfield.heights(3, 1), 1003.0F);
    EXPECT_NEAR(terrain.heightfield.spacing.x, 10.0, 1e-12);
    EXPECT_NEAR(terrain.heightfield.spacing.y, 10.0, 1e-12);
    EXPECT_EQ(terrain.heightfield.georeference->crs_from_pixel.x_row, 6.0);
    EXPECT_THAT(joined(terrain.notes), HasSubstr("from east"));
}

TEST_F(Georeferencing, DegreesWithoutACrsAreTakenForWgs84AndTold) {
    const auto terrain = read(ramp(), "", {-119.8337, 3e-5, 0.0, 34.4448, 0.0, -3e-5});
    ASSERT_TRUE(terrain.heightfield.georeference);
    EXPECT_EQ(terrain.heightfield.georeference->crs_code, "EPSG:4326");
    EXPECT_THAT(joined(terrain.notes), HasSubstr("look like degrees"));
}

TEST_F(Georeferencing, CoordinatesWithoutACrsAreMetresAndTold) {
    const auto terrain = read(ramp(), "", {994515.9, 30.0, 0.0, 4377944.2, 0.0, -30.0});
    EXPECT_FALSE(terrain.heightfield.georeference);
    EXPECT_EQ(terrain.heightfield.spacing, glm::dvec2(30.0));
    EXPECT_THAT(joined(terrain.notes), HasSubstr("taken for metres"));
    EXPECT_FALSE(read(ramp(), "", {0.0, 0.05, 0.0, 2.0, 0.0, -0.05}).heightfield.georeference);
}

TEST_F(Georeferencing, AnotherPlanetHasNoPlaceHereButItsMetres) {
    const std::string mars =
        "PROJCS[\"Mars plane\",GEOGCS[\"Mars\",DATUM[\"Mars\",SPHEROID[\"Mars\",3396190,0]],"
        "PRIMEM[\"Reference\",0],UNIT[\"degree\",0.0174532925199433]],"
        "PROJECTION[\"Equirectangular\"],UNIT[\"metre\",1]]";
    const auto terrain = read(ramp(), mars, {100000.0, 200.0, 0.0, 50000.0, 0.0, -200.0});
    EXPECT_NEAR(terrain.heightfield.spacing.x, 200.0, 1e-9);
    if (terrain.heightfield.georeference) {
        GTEST_SKIP() << "this PROJ takes Mars for the Earth";
    }
    EXPECT_THAT(joined(terrain.notes), HasSubstr("without a place"));
}

TEST_F(Georeferencing, ASystemWithoutANameIsNamedAsSuch) {
    const char* const unnamed = "a coordinate system without a name";
    for (const char* name : {"", "unnamed", "unknown"}) {
        const std::string local = std::string("LOCAL_CS[\"") + name + "\",UNIT[\"metre\",1]]";
        const auto beside = read(ramp(), local, {0.0, 3.0, 0.0, 0.0, 0.0, -3.0});
        EXPECT_THAT(joined(beside.notes),
                    HasSubstr(std::string("is in ") + unnamed + ", which names no place on Earth"));
        const std::string projected =
            std::string("PROJCS[\"") + name +
            "\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],"
            "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],"
            "PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",1.5],"
            "PARAMETER[\"central_meridian\",7.1],PARAMETER[\"scale_factor\",1],"
            "PARAMETER[\"false_easting\",3],PARAMETER[\"false_northing\",4],UNIT[\"metre\",1]]";
        const auto placed = read(ramp(), projected, {0.0, 3.0, 0.0, 0.0, 0.0, -3.0});
        ASSERT_TRUE(placed.heightfield.georeference);
        EXPECT_EQ(placed.heightfield.georeference->crs_name, unnamed);
        EXPECT_EQ(read_raster_info(path())->crs_name, unnamed);
        RasterOptions options;
        options.spacing = 5.0;
        EXPECT_THAT(read_terrain(path(), options).error().message, HasSubstr(unnamed));
    }
}

TEST_F(Georeferencing, ARasterBeyondItsProjectionHasNoPlace) {
    const auto terrain = read(
        ramp(), "+proj=ortho +lat_0=40 +lon_0=0 +ellps=WGS84 +type=crs",
        {-9000000.0, 300000.0, 0.0, 6000000.0, 0.0, -300000.0}); // the disc's corners are space
    EXPECT_FALSE(terrain.heightfield.georeference);
    EXPECT_THAT(joined(terrain.notes), HasSubstr("without a place"));
    EXPECT_EQ(terrain.heightfield.heights.cols(), 60);
}

TEST_F(Georeferencing, SpacingOfTheUsersIsOnlyForRastersWithoutAPlace) {
    static_cast<void>(read(ramp(), "EPSG:32631", {500000.0, 10.0, 0.0, 5100000.0, 0.0, -10.0}));
    RasterOptions options;
    options.spacing = 5.0;
    const auto placed = read_terrain(path(), options);
    ASSERT_FALSE(placed);
    EXPECT_THAT(placed.error().message, HasSubstr("spacing 5"));
    EXPECT_EQ(
        read(ramp(), "", {994515.9, 30.0, 0.0, 4377944.2, 0.0, -30.0}, options).heightfield.spacing,
        glm::dvec2(5.0));
    options.spacing = -1.0;
    EXPECT_FALSE(read_terrain(path(), options));
}

} // namespace
} // namespace reljef::io
