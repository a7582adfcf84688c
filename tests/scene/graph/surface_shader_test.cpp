#include "engine/scene/graph/surface_shader.h"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

using testing::HasSubstr;

constexpr const char* light_as_it_is =
    "vec3 surface_color(Surface surface) { return surface.light; }\n";

TEST(SurfaceShader, KnowsItsConstants) {
    const auto shader = SurfaceShader::create(
        "a.glsl", std::string("// uniform float not_one;\n/* uniform vec2 nor_this; */\n"
                              "uniform float line = 2.0;\nuniform\tvec3\n tint;uniform vec4 "
                              "last=vec4(1.0);\n") +
                      light_as_it_is);
    ASSERT_TRUE(shader) << shader.error().message;
    ASSERT_EQ(shader->constants().size(), 3U);
    EXPECT_EQ(shader->constants()[0].name, "line");
    EXPECT_EQ(shader->constants()[0].size, 1U);
    EXPECT_EQ(shader->constants()[1].name, "tint");
    EXPECT_EQ(shader->constants()[1].size, 3U);
    EXPECT_EQ(shader->constants()[2].name, "last");
    EXPECT_EQ(shader->constants()[2].size, 4U);
    EXPECT_TRUE(shader->check(std::vector<ShaderConstant>{{"tint", {1.0F, 2.0F, 3.0F}}}));
    const auto unknown = shader->check(std::vector<ShaderConstant>{{"water", {1.0F}}});
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().message,
              "a.glsl: no constant 'water' found, uniform float water was expected");
    for (const char* const name : {"", "1a", "a b", "ti-nt", "t\u00efnt"}) {
        const auto odd = shader->check(std::vector<ShaderConstant>{{name, {1.0F}}});
        ASSERT_FALSE(odd);
        EXPECT_THAT(odd.error().message, testing::HasSubstr("a constant with the name '" +
                                                            std::string(name) + "' found"));
    }
    const auto small = shader->check(std::vector<ShaderConstant>{{"tint", {1.0F}}});
    ASSERT_FALSE(small);
    EXPECT_EQ(small.error().message,
              "a.glsl: constant 'tint' with 1 value found, vec3 was expected");
    const auto missing = shader->check({});
    ASSERT_FALSE(missing) << "it would be 0, and the ground black";
    EXPECT_EQ(missing.error().message, "a.glsl: no value of its uniform vec3 tint found, one was "
                                       "expected: as a constant, or '=' in its declaration");
}

TEST(SurfaceShader, RefusesWhatCannotBeOne) {
    const std::vector<std::pair<std::string, std::string>> wrong{
        {"", "no function surface_color found"},
        {"// vec3 surface_color(Surface surface)", "no function surface_color found"},
        {"vec3 color(Surface surface) { return surface.light; }",
         "no function surface_color found"},
        {std::string("uniform float 3d;\n") + light_as_it_is, "with the name '3d' found"},
        {std::string("uniform float;\n") + light_as_it_is, "with the name ';' found"},
        {std::string("uniform sampler2D map;\n") + light_as_it_is,
         "uniform of type 'sampler2D' found"},
        {std::string("uniform int count;\n") + light_as_it_is, "uniform of type 'int' found"},
        {std::string(light_as_it_is) + "uniform", "uniform of type '' found"},
        {std::string("uniform float a, b;\n") + light_as_it_is, "',' behind uniform float a found"},
        {std::string("uniform vec2 a[3];\n") + light_as_it_is, "'[' behind uniform vec2 a found"},
        {std::string("uniform highp float a;\n") + light_as_it_is, "uniform of type 'highp' found"},
        {light_as_it_is + std::string(1, '\0'), "a zero byte found"},
        {std::string("\xEF\xBB\xBF") + light_as_it_is, ""},
        {std::string(light_as_it_is) + "/* without an end uniform int", ""},
        {light_as_it_is + std::string(SurfaceShader::max_bytes, ' '),
         "bytes found, at most 65536"}};
    for (const auto& [text, part] : wrong) {
        const auto shader = SurfaceShader::create("a.glsl", text);
        if (part.empty()) {
            EXPECT_TRUE(shader) << text;
            continue;
        }
        ASSERT_FALSE(shader) << text;
        EXPECT_THAT(shader.error().message, HasSubstr(part));
        EXPECT_THAT(shader.error().message, HasSubstr("a.glsl: "));
        EXPECT_THAT(shader.error().message, HasSubstr("expected"));
    }
}

} // namespace
} // namespace reljef::scene
