#include "app/objects/object_option.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/app/command_line.h"
#include "tests/app/objects/meshes_on_terrain.h"
#include "tests/io/mesh/made_mesh.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

using testing::HasSubstr;

TEST(ObjectOption, ReadsAFileAndItsPlace) {
    const auto object = parse_object("a:b,c.obj:at=46.5,-7.25,height=3,heading=-90,scale=0.5");
    ASSERT_TRUE(object) << object.error().message;
    EXPECT_EQ(object->file, "a:b,c.obj");
    EXPECT_EQ(object->at, glm::dvec2(46.5, -7.25));
    EXPECT_EQ(object->height, 3.0);
    EXPECT_EQ(object->heading, -90.0);
    EXPECT_EQ(object->scale, 0.5);
    EXPECT_FALSE(parse_object("house.glb")->at);
}

TEST(ObjectOption, WritesWhatItReads) {
    for (const std::string text : {"house.glb", "house.glb:at=46.5,-7.25",
                                   "a:b.obj:at=1,2,height=-3.5,heading=90,scale=0.001"}) {
        EXPECT_EQ(to_text(parse_object(text).value()), text);
    }
}

TEST(ObjectOption, NamesWhatIsWrong) {
    const std::vector<std::pair<std::string, std::string>> wrong{
        {":at=1,2", "FILE:at=LAT,LON"},
        {"a.obj:at=1", "at: '1' found"},
        {"a.obj:at=1,2,3", "at: '1,2,3' found"},
        {"a.obj:at=nan,2", "at: 'nan,2' found"},
        {"a.obj:at=1e30,2", "at: '1e30,2' found"},
        {"a.obj:at=1,2,at=3,4", "at found twice"},
        {"a.obj:at=1,2,size=4", "'size' found"},
        {"a.obj:at=1,2,scale=0", "scale: '0' found"},
        {"a.obj:at=1,2,scale=1e-20", "scale: '1e-20' found"},
        {"a.obj:at=1,2,scale=-1", "scale: '-1' found"},
        {"a.obj:at=1,2,heading=361", "heading: '361' found"},
        {"a.obj:at=1,2,height=1e9", "height: '1e9' found"},
        {"a.obj:at=1,2,height=", "height: '' found"}};
    for (const auto& [text, part] : wrong) {
        const auto refused = parse_object(text);
        ASSERT_FALSE(refused) << text;
        EXPECT_THAT(refused.error().message, HasSubstr(part));
        EXPECT_THAT(refused.error().message, HasSubstr("expected")) << text;
    }
}

class ObjectsOnTerrain : public test::MeshesOnTerrain {
protected:
    ObjectsOnTerrain() : MeshesOnTerrain("3,-12,5") {}

    std::string object(const std::string& rest) const { return cube_ + rest; }

    std::string cube_ = folder_.write("cube.obj", test::cube_obj).string();
};

TEST_F(ObjectsOnTerrain, TrianglesAndTruthShowThemAtTheSamePixels) {
    const std::vector<std::string> place{"--object", object(":at=0.5,1,heading=30,height=0.5"),
                                         "--object", object(":at=-3,2,scale=2")};
    std::vector<std::string> opengl = place;
    opengl.insert(opengl.end(), {"--context", "osmesa"});
    std::vector<std::string> truth = place;
    truth.emplace_back("--truth");
    const HitBuffer shown = hits(opengl);
    const HitBuffer exact = hits(truth);
    const auto found = test::compared_meshes(shown, exact);
    EXPECT_GT(found.on_meshes, 1000);
    EXPECT_LE(found.others, 4) << "single pixels on outlines, where floats round";
}

TEST_F(ObjectsOnTerrain, SceneFilesNameThem) {
    folder_.write("scene.toml", "[terrain]\nheights = \"dem.asc\"\n"
                                "[[object]]\nfile = \"cube.obj\"\nat = [0.5, 1]\nheading = 30\n");
    const HitBuffer by_option = hits({"--truth", "--object", object(":at=0.5,1,heading=30")});
    dem_ = (folder_.path() / "scene.toml").string();
    const HitBuffer by_file = hits({"--truth"});
    int objects = 0;
    for (std::size_t i = 0; i < by_file.size(); ++i) {
        ASSERT_EQ(by_file.samples()[i].depth, by_option.samples()[i].depth);
        objects += by_file.samples()[i].col == -1.0F && !by_file.samples()[i].is_sky() ? 1 : 0;
    }
    EXPECT_GT(objects, 300);
}

TEST_F(ObjectsOnTerrain, WrongOnesAreOneSentence) {
    const auto out = (folder_.path() / "a.png").string();
    const auto render = [&](const std::string& text) {
        return test::reljef({"render", dem_, "--quiet", "-o", out, "--object", text});
    };
    test::expect_refusal(render(object(":at=1,2,size=3")), 2, {"--object", "'size' found"});
    test::expect_refusal(
        test::reljef({"render", dem_, "--hit", folder_.write("b.exr", "").string(), "--object",
                      (folder_.path() / "b.exr").string() + ":at=1,2"}),
        2, {"--hit", "which is read as --object"});
    test::expect_refusal(render(object(":at=100,2")), 1, {cube_, "outside the terrain"});
    test::expect_refusal(render(cube_), 1, {cube_, "no place found"});
    test::expect_refusal(render("none.obj:at=1,2"), 1, {"none.obj: nothing found"});
    const auto text = folder_.write("text.gltf", "no glTF").string();
    test::expect_refusal(render(text + ":at=1,2"), 1,
                         {text, "holds no JSON", "glTF 2.0 file was expected"});
}

} // namespace
} // namespace reljef::app
