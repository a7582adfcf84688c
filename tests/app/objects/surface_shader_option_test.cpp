#include "app/objects/surface_shader_option.h"

#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/app/command_line.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(SurfaceShaderOption, ReadsAFileAndConstants) {
    const auto shader = parse_surface_shader("a:b/snow.glsl:line=2500,tint=1,0.9,-0.8");
    ASSERT_TRUE(shader) << shader.error().message;
    EXPECT_EQ(shader->file, "a:b/snow.glsl");
    EXPECT_THAT(shader->constants.at("line"), ElementsAre(2500.0));
    EXPECT_THAT(shader->constants.at("tint"), ElementsAre(1.0, 0.9, -0.8));
    EXPECT_EQ(parse_surface_shader("snow.glsl")->file, "snow.glsl");
}

TEST(SurfaceShaderOption, WritesWhatItReads) {
    for (const std::string text : {"snow.glsl", "snow.glsl:line=2500,tint=1,0.5,0.25"}) {
        EXPECT_EQ(to_text(parse_surface_shader(text).value()), text);
    }
}

TEST(SurfaceShaderOption, NamesWhatIsWrong) {
    const std::vector<std::pair<std::string, std::string>> wrong{
        {"", "'' found, FILE[:NAME=NUMBERS,...]"},      {":a=1", "':a=1' found"},
        {"a.glsl:b=", "b: '' found, 1 to 4 numbers"},   {"a.glsl:b=x", "b: 'x' found"},
        {"a.glsl:b=1,2,3,4,5", "b: '1,2,3,4,5' found"}, {"a.glsl:b=nan", "b: 'nan' found"},
        {"a.glsl:b=1e31", "b: '1e31' found"},           {"a.glsl:b=1,b=2", "b found twice"}};
    for (const auto& [text, part] : wrong) {
        const auto refused = parse_surface_shader(text);
        ASSERT_FALSE(refused) << text;
        EXPECT_THAT(refused.error().message, HasSubstr(part));
        EXPECT_THAT(refused.error().message, HasSubstr("--surface-shader"));
        EXPECT_THAT(refused.error().message, HasSubstr("expected")) << text;
    }
}

// The pictures of a scene file and of the option are the same.
TEST(SurfaceShaderInPictures, ComesFromOptionsAndSceneFiles) {
    const test::TemporaryFolder folder;
    const std::string shader = folder.write("tint.glsl", "uniform vec3 tint;\n"
                                                         "vec3 surface_color(Surface surface) {\n"
                                                         "    return surface.light * tint;\n}\n");
    const std::string terrain = "[terrain]\ngenerator = \"natural\"\nsize = 65\n";
    const std::string plain = folder.write("plain.toml", terrain);
    const std::string shaded =
        folder.write("shaded.toml", terrain + "[surface_shader]\nfile = \"tint.glsl\"\n"
                                              "[surface_shader.constants]\ntint = [1, 0.5, 0]\n");
    const auto draw = [&](std::vector<std::string> arguments) {
        const std::string picture = (folder.path() / "picture.png").string();
        arguments.insert(arguments.begin(), "render");
        for (const std::string& part :
             {std::string("--size"), std::string("64x48"), std::string("-o"), picture}) {
            arguments.push_back(part);
        }
        const test::ProgramResult drawn = test::reljef(arguments);
        EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
        return io::read_image(picture).value();
    };
    const Image from_file = draw({shaded});
    EXPECT_EQ(draw({plain, "--surface-shader", shader + ":tint=1,0.5,0"}), from_file);
    EXPECT_NE(draw({plain, "--context", "osmesa"}), from_file);
    const test::ProgramResult refused = test::reljef(
        {"render", shaded, "--context", "cpu", "-o", (folder.path() / "a.png").string()});
    EXPECT_NE(refused.exit_code, 0);
    EXPECT_THAT(refused.err, HasSubstr("do not draw a surface shader"));
}

} // namespace
} // namespace reljef::app
