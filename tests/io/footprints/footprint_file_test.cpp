#include "engine/io/footprints/footprint_file.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include "engine/io/footprints/polygon_parts.h"
#include "engine/io/raster/gdal_dataset.h"
#include "tests/io/footprints/made_footprints.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using test::footprints_text;
using test::polygon_feature;
using test::rectangle;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

glm::dvec2 corner_of(const building::Footprint& shape, std::uint32_t index) {
    for (const building::Ring& ring : shape.rings) {
        if (index < ring.size()) {
            return ring[index];
        }
        index -= static_cast<std::uint32_t>(ring.size());
    }
    ADD_FAILURE() << "a corner that there is none of";
    return glm::dvec2(0.0);
}

double area_of_triangles(const building::Footprint& shape) {
    double area = 0.0;
    for (const glm::uvec3 triangle : shape.triangles) {
        const double part =
            building::signed_area({corner_of(shape, triangle.x), corner_of(shape, triangle.y),
                                   corner_of(shape, triangle.z)});
        EXPECT_GT(part, 0.0) << "counter-clockwise";
        area += part;
    }
    return area;
}

double area_of_rings(const building::Footprint& shape) {
    double area = 0.0;
    for (const building::Ring& ring : shape.rings) {
        area += building::signed_area(ring);
    }
    return area;
}

class FootprintFileTest : public testing::Test {
protected:
    Result<FootprintFile> read(const std::vector<std::string>& features,
                               const FootprintOptions& options = {}, const std::string& crs = "") {
        return read_footprints(folder_.write("made.geojson", footprints_text(features, crs)),
                               options);
    }
    std::string refusal(const std::string& text, const FootprintOptions& options = {}) {
        const auto file = read_footprints(folder_.write("bad.geojson", text), options);
        EXPECT_FALSE(file);
        return file ? "" : file.error().message;
    }

    test::TemporaryFolder folder_;
};

// A star around a place: simple, seldom convex. Some have a hole.
std::string random_star(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const int corners = 3 + static_cast<int>(seed % 40U);
    const auto ring = [&](double low, double high, bool reversed) {
        std::string text;
        for (int i = 0; i <= corners; ++i) {
            static thread_local double first = 0.0;
            const double radius = i == corners ? first : low + (high - low) * share(random);
            first = i == 0 ? radius : first;
            const double angle =
                (reversed ? -1.0 : 1.0) * 6.283185307179586 * (i % corners) / corners;
            text += fmt::format("{}[{:.9f},{:.9f}]", i > 0 ? "," : "",
                                7.0 + radius * std::cos(angle), 45.0 + radius * std::sin(angle));
        }
        return "[" + text + "]";
    };
    const bool is_clockwise = seed % 3U == 0;
    const std::string outer = ring(0.004, 0.01, is_clockwise);
    return seed % 2U == 0 ? "[" + outer + "]"
                          : "[" + outer + "," + ring(0.0005, 0.001, seed % 5U == 0) + "]";
}

TEST_F(FootprintFileTest, TrianglesFillOutlinesAndLeaveHolesOpen) {
    for (unsigned seed = 0; seed < 120; ++seed) {
        const auto file = read({polygon_feature(random_star(seed))});
        ASSERT_TRUE(file) << file.error().message;
        for (const FileFootprint& found : file->footprints) {
            EXPECT_GT(building::signed_area(found.shape.rings[0]), 0.0);
            for (std::size_t i = 1; i < found.shape.rings.size(); ++i) {
                EXPECT_LT(building::signed_area(found.shape.rings[i]), 0.0) << "a hole";
            }
            EXPECT_NEAR(area_of_triangles(found.shape), area_of_rings(found.shape), 1e-12) << seed;
        }
        if (seed % 2U == 0) {
            ASSERT_EQ(file->footprints.size(), 1U) << seed;
            EXPECT_EQ(file->footprints[0].shape.triangles.size(),
                      file->footprints[0].shape.rings[0].size() - 2);
        }
    }
}

TEST_F(FootprintFileTest, OtherCoordinateSystemsAreTransformed) {
    // The origin of the Dutch grid, in Amersfoort: 52.15517, 5.38721 by its definition.
    const std::string square = "[" + rectangle(155'000.0, 463'000.0, 155'030.0, 463'020.0) + "]";
    const auto file = read({polygon_feature(square)}, {}, "EPSG::28992");
    ASSERT_TRUE(file) << file.error().message;
    const glm::dvec2 corner = file->footprints.at(0).shape.rings[0][0];
    EXPECT_NEAR(corner.x, 5.38721, 1e-5);
    EXPECT_NEAR(corner.y, 52.15517, 1e-5);
    const auto plain =
        read({polygon_feature(square)}, {.height = "", .on_earth = false}, "EPSG::28992");
    ASSERT_TRUE(plain);
    EXPECT_EQ(plain->footprints.at(0).shape.rings[0][0], glm::dvec2(155'000.0, 463'000.0));
}

TEST_F(FootprintFileTest, HeightsAreNumbersOrTextsOfMetres) {
    const std::string square = "[" + rectangle(7.0, 45.0, 7.001, 45.001) + "]";
    const auto file =
        read({polygon_feature(square, R"("h":12.5)"), polygon_feature(square, R"("h":"8 m")"),
              polygon_feature(square, R"("h":"30 ft")"), polygon_feature(square, R"("h":null)"),
              polygon_feature(square, R"("h":-3)"), polygon_feature(square, R"("h":0)"),
              polygon_feature(square, R"("h":5000)"), polygon_feature(square, R"("h":"7")"),
              polygon_feature(square, R"("h":"0x20")"), polygon_feature(square, R"("h":true)")},
             {.height = "h"});
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_EQ(file->footprints.size(), 3U);
    EXPECT_EQ(file->footprints[0].height, 12.5);
    EXPECT_EQ(file->footprints[1].height, 8.0);
    EXPECT_EQ(file->footprints[2].height, 7.0);
    EXPECT_EQ(file->counts.no_height, 4U);
    EXPECT_EQ(file->counts.odd_height, 3U);
    const auto flags = read({polygon_feature(square, R"("h":true)")}, {.height = "h"});
    ASSERT_TRUE(flags);
    EXPECT_EQ(flags->counts.no_height, 1U);
}

TEST_F(FootprintFileTest, SelfIntersectionsAreRepairedAndTheRestIsCounted) {
    const std::string bow_tie = "[[[7,45],[7.001,45.001],[7.001,45],[7,45.001],[7,45]]]";
    const std::string line = "[[[7,45],[7.001,45.001],[7,45]]]";
    const auto file = read(
        {polygon_feature(bow_tie), polygon_feature(line),
         R"({"type":"Feature","properties":{},"geometry":null})",
         R"({"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[7,45]}})"});
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->footprints.size(), 2U) << "two triangles";
    EXPECT_EQ(file->counts.repaired, 1U);
    EXPECT_EQ(file->counts.broken, 1U);
    EXPECT_EQ(file->counts.no_polygons, 2U);
    double area = 0.0;
    for (const FileFootprint& found : file->footprints) {
        area += area_of_triangles(found.shape);
    }
    EXPECT_NEAR(area, 0.5e-6, 1e-15);
}

TEST_F(FootprintFileTest, ReadsShapefilesAndGeoPackagesWithSeveralPolygonsAFeature) {
    register_drivers();
    for (const auto& [driver, name] :
         {std::pair("ESRI Shapefile", "a.shp"), std::pair("GPKG", "a.gpkg"),
          std::pair("FlatGeobuf", "a.fgb")}) {
        const std::string path = (folder_.path() / name).string();
        {
            const Dataset made(GetGDALDriverManager()->GetDriverByName(driver)->Create(
                path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
            ASSERT_NE(made, nullptr) << driver;
            OGRSpatialReference crs;
            crs.importFromEPSG(3857);
            OGRLayer* const layer = made->CreateLayer("a", &crs, wkbMultiPolygon, nullptr);
            OGRFieldDefn field("storeys", OFTReal);
            layer->CreateField(&field);
            const OGRFeatureUniquePtr feature(new OGRFeature(layer->GetLayerDefn()));
            feature->SetField("storeys", 9.0);
            OGRGeometry* shape = nullptr;
            const char* text = "MULTIPOLYGON(((0 0,30 0,30 20,0 20,0 0)),((60 0,90 0,90 20,60 0)))";
            OGRGeometryFactory::createFromWkt(text, nullptr, &shape);
            feature->SetGeometryDirectly(shape);
            ASSERT_EQ(layer->CreateFeature(feature.get()), OGRERR_NONE);
        }
        const auto file = read_footprints(path, {.height = "storeys"});
        ASSERT_TRUE(file) << file.error().message;
        ASSERT_EQ(file->footprints.size(), 2U) << driver;
        EXPECT_EQ(file->footprints[0].height, 9.0);
        double north = 0.0;
        for (const glm::dvec2 corner : file->footprints[0].shape.rings[0]) {
            north = std::max(north, corner.y);
        }
        EXPECT_NEAR(north, 20.0 / 6378137.0 * 57.29577951, 1e-9);
    }
}

TEST_F(FootprintFileTest, RefusesWhatIsNoSuchFileInOneSentence) {
    const std::string square = footprints_text(
        {polygon_feature("[" + rectangle(7.0, 45.0, 7.001, 45.001) + "]", R"("a":1,"b":2)")});
    EXPECT_THAT(refusal(square, {.height = "h"}),
                AllOf(HasSubstr("no attribute 'h' found"), HasSubstr("one of a, b was expected")));
    EXPECT_THAT(refusal("no json"), HasSubstr("cannot be opened"));
    EXPECT_THAT(refusal(footprints_text({})), HasSubstr("no polygon found"));
    const auto absent = read_footprints(folder_.path() / "absent.shp", {});
    ASSERT_FALSE(absent);
    EXPECT_THAT(absent.error().message, HasSubstr("nothing found"));
    EXPECT_FALSE(read_footprints(folder_.path(), {}));
    std::stop_source stop;
    stop.request_stop();
    EXPECT_FALSE(read_footprints(folder_.write("a.geojson", square), {}, stop.get_token()));
}

TEST_F(FootprintFileTest, PolygonsOfTooManyCornersAreCounted) {
    std::string ring;
    const int corners = static_cast<int>(max_polygon_corners) + 1;
    for (int i = 0; i <= corners; ++i) {
        const double angle = 6.283185307179586 * (i % corners) / corners;
        ring += fmt::format("{}[{},{}]", i > 0 ? "," : "", 7.0 + 0.01 * std::cos(angle),
                            45.0 + 0.01 * std::sin(angle));
    }
    const auto file = read({polygon_feature("[[" + ring + "]]")});
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->footprints.size(), 0U);
    EXPECT_EQ(file->counts.too_large, 1U);
    EXPECT_EQ(file->counts.broken, 0U);
}

TEST_F(FootprintFileTest, AnOutlineAcrossTheAntimeridianIsNotTurnedOver) {
    for (const char* const ring :
         {"[[[179.98,45],[-179.98,45],[-179.98,45.01],[179.98,45.01],[179.98,45]]]",
          "[[[179.98,45],[179.98,45.01],[-179.98,45.01],[-179.98,45],[179.98,45]]]"}) {
        const auto file = read({polygon_feature(ring)});
        ASSERT_TRUE(file) << file.error().message;
        ASSERT_EQ(file->footprints.size(), 1U);
        EXPECT_EQ(file->counts.repaired, 0U);
        const building::Footprint& shape = file->footprints[0].shape;
        EXPECT_NEAR(building::signed_area(shape.rings[0]), 0.04 * 0.01, 1e-12);
        EXPECT_NEAR(area_of_triangles(shape), 0.04 * 0.01, 1e-12);
    }
}

TEST_F(FootprintFileTest, AMirroredCoordinateSystemKeepsItsBuildings) {
    const auto file =
        read({polygon_feature("[" + rectangle(1043000, 743000, 1043020, 743020) + "]")}, {},
             "EPSG::5513"); // Krovak: south and west
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_EQ(file->footprints.size(), 1U);
    EXPECT_GT(building::signed_area(file->footprints[0].shape.rings[0]), 0.0);
    EXPECT_GT(area_of_triangles(file->footprints[0].shape), 0.0);
}

TEST_F(FootprintFileTest, CoordinatesOfAnotherSystemAreNowhereOnEarth) {
    const auto file = read({polygon_feature(
        "[[[300000,4500000],[300010,4500000],[300010,4500010],[300000,4500000]]]")});
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->counts.off_earth, 1U);
    EXPECT_EQ(file->counts.broken, 0U);
}

TEST_F(FootprintFileTest, AHoleBesideItsOutlineIsNoBuilding) {
    const auto file = read({polygon_feature("[[[7,45],[7.001,45],[7.001,45.001],[7,45.001],[7,45]],"
                                            "[[7.01,45],[7.011,45],[7.011,45.001],[7.01,45]]]")});
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_EQ(file->footprints.size(), 1U);
    EXPECT_NEAR(area_of_triangles(file->footprints[0].shape), 1e-6, 1e-12);
}

// GEOS reads the first point of each.
TEST_F(FootprintFileTest, AHoleWithoutPointsIsNone) {
    const std::string square = "[[7,45],[7.001,45],[7.001,45.001],[7,45.001],[7,45]]";
    const auto file =
        read({polygon_feature("[" + square + ",[]]"), polygon_feature("[[]," + square + "]"),
              polygon_feature("[[],[]]"), polygon_feature("[]")});
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_EQ(file->footprints.size(), 1U);
    EXPECT_NEAR(area_of_triangles(file->footprints[0].shape), 1e-6, 1e-12);
}

} // namespace
} // namespace reljef::io
