// What heights count from, in the program: what is told of it, and when a geoid is applied.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/session/ground.h"
#include "tests/app/command_line.h"
#include "tests/session/made_session.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class VerticalDatum : public testing::Test {
protected:
    VerticalDatum() {
        folder_.write("heights.asc", "ncols 4\nnrows 4\nxllcenter 10\nyllcenter 40\ncellsize 1\n"
                                     "1 2 3 4 5 6 7 8 9 8 7 6 5 4 3 2\n");
        folder_.write("geoid.prj",
                      "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,"
                      "298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\","
                      "0.0174532925199433]]");
        geoid_ = folder_
                     .write("geoid.asc", "ncols 6\nnrows 6\nxllcenter 9\nyllcenter 39\n"
                                         "cellsize 1\n" +
                                             repeated("50 ", 36))
                     .string();
    }
    static std::string repeated(const std::string& text, int times) {
        std::string all;
        for (int i = 0; i < times; ++i) {
            all += text;
        }
        return all;
    }
    /// The same heights in a coordinate system, as GDAL's SetFromUserInput takes it.
    [[nodiscard]] std::string dem(const std::string& crs) const {
        return folder_
            .write("dem.vrt",
                   "<VRTDataset rasterXSize=\"4\" rasterYSize=\"4\"><SRS>" + crs +
                       "</SRS><GeoTransform>9.5,1,0,43.5,0,-1</GeoTransform><VRTRasterBand "
                       "dataType=\"Float32\" band=\"1\"><SimpleSource><SourceFilename "
                       "relativeToVRT=\"1\">heights.asc</SourceFilename><SourceBand>1"
                       "</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>")
            .string();
    }
    [[nodiscard]] session::SourceOptions choice(const std::string& crs,
                                                const std::string& geoid = {}) const {
        session::SourceOptions choice;
        choice.terrain = dem(crs);
        choice.geoid = geoid;
        return choice;
    }
    static std::string note_of(const session::SourceOptions& choice) {
        auto source = test::open_terrain(choice);
        EXPECT_TRUE(source) << (source ? "" : source.error().message);
        const auto scene = test::make_scene(std::move(*source), choice, {});
        EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
        return session::geoid_note(*scene, choice).value_or("");
    }

    test::TemporaryFolder folder_;
    std::string geoid_;
};

TEST_F(VerticalDatum, of_a_crs_with_three_axes_is_the_ellipsoid_and_takes_no_geoid) {
    const auto info = test::reljef({"info", dem("EPSG:4979")});
    EXPECT_EQ(info.exit_code, 0) << info.err;
    EXPECT_THAT(info.out, HasSubstr("ellipsoidal height; no geoid needed"));
    test::expect_refusal(test::reljef({"info", dem("EPSG:4979"), "--geoid", geoid_}), 2,
                         {"--geoid: ", "dem", "count from the ellipsoid"});
}

TEST_F(VerticalDatum, of_another_name_is_told_where_a_geoid_is_applied) {
    EXPECT_THAT(note_of(choice("EPSG:4326+3855", geoid_)),
                HasSubstr("EGM2008 height\": taken as from the geoid geoid"));
    EXPECT_EQ(note_of(choice("EPSG:4326+5773", geoid_)), "") << "EGM96";
    EXPECT_EQ(note_of(choice("EPSG:4326", geoid_)), "") << "of no name";
}

TEST_F(VerticalDatum, without_a_geoid_is_told_where_the_ellipsoid_is_drawn_on) {
    const auto result =
        test::reljef({"render", dem("EPSG:4326+3855"), "-o", (folder_.path() / "a.png").string(),
                      "--context", "osmesa", "--size", "64x48"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("EGM2008 height\", and no geoid is applied"));
    EXPECT_THAT(note_of(choice("EPSG:4326")), HasSubstr("no geoid is applied"));
    EXPECT_EQ(note_of(choice("EPSG:4979")), "");
    EXPECT_EQ(note_of(choice("EPSG:4326", "none")), "");
}

TEST_F(VerticalDatum, on_a_plane_is_none_of_the_notes) {
    for (const std::string& geoid : {std::string(), geoid_}) {
        session::SourceOptions flat = choice("EPSG:4326+3855", geoid);
        EXPECT_NE(note_of(flat), "");
        flat.placement = terrain::PlacementKind::plane;
        EXPECT_EQ(note_of(flat), "");
        const auto result =
            test::reljef({"render", flat.terrain, "-o", (folder_.path() / "a.png").string(),
                          "--context", "osmesa", "--size", "64x48", "--placement", "plane",
                          "--geoid", geoid.empty() ? "none" : geoid});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_THAT(result.err, Not(HasSubstr("geoid")));
    }
}

TEST_F(VerticalDatum, info_tells_why_no_geoid_is_applied) {
    const std::string name = dem("EPSG:4326+3855");
    EXPECT_THAT(test::reljef({"info", name}).out,
                HasSubstr("geoid not applied: none given or installed for it"));
    EXPECT_THAT(test::reljef({"info", name, "--geoid", "none"}).out,
                HasSubstr("geoid not applied: --geoid none\n"));
}

} // namespace
} // namespace reljef
