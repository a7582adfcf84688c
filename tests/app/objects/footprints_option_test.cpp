#include "app/objects/footprints_option.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/app/command_line.h"
#include "tests/app/objects/meshes_on_terrain.h"
#include "tests/io/footprints/made_footprints.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(FootprintsOption, ReadsAFileItsHeightsAndItsRoofs) {
    const auto found = parse_footprints("a:b.gpkg:height=storeys,roof=hipped");
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found->file, "a:b.gpkg");
    EXPECT_EQ(found->height, "storeys");
    EXPECT_EQ(found->roof, building::RoofKind::hipped);
    EXPECT_EQ(parse_footprints("a.shp:surface=my,dsm.tif")->surface, "my,dsm.tif");
    EXPECT_EQ(parse_footprints("a.shp:roof=flat,height=h")->roof, building::RoofKind::flat);
}

TEST(FootprintsOption, WritesWhatItReads) {
    for (const std::string text :
         {"a.shp:height=h", "a:b.gpkg:surface=dsm.tif,roof=hipped", "a.shp:height=h,roof=hipped"}) {
        EXPECT_EQ(to_text(parse_footprints(text).value()), text);
    }
}

TEST(FootprintsOption, NamesWhatIsWrong) {
    const std::vector<std::pair<std::string, std::string>> wrong{
        {"a.shp", "FILE:height=ATTRIBUTE"},
        {"a.shp:roof=flat", "FILE:height=ATTRIBUTE"},
        {":height=h", "FILE:height=ATTRIBUTE"},
        {"a.shp:height=h,surface=b.tif", "FILE:height=ATTRIBUTE"},
        {"a.shp:height=h,roof=dome", "roof 'dome' found"},
        {"a.shp:height=h,colour=red", "'colour' found"},
        {"a.shp:height=h,height=i", "height found twice"}};
    for (const auto& [text, part] : wrong) {
        const auto refused = parse_footprints(text);
        ASSERT_FALSE(refused) << text;
        EXPECT_THAT(refused.error().message, AllOf(HasSubstr("--footprints"), HasSubstr(part)));
    }
}

class FootprintsOnTerrain : public test::MeshesOnTerrain {
protected:
    FootprintsOnTerrain() : MeshesOnTerrain("3,-19,9") {}

    std::string houses_ =
        folder_
            .write(
                "houses.geojson",
                test::footprints_text(
                    {test::polygon_feature("[" + test::rectangle(-8, -3, 1, 4) + "]", R"("h":4)"),
                     test::polygon_feature("[[[4,0],[11,0],[11,9],[8,9],[8,4],[4,4],"
                                           "[4,0]],[[9,1],[9,3],[10,3],[10,1],[9,1]]]",
                                           R"("h":2.5)")}))
            .string();
};

TEST_F(FootprintsOnTerrain, TrianglesAndTruthShowThemAtTheSamePixels) {
    const std::string houses = houses_ + ":height=h,roof=hipped";
    const HitBuffer shown = hits({"--footprints", houses, "--context", "osmesa"});
    const HitBuffer exact = hits({"--footprints", houses, "--truth"});
    const auto found = test::compared_meshes(shown, exact);
    EXPECT_GT(found.on_meshes, 1500);
    EXPECT_LE(found.others, 6) << "single pixels on outlines, where floats round";
}

TEST_F(FootprintsOnTerrain, SceneFilesNameThem) {
    folder_.write("scene.toml", "[terrain]\nheights = \"dem.asc\"\n"
                                "[[footprints]]\nfile = \"houses.geojson\"\nheight = \"h\"\n");
    const HitBuffer by_option = hits({"--truth", "--footprints", houses_ + ":height=h"});
    dem_ = (folder_.path() / "scene.toml").string();
    const HitBuffer by_file = hits({"--truth"});
    for (std::size_t i = 0; i < by_file.size(); ++i) {
        ASSERT_EQ(by_file.samples()[i].depth, by_option.samples()[i].depth);
    }
}

TEST_F(FootprintsOnTerrain, WrongOnesAreOneSentence) {
    const auto out = (folder_.path() / "a.png").string();
    const auto render = [&](const std::string& text) {
        return test::reljef({"render", dem_, "--quiet", "-o", out, "--footprints", text});
    };
    test::expect_refusal(render(houses_ + ":roof=hipped"), 2, {"--footprints", "height=ATTRIBUTE"});
    test::expect_refusal(render(houses_ + ":height=floors"), 1,
                         {"no attribute 'floors'", "one of h"});
    const auto file = folder_.write("b.exr", "").string();
    test::expect_refusal(
        test::reljef({"render", dem_, "--hit", file, "--footprints", file + ":height=h"}), 2,
        {"--hit", "which is read as --footprints"});
}

} // namespace
} // namespace reljef::app
