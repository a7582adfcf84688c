#include "engine/io/formats/geoid_file.h"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef::io {
namespace {

struct PublishedUndulation {
    double latitude, longitude, undulation;
};
// The test points that NIMA published with EGM96 (program INTPT, its own spline between 15′).
constexpr std::array published{PublishedUndulation{38.6281550, 269.7791550, -31.628},
                               PublishedUndulation{-14.6212170, 305.0211140, -2.969},
                               PublishedUndulation{46.8743190, 102.4487290, -43.575},
                               PublishedUndulation{-23.6174460, 133.8747120, 15.871},
                               PublishedUndulation{38.6254730, 359.9995000, 50.066},
                               PublishedUndulation{-0.4667440, 0.0023000, 17.329}};

void expect_egm96(const geo::Geoid& geoid) {
    for (const PublishedUndulation& known : published) {
        // 2 cm: what another interpolation of the same 15′ makes.
        EXPECT_NEAR(geoid.undulation(known.latitude, known.longitude), known.undulation, 0.02)
            << known.latitude << "," << known.longitude;
    }
}

TEST(GeoidFile, Egm96IsWhatItsAuthorsPublished) {
    RELJEF_NEED_DATA("geodesy/egm96.grd");
    const auto geoid = read_geoid(test::data_path("geodesy/egm96.grd"));
    ASSERT_TRUE(geoid) << geoid.error().message;
    expect_egm96(*geoid);
}

TEST(GeoidFile, TheInstalledOneIsEgm96) {
    const auto path = installed_geoid();
    if (!path) {
        GTEST_SKIP() << "no geoid is installed";
    }
    const auto geoid = read_geoid(*path);
    ASSERT_TRUE(geoid) << geoid.error().message;
    expect_egm96(*geoid);
}

TEST(GeoidFile, WhatIsNoGeoidIsAnErrorThatNamesTheFile) {
    const test::TemporaryFolder folder;
    auto raster = test::made_raster(8, 8, [](int col, int row) { return col + row; });
    raster.crs = "EPSG:32631";
    raster.geotransform = {500000.0, 10.0, 0.0, 5100000.0, 0.0, -10.0};
    ASSERT_TRUE(test::write(raster, folder.path() / "metres.tif"));
    const auto metres = read_geoid(folder.path() / "metres.tif");
    ASSERT_FALSE(metres);
    EXPECT_NE(metres.error().message.find("metres.tif: is no grid of degrees"), std::string::npos);
    auto hills = test::made_raster(8, 8, [](int col, int row) { return 300.0 + col + row; });
    hills.crs = "EPSG:4326";
    hills.geotransform = {6.0, 0.01, 0.0, 46.0, 0.0, -0.01};
    ASSERT_TRUE(test::write(hills, folder.path() / "hills.tif"));
    const auto terrain = read_geoid(folder.path() / "hills.tif");
    ASSERT_FALSE(terrain);
    EXPECT_NE(terrain.error().message.find("hills.tif: 314 m from the ellipsoid found"),
              std::string::npos);
    EXPECT_FALSE(read_geoid(folder.path() / "absent.gtx"));
    EXPECT_FALSE(read_geoid(folder.write("text.gtx", "nothing")));
}

TEST(GeoidFile, ASparseFileThatClaimsFourGigabytesAsksForNoMemory) {
    const test::TemporaryFolder folder;
    const auto path = folder.write(
        "a.vrt", R"(<VRTDataset rasterXSize="32768" rasterYSize="32768"><SRS>EPSG:4326</SRS>)"
                 "<GeoTransform>0, 0.01, 0, 90, 0, -0.005</GeoTransform>"
                 R"(<VRTRasterBand dataType="Byte" band="1"/></VRTDataset>)");
    const auto geoid = read_geoid(path);
    ASSERT_FALSE(geoid);
    EXPECT_NE(geoid.error().message.find("has 32768×32768 samples"), std::string::npos)
        << geoid.error().message;
}

TEST(GeoidFile, OfANonsensePlaceOrSizeIsAnErrorThatNamesTheFile) {
    const test::TemporaryFolder folder;
    const test::QuietGdal quiet;
    struct Wrong {
        int cols, rows;
        const char* affine;
    };
    for (const Wrong& wrong :
         {Wrong{8, 8, "1e300,1,0,40,0,-1"}, Wrong{8, 8, "nan,1,0,40,0,-1"},
          Wrong{8, 8, "0,inf,0,40,0,-1"}, Wrong{8, 8, "0,1e-300,0,40,0,-1"},
          Wrong{8, 8, "0,0,0,40,0,0"}, Wrong{8, 8, "1e9,1,0,40,0,-1"},
          Wrong{8, 8, "0,1e9,0,40,0,-1"}, Wrong{8, 8, "0,1,0,95,0,-1"},
          Wrong{8, 8, "0,1,0,40,0,-30"}, Wrong{2147483647, 4, "0,1,0,40,0,-1"},
          Wrong{2147483647, 2147483647, "0,1e-9,0,40,0,-1e-9"}, Wrong{3, 3, "0,1,0,40,0,-1"}}) {
        const auto path = folder.write(
            "wrong.vrt",
            fmt::format("<VRTDataset rasterXSize=\"{}\" rasterYSize=\"{}\">"
                        "<SRS>EPSG:4326</SRS><GeoTransform>{}</GeoTransform>"
                        "<VRTRasterBand dataType=\"Float32\" band=\"1\"/></VRTDataset>",
                        wrong.cols, wrong.rows, wrong.affine));
        const auto geoid = read_geoid(path);
        ASSERT_FALSE(geoid) << wrong.affine;
        EXPECT_EQ(geoid.error().message.rfind(path.string() + ": ", 0), 0U);
        EXPECT_NE(geoid.error().message.find("expected"), std::string::npos);
    }
}

TEST(GeoidFile, OfGeographicLibWithANonsenseHeaderIsAnErrorThatNamesTheFile) {
    const test::TemporaryFolder folder;
    for (const char* header :
         {"2147483646 2147483645\n65535\n", "99999999999999999999 181\n65535\n",
          "-360 181\n65535\n", "0 0\n65535\n", "360 181\n7\n", "360 181\n65535\nshort",
          "nan nan\n"}) {
        const auto path =
            folder.write("egm.pgm", std::string("P5\n# Offset -108\n# Scale 0.003\n") + header);
        const auto geoid = read_geoid(path);
        ASSERT_FALSE(geoid) << header;
        EXPECT_NE(geoid.error().message.find("egm.pgm: cannot be read"), std::string::npos);
    }
}

} // namespace
} // namespace reljef::io
