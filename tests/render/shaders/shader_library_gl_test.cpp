#include "engine/render/shaders/shader_library.h"

#include <algorithm>
#include <array>
#include <bit>
#include <bitset>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glad/gl.h>

#include "engine/render/shaders/frame_block.h"
#include "engine/render/shaders/uniforms.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/shaders/all_variants.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_pattern.h"

namespace reljef::render {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ShaderLibraryGlTest : public test::GlTest {};

constexpr std::size_t feature_count = 34;
static_assert(1ULL << (feature_count - 1) == feature_sky_picture, "the last feature");

// Which two features there are together, one without the other, and neither.
using FeaturePairs = std::bitset<feature_count * feature_count * 4>;

FeaturePairs pairs_of(ShaderFeatures features) {
    const std::bitset<feature_count> has(features);
    FeaturePairs pairs;
    for (std::size_t one = 0; one < feature_count; ++one) {
        for (std::size_t other = 0; other < one; ++other) {
            const std::size_t state = (has[one] ? 2U : 0U) + (has[other] ? 1U : 0U);
            pairs.set((one * feature_count + other) * 4 + state);
        }
    }
    return pairs;
}

// So few of all variants that every pair of features that a kind can have is in one of that kind,
// and each feature alone.
// Greedy: those that bring many new pairs first, and among them those with the most features.
std::vector<ShaderVariant> pairwise_variants() {
    std::vector<ShaderVariant> all = all_variants();
    std::stable_sort(all.begin(), all.end(), [](const auto& one, const auto& other) {
        return std::popcount(one.features) > std::popcount(other.features);
    });
    std::map<ShaderKind, FeaturePairs> known;
    std::vector<ShaderVariant> taken;
    for (const std::size_t enough : {20U, 5U, 1U}) {
        for (const ShaderVariant& variant : all) {
            FeaturePairs& of_kind = known[variant.kind];
            const FeaturePairs pairs = pairs_of(variant.features);
            const bool is_plain = enough == 1U && std::popcount(variant.features) <= 1;
            if (is_plain || (pairs & ~of_kind).count() >= enough) {
                of_kind |= pairs;
                taken.push_back(variant);
            }
        }
    }
    return taken;
}

// All uniforms of Uniforms. Its members are declarations only.
auto declared_uniforms() {
    static_assert(sizeof(gl::Uniform<float>) == sizeof(gl::UniformDeclaration));
    constexpr std::size_t count = sizeof(Uniforms) / sizeof(gl::UniformDeclaration);
    return std::bit_cast<std::array<gl::UniformDeclaration, count>>(uniforms);
}

// What the driver says of a uniform. In a block: its offset; a sampler: its unit.
struct ActiveUniform {
    gl::UniformDeclaration declaration;
    std::optional<int> offset;
    std::optional<int> unit;
};

struct ActiveBlock {
    std::string name;
    int size = 0;
    int binding = 0;
};

struct CompiledVariant {
    std::string name;
    std::map<std::string, ActiveUniform> uniforms;
    std::vector<ActiveBlock> blocks;
};

std::string_view glsl_type(GLint type) {
    switch (type) {
    case GL_INT:
        return "int";
    case GL_FLOAT:
        return "float";
    case GL_INT_VEC2:
        return "ivec2";
    case GL_FLOAT_VEC2:
        return "vec2";
    case GL_FLOAT_VEC3:
        return "vec3";
    case GL_FLOAT_VEC4:
        return "vec4";
    case GL_FLOAT_MAT3:
        return "mat3";
    case GL_FLOAT_MAT4:
        return "mat4";
    case GL_SAMPLER_2D:
        return "sampler2D";
    case GL_SAMPLER_2D_ARRAY:
        return "sampler2DArray";
    case GL_SAMPLER_2D_SHADOW:
        return "sampler2DShadow";
    default:
        return "a type that no uniform has";
    }
}

std::string resource_name(GLuint program, GLenum interface, GLuint index) {
    std::array<GLchar, 256> name{};
    glGetProgramResourceName(program, interface, index, static_cast<GLsizei>(name.size()), nullptr,
                             name.data());
    return name.data();
}

template <std::size_t N>
std::array<GLint, N> properties_of(GLuint program, GLenum interface, GLuint index,
                                   const std::array<GLenum, N>& asked) {
    std::array<GLint, N> found{};
    glGetProgramResourceiv(program, interface, index, static_cast<GLsizei>(N), asked.data(),
                           static_cast<GLsizei>(N), nullptr, found.data());
    return found;
}

GLuint count_of(GLuint program, GLenum interface) {
    GLint count = 0;
    glGetProgramInterfaceiv(program, interface, GL_ACTIVE_RESOURCES, &count);
    return static_cast<GLuint>(count);
}

bool is_sampler(GLint type) {
    return type == GL_SAMPLER_2D || type == GL_SAMPLER_2D_ARRAY || type == GL_SAMPLER_2D_SHADOW;
}

CompiledVariant inspect(const gl::Program& program, std::string name) {
    CompiledVariant variant{std::move(name), {}, {}};
    const GLuint id = program.id();
    for (GLuint i = 0; i < count_of(id, GL_UNIFORM); ++i) {
        const auto [type, location, block, offset] =
            properties_of(id, GL_UNIFORM, i,
                          std::array<GLenum, 4>{GL_TYPE, GL_LOCATION, GL_BLOCK_INDEX, GL_OFFSET});
        const std::string uniform_name = resource_name(id, GL_UNIFORM, i);
        ActiveUniform& uniform = variant.uniforms[uniform_name];
        uniform.declaration.type = glsl_type(type);
        if (block >= 0) {
            uniform.offset = offset;
        } else if (is_sampler(type)) {
            GLint unit = -1;
            glGetUniformiv(id, location, &unit);
            uniform.unit = unit;
        }
    }
    for (GLuint i = 0; i < count_of(id, GL_UNIFORM_BLOCK); ++i) {
        const auto [size, binding] = properties_of(
            id, GL_UNIFORM_BLOCK, i, std::array<GLenum, 2>{GL_BUFFER_DATA_SIZE, GL_BUFFER_BINDING});
        variant.blocks.push_back({resource_name(id, GL_UNIFORM_BLOCK, i), size, binding});
    }
    return variant;
}

// The same with a surface shader that reads all it gets: of each kind, those with one feature or
// none, and the one with the most.
std::vector<ShaderVariant> shaded_variants(const std::vector<ShaderVariant>& variants) {
    const auto surface = std::make_shared<const scene::SurfaceShader>(
        scene::SurfaceShader::create("test.glsl",
                                     "vec3 surface_color(Surface surface) { return surface.light * "
                                     "surface.albedo + surface.normal + surface.place * "
                                     "surface.from_eye; }")
            .value());
    std::set<ShaderKind> known;
    std::vector<ShaderVariant> shaded;
    for (const ShaderVariant& variant : variants) {
        const bool is_first = known.insert(variant.kind).second;
        if (is_first || std::popcount(variant.features) <= 1) {
            shaded.push_back({variant.kind, variant.features, surface});
        }
    }
    return shaded;
}

// Compiled once for all tests of this process. Empty where a variant does not compile.
const std::vector<CompiledVariant>& compiled_variants() {
    static const std::vector<CompiledVariant> all = [] {
        ShaderLibrary shaders;
        std::vector<CompiledVariant> made;
        std::vector<ShaderVariant> variants = pairwise_variants();
        const std::vector<ShaderVariant> shaded = shaded_variants(variants);
        variants.insert(variants.end(), shaded.begin(), shaded.end());
        for (const ShaderVariant& variant : variants) {
            const auto program = shaders.program(variant);
            if (!program) {
                ADD_FAILURE() << program.error().message;
                return std::vector<CompiledVariant>();
            }
            made.push_back(
                inspect(**program, fmt::format("kind {}, features {:#x}",
                                               static_cast<int>(variant.kind), variant.features)));
        }
        return made;
    }();
    return all;
}

// Offset of each member of shaders/frame/FILE: floats, vec4, mat4, and arrays of vec4.
std::map<std::string, int> member_offsets(std::string_view file) {
    const auto shaders = embedded_shaders();
    const auto found = std::find_if(shaders.begin(), shaders.end(),
                                    [&](const EmbeddedShader& s) { return s.name == file; });
    const std::string text(found == shaders.end() ? "" : found->text);
    std::map<std::string, int> offsets;
    int offset = 0;
    for (const auto& member : test::matches(text, R"((float|vec4|mat4) (\w+)(\[\d+\])?;)")) {
        const std::string& type = member[1];
        offset = type == "float" ? offset : (offset + 15) / 16 * 16; // std140
        const std::string& length = member[3];
        offsets[member[2] + (length.empty() ? "" : "[0]")] = offset;
        const int count = length.empty() ? 1 : std::stoi(length.substr(1));
        offset += count * (type == "float" ? 4 : type == "mat4" ? 64 : 16);
    }
    return offsets;
}

TEST_F(ShaderLibraryGlTest, EveryVariantCompilesAndLinks) {
    EXPECT_GT(compiled_variants().size(), 100U);
}

TEST_F(ShaderLibraryGlTest, EveryUniformOutsideBlocksIsDeclaredWithItsType) {
    const auto declared = declared_uniforms();
    for (const CompiledVariant& variant : compiled_variants()) {
        for (const auto& [name, uniform] : variant.uniforms) {
            if (uniform.offset || uniform.unit) {
                continue;
            }
            const gl::UniformDeclaration active{name, uniform.declaration.type};
            EXPECT_THAT(declared, testing::Contains(active))
                << active.type << ' ' << name << " of " << variant.name;
        }
    }
}

TEST_F(ShaderLibraryGlTest, EveryDeclaredUniformIsInAShader) {
    std::set<gl::UniformDeclaration> names;
    for (const gl::UniformDeclaration& declared : declared_uniforms()) {
        EXPECT_TRUE(names.insert(declared).second) << declared.name << " is declared twice";
        const auto& variants = compiled_variants();
        EXPECT_TRUE(std::any_of(variants.begin(), variants.end(),
                                [&](const auto& variant) {
                                    const auto found =
                                        variant.uniforms.find(std::string(declared.name));
                                    return found != variant.uniforms.end() &&
                                           !found->second.offset &&
                                           found->second.declaration.type == declared.type;
                                }))
            << declared.type << ' ' << declared.name;
    }
}

TEST_F(ShaderLibraryGlTest, MapsOfOneProgramHaveUnitsOfTheirOwn) {
    for (const CompiledVariant& variant : compiled_variants()) {
        std::map<int, std::string> names;
        for (const auto& [name, uniform] : variant.uniforms) {
            if (uniform.unit) {
                const auto [other, is_new] = names.emplace(*uniform.unit, name);
                EXPECT_TRUE(is_new) << name << " and " << other->second << " of " << variant.name;
            }
        }
    }
}

TEST_F(ShaderLibraryGlTest, BlocksLieAsTheDriverSays) {
    const std::map<std::string_view, std::map<std::string, int>> offsets{
        {"FrameBlock", member_offsets("frame/frame_block.inc")},
        {"TechniqueBlock", member_offsets("frame/technique_block.inc")},
        {"ReliefBlock", member_offsets("frame/relief_block.inc")},
        {"DetailBlock", member_offsets("frame/detail_block.inc")},
        {"CourseBlock", member_offsets("frame/course_block.inc")},
        {"OverlayBlock", member_offsets("frame/overlay_block.inc")},
        {"PointLightBlock", member_offsets("material/point_lights.inc")},
        {"MeshShadowBlock", member_offsets("material/mesh_shadow.inc")}};
    std::set<std::string_view> seen;
    for (const CompiledVariant& variant : compiled_variants()) {
        std::map<std::string, int> expected;
        for (const ActiveBlock& block : variant.blocks) {
            const auto layout =
                std::find_if(block_layouts.begin(), block_layouts.end(),
                             [&](const BlockLayout& known) { return known.name == block.name; });
            ASSERT_NE(layout, block_layouts.end()) << block.name;
            EXPECT_EQ(block.size, static_cast<int>(layout->size)) << block.name;
            EXPECT_EQ(block.binding, static_cast<int>(layout->binding)) << block.name;
            const auto& members = offsets.at(layout->name);
            expected.insert(members.begin(), members.end());
            seen.insert(layout->name);
        }
        std::map<std::string, int> found;
        for (const auto& [name, uniform] : variant.uniforms) {
            if (uniform.offset) {
                found[name] = *uniform.offset;
            }
        }
        EXPECT_EQ(found, expected) << variant.name;
    }
    EXPECT_EQ(seen.size(), block_layouts.size());
}

TEST_F(ShaderLibraryGlTest, ABlockOfAnotherSizeIsAnError) {
    const test::TemporaryFolder folder;
    folder.write("frame/technique_block.inc",
                 "float linear_steps, bisection_steps, more_0, more_1;\n");
    ShaderLibrary shaders(folder.path());
    const auto failed = shaders.program({ShaderKind::relief, feature_bisect});
    ASSERT_FALSE(failed);
    EXPECT_THAT(failed.error().message,
                AllOf(HasSubstr("relief/relief"), HasSubstr("TechniqueBlock"),
                      HasSubstr("16 bytes"), HasSubstr("80")));
}

TEST_F(ShaderLibraryGlTest, CompilesAVariantOnce) {
    ShaderLibrary shaders;
    gl::Program* const first = test::must(shaders.program({ShaderKind::sky, feature_lit}));
    EXPECT_EQ(test::must(shaders.program({ShaderKind::sky, feature_lit | feature_fade})), first)
        << "a fade means nothing to the sky";
    EXPECT_NE(test::must(shaders.program({ShaderKind::sky, 0})), first);
}

TEST_F(ShaderLibraryGlTest, AFileInTheFolderComesBeforeTheEmbeddedOne) {
    const test::TemporaryFolder folder;
    folder.write("frame/sky.frag", "layout(location = 0) out vec4 color;\n"
                                   "uniform float only_here;\n"
                                   "void main() { color = vec4(only_here); }\n");
    ShaderLibrary shaders(folder.path());
    const gl::Uniform<float> uniform("only_here");
    EXPECT_TRUE(test::must(shaders.program({ShaderKind::sky, 0}))->set(uniform, 1.0F));
    EXPECT_FALSE(test::must(shaders.program({ShaderKind::mesh, 0}))->set(uniform, 1.0F));
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
