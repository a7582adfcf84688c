#include "engine/render/shaders/shader_library.h"

#include <algorithm>
#include <array>
#include <bit>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glad/gl.h>

#include "engine/render/shaders/frame_block.h"
#include "tests/gl/gl_fixture.h"
#include "tests/support/temporary_folder.h"

namespace reljef::render {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ShaderLibraryGlTest : public test::GlTest {};

// Of a relief's many combinations those with at most one option, and those with as good as all:
// whatever parts of a shader may have to do with each other is there.
std::vector<ShaderVariant> covering_variants() {
    constexpr std::uint32_t options =
        feature_fog | feature_view_steps | feature_fade | feature_smooth_edges |
        feature_write_depth | feature_hard_shadow | feature_soft_shadow | feature_multisampled;
    std::vector<ShaderVariant> variants = all_variants();
    std::erase_if(variants, [](const ShaderVariant& variant) {
        const int count = std::popcount(variant.features & options);
        const bool searches =
            variant.kind == ShaderKind::relief || variant.kind == ShaderKind::relief_mesh ||
            variant.kind == ShaderKind::relief_hull || variant.kind == ShaderKind::relief_terrain;
        return searches && count > 1 && count < 5;
    });
    return variants;
}

TEST_F(ShaderLibraryGlTest, EveryVariantCompilesAndLinks) {
    ShaderLibrary shaders;
    for (const ShaderVariant& variant : covering_variants()) {
        const auto program = shaders.program(variant);
        ASSERT_TRUE(program) << program.error().message;
        EXPECT_NE((*program)->id(), 0U);
    }
}

TEST_F(ShaderLibraryGlTest, CompilesAVariantOnce) {
    ShaderLibrary shaders;
    gl::Program* const first = test::must(shaders.program({ShaderKind::sky, feature_lit}));
    EXPECT_EQ(test::must(shaders.program({ShaderKind::sky, feature_lit | feature_fog})), first)
        << "fog means nothing to the sky";
    EXPECT_NE(test::must(shaders.program({ShaderKind::sky, 0})), first);
}

struct Member {
    const char* name;
    std::size_t offset;
};

TEST_F(ShaderLibraryGlTest, TheFrameBlockLiesAsTheDriverSays) {
    ShaderLibrary shaders;
    const std::array members{Member{"clip_from_relative", offsetof(FrameBlock, clip_from_relative)},
                             Member{"view_forward", offsetof(FrameBlock, view_forward)},
                             Member{"to_sun", offsetof(FrameBlock, to_sun)},
                             Member{"sun_color", offsetof(FrameBlock, sun_color)},
                             Member{"ambient_color", offsetof(FrameBlock, ambient_color)},
                             Member{"sky_zenith", offsetof(FrameBlock, sky_zenith)},
                             Member{"sky_horizon", offsetof(FrameBlock, sky_horizon)},
                             Member{"ray_from_pixel", offsetof(FrameBlock, ray_from_pixel)}};
    for (const ShaderVariant& variant : covering_variants()) {
        if (variant.kind == ShaderKind::beams || variant.kind == ShaderKind::average) {
            continue; // these have nothing of a scene
        }
        const gl::Program& program = *test::must(shaders.program(variant));
        EXPECT_EQ(program.block_size("FrameBlock"), static_cast<int>(sizeof(FrameBlock)));
        for (const Member& member : members) {
            GLuint index = GL_INVALID_INDEX;
            glGetUniformIndices(program.id(), 1, &member.name, &index);
            ASSERT_NE(index, GL_INVALID_INDEX) << member.name;
            GLint offset = -1;
            glGetActiveUniformsiv(program.id(), 1, &index, GL_UNIFORM_OFFSET, &offset);
            EXPECT_EQ(offset, static_cast<GLint>(member.offset)) << member.name;
        }
    }
}

TEST_F(ShaderLibraryGlTest, AFileInTheFolderComesBeforeTheEmbeddedOne) {
    const test::TemporaryFolder folder;
    folder.write("frame/sky.frag", "layout(location = 0) out vec4 color;\n"
                                   "uniform float only_here;\n"
                                   "void main() { color = vec4(only_here); }\n");
    ShaderLibrary shaders(folder.path());
    EXPECT_TRUE(test::must(shaders.program({ShaderKind::sky, 0}))->has_uniform("only_here"));
    EXPECT_FALSE(test::must(shaders.program({ShaderKind::mesh, 0}))->has_uniform("only_here"));
}

TEST_F(ShaderLibraryGlTest, AnErrorNamesTheFileAndTheLine) {
    const test::TemporaryFolder folder;
    folder.write("frame/sky.frag", "layout(location = 0) out vec4 color;\n"
                                   "void main() {\n"
                                   "    color = nonsense;\n"
                                   "}\n");
    ShaderLibrary shaders(folder.path());
    const auto failed = shaders.program({ShaderKind::sky, 0});
    ASSERT_FALSE(failed);
    EXPECT_THAT(failed.error().message, AllOf(HasSubstr("sky.frag:3"), HasSubstr("nonsense")));
    EXPECT_FALSE(take_problems().empty());
}

TEST_F(ShaderLibraryGlTest, AnErrorInAnIncludedFileNamesThatOne) {
    const test::TemporaryFolder folder;
    folder.write("frame/air.glsl",
                 "// one\n// two\nvec3 seen_through_air(vec3 color) { return wrong; }\n");
    ShaderLibrary shaders(folder.path());
    const auto failed = shaders.program({ShaderKind::mesh, 0});
    ASSERT_FALSE(failed);
    EXPECT_THAT(failed.error().message, HasSubstr("air.glsl:3"));
    EXPECT_FALSE(take_problems().empty());
}

TEST_F(ShaderLibraryGlTest, AnErrorAfterAnIncludeStillCountsTheLinesOfItsOwnFile) {
    const test::TemporaryFolder folder;
    folder.write("frame/sky.frag", "#include \"frame/frame_block.glsl\"\n"
                                   "#include \"frame/air.glsl\"\n"
                                   "layout(location = 0) out vec4 color;\n"
                                   "void main() { color = nonsense; }\n");
    ShaderLibrary shaders(folder.path());
    const auto failed = shaders.program({ShaderKind::sky, 0});
    ASSERT_FALSE(failed);
    EXPECT_THAT(failed.error().message, HasSubstr("sky.frag:4"));
    EXPECT_FALSE(take_problems().empty());
}

TEST_F(ShaderLibraryGlTest, AMissingIncludeAndACircleAreErrors) {
    const test::TemporaryFolder folder;
    folder.write("frame/sky.frag", "#include \"nowhere.glsl\"\n");
    folder.write("mesh/mesh.frag", "#include \"mesh/mesh.frag\"\n");
    ShaderLibrary shaders(folder.path());
    const auto missing = shaders.program({ShaderKind::sky, 0});
    ASSERT_FALSE(missing);
    EXPECT_THAT(missing.error().message, HasSubstr("nowhere.glsl"));
    const auto circle = shaders.program({ShaderKind::mesh, 0});
    ASSERT_FALSE(circle);
    EXPECT_THAT(circle.error().message, AllOf(HasSubstr("mesh.frag"), HasSubstr("deep")));
}

} // namespace
} // namespace reljef::render
