#include "engine/scene/graph/surface_shader.h"

#include <array>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/bilinear.h"
#include "engine/terrain/field/gradient.h"
#include "tests/cast/frame/compared_pictures.h"
#include "tests/cast/frame/overlay_stage.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_stream.h"
#include "tests/scene/streaming/streamed_samples.h"

namespace reljef::cast {
namespace {

class SurfaceShaderGlTest : public test::GlTest {};

std::shared_ptr<const scene::SurfaceShader> shader_of(const std::string& text) {
    return std::make_shared<const scene::SurfaceShader>(
        test::must(scene::SurfaceShader::create("test.glsl", text)));
}

std::string returning(const std::string& value) {
    return "vec3 surface_color(Surface surface) { return " + value + "; }\n";
}

struct ShadedStage : OverlayStage {
    explicit ShadedStage(const std::string& text = {}) {
        if (!text.empty()) {
            node().material.shader = shader_of(text);
        }
        look_from(scene::Pose::oblique);
    }
};

constexpr std::array shaded_techniques{
    "texture", "polygons", "polygons:error=1", "parallax", "relief", "exact", "cone", "prewarp"};

TEST_F(SurfaceShaderGlTest, ThatReturnsItsLightChangesNothing) {
    for (const char* const technique : shaded_techniques) {
        const Image shaded = ShadedStage(returning("surface.light")).drawn_by_opengl(technique);
        const Image plain = ShadedStage().drawn_by_opengl(technique);
        EXPECT_LE(test::share_of_others(shaded, plain, 1), 0.0005) << technique;
    }
}

TEST_F(SurfaceShaderGlTest, ColoursEveryPlaceOfATerrainAndNothingElse) {
    const Rgba8 green = rgba8_from_linear({0.0F, 1.0F, 0.0F});
    for (const char* const technique : shaded_techniques) {
        ShadedStage stage(returning("vec3(0.0, 1.0, 0.0)"));
        const Image picture = stage.drawn_by_opengl(technique);
        int count = 0;
        for (const Rgba8& pixel : picture.samples()) {
            count += pixel == green ? 1 : 0;
            ASSERT_TRUE(pixel == green || pixel.g < 255) << technique;
        }
        EXPECT_GT(count, 20'000) << technique;
    }
}

// What a shader gets are the values that lamps are shaded by: checked against the surface.
TEST_F(SurfaceShaderGlTest, GetsAlbedoNormalAndPlace) {
    for (const char* const technique : {"exact", "polygons:error=0.1", "relief"}) {
        ShadedStage by_place(returning("fract(surface.place / 1000.0)"));
        const HitBuffer hits = ShadedStage().hits();
        const Image places = by_place.drawn_by_opengl(technique);
        const Image normals =
            ShadedStage(returning("vec3(0.5) + 0.5 * surface.normal")).drawn_by_opengl(technique);
        const Image albedos = ShadedStage(returning("surface.albedo")).drawn_by_opengl(technique);
        const auto& surface = by_place.surface();
        const auto gradients =
            terrain::surface_gradients(surface.heightfield(), surface.placement());
        const Grid<Rgba8> albedo = scene::albedo_map(surface);
        int checked = 0;
        int wrong = 0;
        for (int row = 0; row < overlay_picture.y; row += 3) {
            for (int col = 0; col < overlay_picture.x; col += 3) {
                const Hit& hit = hits(col, row);
                if (!(hit.col > 1.0) || hit.depth > 1500.0F) {
                    continue;
                }
                const glm::dvec2 sample(hit.col, hit.row);
                const glm::dvec3 place =
                    surface.placement().world_from_sample({sample, hit.height});
                const glm::dvec2 gradient(bilinear(gradients, sample, std::identity()));
                const glm::vec3 normal(glm::normalize(glm::dvec3(-gradient, 1.0)));
                const auto off = [&](const Image& picture, glm::vec3 expected) {
                    return glm::distance(linear_from_rgba8(picture(col, row)), expected);
                };
                const bool is_right =
                    off(places, glm::vec3(glm::fract(place / 1000.0))) < 0.03F &&
                    off(normals, 0.5F + 0.5F * normal) < 0.06F &&
                    off(albedos, bilinear(albedo, sample, linear_from_rgba8)) < 0.06F;
                wrong += is_right ? 0 : 1;
                ++checked;
            }
        }
        ASSERT_GT(checked, 1000) << technique;
        EXPECT_LE(wrong, checked / 50) << technique; // silhouettes, and where fract() wraps
    }
}

TEST_F(SurfaceShaderGlTest, HasConstants) {
    ShadedStage stage("uniform float red = 1.0;\nuniform vec3 rest = vec3(0.0, 1.0, 1.0);\n" +
                      returning("vec3(red, rest.yz)"));
    const auto is_everywhere = [&](const glm::vec3& color) {
        const Image picture = stage.drawn_by_opengl("exact");
        return picture(160, 200) == rgba8_from_linear(color);
    };
    EXPECT_TRUE(is_everywhere({1.0F, 1.0F, 1.0F}));
    stage.node().material.constants = {{"red", {0.0F}}};
    EXPECT_TRUE(is_everywhere({0.0F, 1.0F, 1.0F}));
    stage.node().material.constants = {{"red", {0.0F}}, {"rest", {0.0F, 0.0F, 1.0F}}};
    EXPECT_TRUE(is_everywhere({0.0F, 0.0F, 1.0F}));
    session::SceneRenderer opengl = test::must(test::make_renderer(overlay_picture));
    const auto drawn = [&] {
        test::must(opengl.draw(stage.scene));
        return opengl.read_color()(160, 200);
    };
    EXPECT_EQ(drawn(), rgba8_from_linear({0.0F, 0.0F, 1.0F}));
    stage.node().material.constants = {{"red", {0.0F}}};
    EXPECT_EQ(drawn(), rgba8_from_linear({0.0F, 1.0F, 1.0F})) << "the rest is the shader's again";
    stage.node().material.constants.clear();
    EXPECT_EQ(drawn(), rgba8_from_linear({1.0F, 1.0F, 1.0F}));
}

TEST_F(SurfaceShaderGlTest, ChangesMeshesAndTilesOfStreams) {
    const Rgba8 blue = rgba8_from_linear({0.0F, 0.0F, 1.0F});
    ShadedStage stage;
    test::stream_samples(stage.node(), test::SeenLevels::finest);
    scene::Material own;
    own.shader = shader_of(returning("vec3(0.0, 0.0, 1.0)"));
    stage.node().material.shader = own.shader;
    stage.node().material.technique = {scene::Exact{}};
    stage.scene.add_mesh(scene::sphere_mesh(40.0F), own).set_position({0.0, 0.0, 150.0});
    for (const char* const technique : {"exact", "polygons"}) {
        stage.node().material.technique = test::must(scene::parse_technique(technique));
        render::bring_tiles(stage.scene, overlay_picture);
        const Image picture = stage.drawn_by_opengl(technique);
        EXPECT_EQ(picture(160, 200), blue) << technique;
        EXPECT_GT(std::ranges::count(picture.samples(), blue), 20'000) << technique;
    }
}

TEST_F(SurfaceShaderGlTest, NamesTheLineThatDoesNotCompile) {
    ShadedStage stage("// two lines\n" + returning("surface.nothing"));
    session::SceneRenderer opengl = test::must(test::make_renderer(overlay_picture));
    stage.node().material.technique = {scene::Relief{}};
    const auto drawn = opengl.draw(stage.scene);
    ASSERT_FALSE(drawn);
    EXPECT_THAT(drawn.error().message, testing::HasSubstr("test.glsl:2: "));
    EXPECT_FALSE(take_problems().empty());
    stage.node().material.shader = nullptr;
    EXPECT_TRUE(opengl.draw(stage.scene)) << "and draws on without it";
}

TEST_F(SurfaceShaderGlTest, IsNamedWhereItDoesNotFit) {
    session::SceneRenderer opengl = test::must(test::make_renderer(overlay_picture));
    for (const std::string& text :
         {std::string("uniform vec3 eye_place;\n") + returning("eye_place"),
          std::string("vec3 surface_color(vec3 light) { return light; }\n"),
          std::string("vec3 surface_color(Surface surface);\n")}) {
        ShadedStage stage(text);
        stage.node().material.technique = {scene::Relief{}};
        const auto drawn = opengl.draw(stage.scene);
        ASSERT_FALSE(drawn) << text;
        EXPECT_THAT(drawn.error().message, testing::HasSubstr("test.glsl")) << text;
    }
    take_problems();
}

TEST_F(SurfaceShaderGlTest, IsNotForRaysAndChangesNoHit) {
    ShadedStage stage(returning("vec3(1.0)"));
    Driver driver = test::must(Driver::create({.size = overlay_picture}));
    const auto drawn = driver.draw(view::select(stage.scene, overlay_picture));
    ASSERT_FALSE(drawn);
    EXPECT_THAT(drawn.error().message, testing::HasSubstr("do not draw a surface shader"));
    const auto hits_of = [](ShadedStage& shown) {
        shown.node().material.technique = {scene::Relief{}};
        session::SceneRenderer opengl = test::must(test::make_renderer(overlay_picture));
        return test::must(opengl.draw_hits(shown.scene));
    };
    ShadedStage plain;
    const HitBuffer with = hits_of(stage);
    const HitBuffer without = hits_of(plain);
    for (int row = 0; row < overlay_picture.y; ++row) {
        for (int col = 0; col < overlay_picture.x; ++col) {
            ASSERT_EQ(with(col, row).depth, without(col, row).depth);
        }
    }
}

} // namespace
} // namespace reljef::cast
