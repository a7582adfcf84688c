// Shadows of meshes in OpenGL: those of rays and of the truth.
#include "engine/render/passes/mesh_shadow.h"

#include <array>
#include <span>

#include <gtest/gtest.h>

#include "engine/session/scene_renderer.h"
#include "engine/truth/image_error.h"
#include "engine/view/select.h"
#include "tests/cast/frame/compared_pictures.h"
#include "tests/cast/frame/object_stage.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_stream.h"
#include "tests/scene/streaming/streamed_samples.h"
#include "tests/session/made_session.h"
#include "tests/support/release_only.h"

namespace reljef::cast {
namespace {

std::shared_ptr<const scene::TerrainDetail> gray_detail(const char* technique) {
    material::ReliefMaterial set;
    set.name = "gray";
    set.heights = Grid<float>(16, 16, 1.0F);
    set.color = Image(16, 16, Rgba8{160, 160, 160, 255});
    set.specular = 0.0F;
    scene::TerrainDetail detail;
    detail.set = std::make_shared<const material::ReliefMaterial>(
        material::completed(std::move(set), material::WrapMode::wrap).value());
    detail.width = 6.0;
    detail.technique = test::must(scene::parse_technique(technique));
    return std::make_shared<const scene::TerrainDetail>(std::move(detail));
}

class MeshShadowGlTest : public test::GlTest {
protected:
    // In OpenGL.
    static Image picture_of(const ObjectStage& stage, glm::ivec2 size = mesh_picture,
                            int samples = 1) {
        session::SceneRenderer made = test::must(test::make_renderer(size));
        made.set_samples(samples);
        test::must(made.draw(stage.scene));
        return made.read_color();
    }
    static view::FrameStats stats_of(const ObjectStage& stage) {
        session::SceneRenderer made = test::must(test::make_renderer(mesh_picture));
        return test::must(made.draw(stage.scene));
    }
};

TEST_F(MeshShadowGlTest, AreThoseOfRaysAndOfTheTruth) {
    constexpr std::array altitudes{35.0, 50.0};
    for (const double altitude : std::span(altitudes).first(std::size_t{test::rounds(2, 1)})) {
        ObjectStage stage;
        stage.set_sun(altitude);
        for (const bool is_map : {false, true}) {
            is_map ? stage.look_from_above() : stage.look_near();
            const Image shown = picture_of(stage);
            const Image rays = stage.drawn();
            EXPECT_LE(test::share_of_others(shown, rays, 16), 0.003) << altitude << is_map;
            const Image expected = stage.true_picture(truth::SunShadow::ray);
            EXPECT_LE(test::share_of_others(shown, expected, 16), 0.008) << altitude << is_map;
            const Image unshadowed = stage.true_picture(truth::SunShadow::sweep);
            EXPECT_GE(test::share_of_others(shown, unshadowed, 16), 0.01) << altitude << is_map;
        }
    }
}

// A wall between the objects and the sun.
TEST_F(MeshShadowGlTest, GroundHidesTheSunFromMeshes) {
    for (const bool is_map : {false, true}) {
        ObjectStage stage(true, hills_and_wall());
        is_map ? stage.look_from_above() : stage.look_near();
        const Image shown = picture_of(stage);
        EXPECT_LE(test::share_of_others(shown, stage.drawn(), 16), 0.005) << is_map;
    }
}

TEST_F(MeshShadowGlTest, AreThereWithSamplesAndOverStreams) {
    ObjectStage stage;
    stage.set_sun(40.0);
    stage.look_near();
    const Image one = picture_of(stage);
    EXPECT_LE(test::share_of_others(picture_of(stage, mesh_picture, 4), one, 48), 0.06);
    ObjectStage streamed;
    streamed.set_sun(40.0);
    test::stream_samples(*streamed.terrain->get<scene::TerrainNode>(), test::SeenLevels::finest);
    streamed.look_near();
    render::bring_tiles(streamed.scene, mesh_picture);
    EXPECT_LE(test::share_of_others(picture_of(streamed), one, 24), 0.03);
}

// Nothing but its own far side hides the sun from a round mesh: no pixel of the near side is dark.
TEST_F(MeshShadowGlTest, LitFacesHaveNoDarkSpots) {
    for (const double altitude : {4.0, 30.0, 80.0}) {
        ObjectStage stage;
        stage.set_sun(altitude);
        stage.remove_meshes();
        const glm::dvec3 ball(0.0, -20.0, 80.0);
        stage.scene.add_mesh(scene::sphere_mesh(20.0F, 96), colored(glm::vec3(0.8F)))
            .set_position(ball);
        // From the sun's side: all of the ball that is seen is lit, but for its rim.
        stage.look(test::camera_at(ball + 90.0 * scene::to_light(stage.sun), ball));
        const Image shadowed = picture_of(stage);
        stage.set_shadow(false);
        const Image plain = picture_of(stage);
        int compared = 0;
        for (int row = 0; row < mesh_picture.y; ++row) {
            for (int col = 0; col < mesh_picture.x; ++col) {
                const double away =
                    glm::distance(glm::dvec2(col, row) + 0.5, 0.5 * glm::dvec2(mesh_picture));
                if (away < 40.0) {
                    ++compared;
                    ASSERT_NEAR(shadowed(col, row).g, plain(col, row).g, 2)
                        << col << ' ' << row << ' ' << altitude;
                }
            }
        }
        EXPECT_GT(compared, 4000);
    }
}

// Rays on the CPU draw triangles with an error bound, too. From straight above, an error bound does
// not bound heights, and ground may cover objects: all samples are drawn.
TEST_F(MeshShadowGlTest, OnTrianglesTheyAreThoseOfRays) {
    for (const bool is_map : {false, true}) {
        ObjectStage stage(true, hills_and_wall());
        is_map ? stage.look_from_above() : stage.look_near();
        stage.set_technique("polygons:error=0.25,shadow=hard");
        const Image rays = stage.drawn();
        stage.set_technique("polygons:shadow=hard");
        const Image shown = picture_of(stage);
        EXPECT_LE(test::share_of_others(shown, rays, 16), 0.02) << is_map;
        EXPECT_LE(test::share_of_others(picture_of(stage, mesh_picture, 4), shown, 48), 0.06);
        stage.set_technique("polygons");
        EXPECT_GE(test::share_of_others(picture_of(stage), rays, 16), 0.05) << is_map;
        if (!is_map) {
            for (const char* const technique : {"polygons:error=0.25", "auto:error=0.25"}) {
                stage.set_technique(std::string(technique) + ",shadow=hard");
                EXPECT_LE(test::share_of_others(picture_of(stage), shown, 16), 0.01) << technique;
            }
        }
    }
}

TEST_F(MeshShadowGlTest, OnTrianglesOfAStreamTheyAreThoseInMemory) {
    ObjectStage stage(true, hills_and_wall());
    ObjectStage streamed(true, hills_and_wall());
    for (ObjectStage* const one : {&stage, &streamed}) {
        one->set_technique("polygons:shadow=hard");
        one->look_near();
    }
    test::stream_samples(*streamed.terrain->get<scene::TerrainNode>(), test::SeenLevels::finest);
    render::bring_tiles(streamed.scene, mesh_picture);
    EXPECT_LE(test::share_of_others(picture_of(streamed), picture_of(stage), 24), 0.03);
}

// A level tile of one colour changes nothing on ground, so its shadows are those of rays, too.
TEST_F(MeshShadowGlTest, OnGroundWithDetailTheyAreThoseOfRays) {
    for (const char* const technique : {"texture", "normal", "exact"}) {
        ObjectStage stage(true, hills_and_wall());
        stage.look_near();
        stage.set_technique("polygons:error=0.25,shadow=hard");
        const Image rays = stage.drawn();
        const Image without = picture_of(stage);
        stage.terrain->get<scene::TerrainNode>()->detail = gray_detail(technique);
        const Image shown = picture_of(stage);
        EXPECT_LE(test::share_of_others(shown, rays, 16), 0.02) << technique;
        EXPECT_GE(test::share_of_others(shown, without, 0), 0.01) << technique << ": is drawn";
        stage.set_technique("polygons:error=0.25");
        EXPECT_GE(test::share_of_others(picture_of(stage), rays, 16), 0.05) << technique;
    }
}

// A level relief on meshes changes nothing, so its shadows are those of rays at their pictures.
TEST_F(MeshShadowGlTest, OnReliefOfMeshesTheyAreThoseOfRays) {
    ObjectStage stage(true, hills_and_wall());
    stage.look_near();
    stage.set_textures("texture");
    const Image rays = stage.drawn();
    for (const char* const technique : {"texture", "exact", "relief:edges=smooth"}) {
        stage.set_textures(technique);
        stage.set_shadow(true);
        EXPECT_LE(test::share_of_others(picture_of(stage), rays, 16), 0.01) << technique;
        stage.set_shadow(false);
        EXPECT_GE(test::share_of_others(picture_of(stage), rays, 16), 0.05) << technique;
    }
}

// Layers have holes: they cast no shadow of their whole area.
TEST_F(MeshShadowGlTest, LayersCastNoShadows) {
    ObjectStage stage;
    stage.remove_meshes();
    stage.look_near();
    stage.add(scene::plane_mesh({50.0F, 50.0F}), {0.0, -20.0}, picture_on_mesh());
    stage.set_textures("lattice");
    const view::DrawList list = view::select(stage.scene, mesh_picture).list;
    EXPECT_FALSE(list.meshes.empty());
    EXPECT_TRUE(render::shadow_casters(list).empty());
    stage.set_textures("texture");
    EXPECT_FALSE(render::shadow_casters(view::select(stage.scene, mesh_picture).list).empty());
}

// The parts of a picture have the same maps, so all pixels are those of one piece.
TEST_F(MeshShadowGlTest, PartsOfAPictureHaveNoSeam) {
    ObjectStage stage;
    stage.set_sun(40.0);
    stage.look_near();
    const Image whole = picture_of(stage);
    const scene::Camera camera = *stage.camera->get<scene::Camera>();
    const glm::ivec2 part_size = mesh_picture / 2;
    for (const glm::ivec2 first : {glm::ivec2(0), part_size}) {
        *stage.camera->get<scene::Camera>() =
            scene::part_camera(camera, mesh_picture, {first, part_size});
        const Image part = picture_of(stage, part_size);
        int others = 0;
        for (int row = 0; row < part_size.y; ++row) {
            for (int col = 0; col < part_size.x; ++col) {
                others += std::abs(part(col, row).g - whole(first.x + col, first.y + row).g) > 2;
            }
        }
        EXPECT_LE(others, part_size.x * part_size.y / 1000);
    }
}

// A mesh beside the view, whose shadow falls into it or not.
TEST_F(MeshShadowGlTest, OnlyShadowsThatMayBeSeenUploadTheirMeshes) {
    const auto uploads_with = [](std::optional<glm::dvec3> place, bool has_shadows) {
        ObjectStage stage(has_shadows);
        stage.set_sun(40.0);
        stage.look_near();
        if (place) {
            stage.scene.add_mesh(scene::sphere_mesh(9.0F)).set_position(*place);
            EXPECT_EQ(view::select(stage.scene, mesh_picture).list.meshes_beside.size(), 1U);
        }
        return stats_of(stage).uploads;
    };
    ObjectStage stage;
    stage.set_sun(40.0);
    const glm::dvec3 sunwards = glm::dvec3(0.0, -40.0, 10.0) + 130.0 * scene::to_light(stage.sun);
    const glm::dvec3 behind(60.0, -260.0, 20.0);
    const auto uploads = uploads_with(std::nullopt, true);
    EXPECT_EQ(uploads_with(sunwards, true), uploads + 2) << "vertices and indices";
    EXPECT_EQ(uploads_with(behind, true), uploads);
    EXPECT_EQ(uploads_with(sunwards, false), uploads_with(std::nullopt, false));
}

TEST_F(MeshShadowGlTest, WithoutMeshesOrTheOptionTheyCostNothing) {
    ObjectStage stage;
    stage.look_near();
    const auto with = stats_of(stage);
    stage.set_shadow(false);
    const auto without = stats_of(stage);
    EXPECT_GT(with.draws, without.draws) << "the maps";
    EXPECT_EQ(with.triangles, without.triangles);
    EXPECT_EQ(without.draws, 7) << "ground, its beams, four meshes, and the sky";
    stage.set_shadow(true);
    stage.remove_meshes();
    EXPECT_EQ(stats_of(stage).draws, 3) << "ground, its beams, and the sky";
    stage.set_technique("polygons:error=1");
    const auto triangles = stats_of(stage);
    stage.set_technique("polygons:error=1,shadow=hard");
    EXPECT_EQ(stats_of(stage).draws, triangles.draws);
}

// Its shadow on meshes is one map of its samples, again only in another light.
TEST_F(MeshShadowGlTest, ShadowsOfGroundAreUploadedOnceForEachSun) {
    ObjectStage stage;
    stage.look_near();
    session::SceneRenderer made = test::must(test::make_renderer(mesh_picture));
    const auto bytes_after = [&](double altitude) {
        stage.set_sun(altitude);
        return test::must(made.draw(stage.scene)).upload_bytes;
    };
    bytes_after(20.0);
    const std::size_t in_other_light = bytes_after(30.0);
    stage.look_from_above();
    EXPECT_LT(bytes_after(30.0), 10'000U) << "the light stays";
    stage.remove_meshes();
    bytes_after(20.0);
    const std::size_t without_meshes = bytes_after(30.0);
    constexpr std::size_t map_bytes = sizeof(glm::vec2) * 301 * 257;
    EXPECT_GE(in_other_light, without_meshes + map_bytes);
    EXPECT_LT(in_other_light, without_meshes + map_bytes * 4 / 3 + 10'000U);
}

} // namespace
} // namespace reljef::cast
