#include "engine/cast/frame/driver.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include "engine/scene/graph/daylight.h"
#include "engine/scene/graph/picture_detail.h"
#include "engine/scene/graph/terrain_base.h"
#include "engine/scene/motion/poses.h"
#include "engine/truth/draw.h"
#include "engine/truth/image_error.h"
#include "engine/view/sample_count.h"
#include "tests/cast/frame/compared_pictures.h"
#include "tests/cast/frame/object_stage.h"
#include "tests/cast/made_rays.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_stream.h"
#include "tests/scene/streaming/streamed_samples.h"
#include "tests/session/made_session.h"
#include "tests/support/release_only.h"
#include "tests/terrain/chance.h"

namespace reljef::cast {
namespace {

constexpr glm::ivec2 small_picture{320, 240};
constexpr std::array seen_poses{scene::Pose::overview, scene::Pose::low, scene::Pose::grazing,
                                scene::Pose::map};

// Hills below a sun and a hazy sky, drawn by exact rays.
struct LitStage : Stage {
    LitStage() : Stage(test::hills(301, 257, 12.0), {1.0, 1.0}) {
        light = &scene.add_light();
        scene.set_sky({.visibility = 900.0, .plane = {}});
        use(scene::Technique{scene::Exact{}});
    }
    scene::Node* light = nullptr;

    void use(const scene::Technique& technique) {
        terrain->get<scene::TerrainNode>()->material.technique = technique;
    }
    void look_from(scene::Pose pose) {
        look(scene::pose_camera(pose, surface().bounds(), [&](double x, double y) {
            return surface().height_at(x, y).value_or(0.0);
        }));
    }
};

Image drawn_by_rays(const scene::Scene& scene, unsigned threads = 0) {
    Driver driver = test::must(Driver::create({.size = small_picture, .threads = threads}));
    test::must(driver.draw(view::select(scene, small_picture)));
    return driver.read_color();
}

class CastDriverGlTest : public test::GlTest {
protected:
    static Image drawn_by_opengl(const scene::Scene& scene) {
        session::SceneRenderer made = test::must(test::make_renderer(small_picture));
        test::must(made.draw(scene));
        return made.read_color();
    }
};

// The shaders filter with derivatives of four pixels and round colours to bytes.
TEST_F(CastDriverGlTest, DrawsWhatTheShadersDraw) {
    LitStage stage;
    for (const scene::Pose pose : seen_poses) {
        stage.look_from(pose);
        const Image rays = drawn_by_rays(stage.scene);
        const Image shaders = drawn_by_opengl(stage.scene);
        const auto errors = truth::image_errors(rays, shaders);
        ASSERT_TRUE(errors);
        EXPECT_LE(errors->rmse, 0.005) << scene::to_string(pose);
        EXPECT_LE(errors->flip.mean, 0.02) << scene::to_string(pose);
        EXPECT_LE(test::share_of_others(rays, shaders, 2), 0.01) << scene::to_string(pose);
    }
}

// Low sun, thinning air of three colours and a plane: no channel of the background differs by more
// than two levels. On the terrain, filters of the lit map differ in up to 2.5 % of the pixels
// without any air; the air adds nothing to that.
TEST_F(CastDriverGlTest, DrawsTheSameDaylightAsTheShaders) {
    constexpr std::array altitudes{3.0, 40.0};
    for (const double altitude : std::span(altitudes).first(std::size_t{test::rounds(2, 1)})) {
        LitStage stage;
        const scene::Daylight daylight = scene::daylight_at(altitude, 2.0);
        scene::Light sun{.azimuth = 20.0, .altitude = altitude};
        sun.color = daylight.sun;
        sun.ambient = daylight.ambient;
        *stage.light->get<scene::Light>() = sun;
        scene::Sky sky = daylight.sky;
        sky.visibility = 700.0;
        sky.air_height = 60.0;
        sky.base = stage.surface().bounds().low.z;
        sky.plane = glm::vec3(0.4F, 0.5F, 0.6F);
        sky.is_plane_sea = altitude > 10.0;
        sky.radius = altitude > 10.0 ? 0.0 : 2e4; // metres: the picture shows its horizon
        stage.scene.set_sky(sky);
        for (const scene::Pose pose :
             {scene::Pose::overview, scene::Pose::low, scene::Pose::grazing, scene::Pose::map}) {
            stage.terrain->set_visible(true);
            stage.look_from(pose);
            const double hazy =
                test::share_of_others(drawn_by_rays(stage.scene), drawn_by_opengl(stage.scene), 2);
            stage.scene.remove_sky();
            const double bare =
                test::share_of_others(drawn_by_rays(stage.scene), drawn_by_opengl(stage.scene), 2);
            EXPECT_LE(hazy, std::max(bare, 0.01)) << scene::to_string(pose) << ' ' << altitude;
            stage.scene.set_sky(sky);
            stage.terrain->set_visible(false);
            EXPECT_EQ(
                test::share_of_others(drawn_by_rays(stage.scene), drawn_by_opengl(stage.scene), 2),
                0.0)
                << scene::to_string(pose) << ' ' << altitude;
        }
    }
}

std::shared_ptr<const scene::MeshNode> base_below(const scene::TerrainSurface& surface) {
    scene::MeshNode node;
    node.mesh = std::make_shared<const scene::Mesh>(
        scene::terrain_base(surface, scene::block_bottom(surface)).value());
    node.material.color = glm::vec3(0.5F, 0.1F, 0.05F);
    return std::make_shared<const scene::MeshNode>(node);
}

TEST_F(CastDriverGlTest, DrawsTheBaseAsTheShadersDo) {
    LitStage stage;
    const auto base = base_below(stage.surface());
    const Box bounds = stage.surface().bounds();
    const glm::dvec3 size = bounds.size();
    for (const glm::dvec3 side :
         {glm::dvec3(0.3, -1.0, 0.3), glm::dvec3(0.9, 0.8, 0.15), glm::dvec3(-0.7, 0.05, -0.02)}) {
        scene::Camera camera;
        camera.eye = bounds.center() + side * glm::dvec3(size.x, size.x, size.x);
        camera.target = bounds.center();
        for (const auto kind :
             {scene::ProjectionKind::perspective, scene::ProjectionKind::orthographic}) {
            camera.projection = kind;
            camera.view_height = size.x;
            stage.look(camera);
            stage.terrain->get<scene::TerrainNode>()->base = nullptr;
            const Image bare = drawn_by_rays(stage.scene);
            stage.terrain->get<scene::TerrainNode>()->base = base;
            const Image rays = drawn_by_rays(stage.scene);
            EXPECT_GT(test::share_of_others(rays, bare, 2), 0.02) << side.x;
            // Pixels at the borders of ground and walls belong to one or the other.
            EXPECT_LE(test::share_of_others(rays, drawn_by_opengl(stage.scene), 2), 0.03) << side.x;
        }
    }
}

// Walls are seen from outside only, whatever is near the eye.
TEST(CastDriver, ABaseIsHiddenFromWithinAndLeavesHitsAsTheyAre) {
    LitStage stage;
    stage.look_from(scene::Pose::low);
    const Image bare = drawn_by_rays(stage.scene);
    stage.look_from(scene::Pose::overview);
    Driver driver = test::must(Driver::create({.size = small_picture}));
    const auto hits = test::must(driver.draw_hits(view::select(stage.scene, small_picture))).hits;
    stage.terrain->get<scene::TerrainNode>()->base = base_below(stage.surface());
    const auto same = test::must(driver.draw_hits(view::select(stage.scene, small_picture))).hits;
    EXPECT_EQ(std::memcmp(hits.samples().data(), same.samples().data(), hits.size() * sizeof(Hit)),
              0);
    stage.look_from(scene::Pose::low);
    EXPECT_EQ(drawn_by_rays(stage.scene), bare);
}

// Of ground, sky and meshes, with several samples too.
TEST(CastDriver, AFrameKeepsTheDepthsOfItsHits) {
    ObjectStage stage;
    scene::Camera camera = test::camera_at({-150.0, -260.0, 40.0}, {0.0, 0.0, 0.0});
    for (const auto kind :
         {scene::ProjectionKind::perspective, scene::ProjectionKind::orthographic}) {
        camera.projection = kind;
        camera.view_height = 200.0;
        stage.look(camera);
        const view::FrameView frame = view::select(stage.scene, small_picture);
        for (const int samples : {1, 4}) {
            Driver driver = test::must(Driver::create({.size = small_picture, .samples = samples}));
            const HitBuffer hits = test::must(driver.draw_hits(frame)).hits;
            test::must(driver.draw(frame, true));
            ASSERT_EQ(driver.depths().size(), hits.size());
            int grounds = 0;
            int skies = 0;
            int meshes = 0;
            for (std::size_t i = 0; i < hits.size(); ++i) {
                const Hit& hit = hits.samples()[i];
                const float depth = driver.depths().samples()[i];
                const bool is_mesh = !hit.is_sky() && hit.col < 0.0F;
                ++(hit.is_sky() ? skies : is_mesh ? meshes : grounds);
                if (is_mesh) { // found in double precision
                    ASSERT_NEAR(depth, hit.depth, 1e-6 * hit.depth);
                } else {
                    ASSERT_EQ(depth, hit.depth);
                }
            }
            EXPECT_GT(std::min({grounds, skies, meshes}), 500);
            test::must(driver.draw(frame));
            EXPECT_TRUE(driver.depths().empty());
        }
    }
}

// The middle row of a level view of odd height, and all rows of a level view without perspective:
// such rays were taken for falling, and ended before they began.
TEST(CastDriver, LevelRaysHitWhatStandsInTheirWay) {
    constexpr glm::ivec2 odd_picture{81, 61};
    LitStage stage;
    const Box bounds = stage.surface().bounds();
    const double middle = bounds.center().z;
    scene::Camera camera;
    camera.eye = {bounds.low.x - 20.0, 3.0, middle};
    camera.target = {0.0, 3.0, middle};
    camera.vertical_fov = 20.0;
    camera.view_height = bounds.size().z;
    Driver driver = test::must(Driver::create({.size = odd_picture}));
    for (const auto projection :
         {scene::ProjectionKind::perspective, scene::ProjectionKind::orthographic}) {
        camera.projection = projection;
        stage.look(camera);
        const auto hits = test::must(driver.draw_hits(view::select(stage.scene, odd_picture))).hits;
        const auto truth = test::must(truth::draw_hits(stage.scene, odd_picture));
        int ground = 0;
        int others = 0;
        for (int col = 0; col < odd_picture.x; ++col) {
            ground += truth(col, odd_picture.y / 2).is_sky() ? 0 : 1;
            others +=
                truth(col, odd_picture.y / 2).is_sky() != hits(col, odd_picture.y / 2).is_sky() ? 1
                                                                                                : 0;
        }
        EXPECT_GT(ground, 10);
        EXPECT_LE(others, 1);
    }
}

TEST_F(CastDriverGlTest, DrawsSkyAndSunWithoutTerrain) {
    LitStage stage;
    stage.terrain->set_visible(false);
    scene::Camera camera;
    const scene::Light sun;
    camera.target = camera.eye + scene::to_light(sun) + glm::dvec3(0.1, 0.0, 0.1);
    stage.look(camera);
    const Image rays = drawn_by_rays(stage.scene);
    const auto errors = truth::image_errors(rays, drawn_by_opengl(stage.scene));
    ASSERT_TRUE(errors);
    EXPECT_LE(errors->rmse, 0.002);
    stage.scene.remove_sky();
    const auto black = drawn_by_rays(stage.scene);
    EXPECT_EQ(black(3, 4), drawn_by_opengl(stage.scene)(3, 4));
}

TEST(CastDriver, DrawsTheSameBitsOnAnyThreads) {
    LitStage stage;
    stage.look_from(scene::Pose::low);
    EXPECT_EQ(drawn_by_rays(stage.scene, 1), drawn_by_rays(stage.scene, 3));
}

Image drawn_with(const scene::Scene& scene, const DriverOptions& options) {
    Driver driver = test::must(Driver::create(options));
    test::must(driver.draw(view::select(scene, options.size)));
    return driver.read_color();
}

// Against as many samples everywhere: at most 2 levels off on 99 % of the pixels.
TEST(CastDriver, SamplesWhereTheyChangeThePicture) {
    LitStage stage;
    for (const scene::Pose pose : std::span(seen_poses).first(std::size_t{test::rounds(4, 1)})) {
        stage.look_from(pose);
        const Image one = drawn_by_rays(stage.scene);
        for (const int samples : {2, 4, 8, 16}) {
            DriverOptions options{.size = small_picture, .samples = samples};
            const Image some = drawn_with(stage.scene, options);
            options.threads = 3;
            EXPECT_EQ(drawn_with(stage.scene, options), some) << "on any threads";
            options.samples_all = true;
            const Image all = drawn_with(stage.scene, options);
            EXPECT_LE(test::share_of_others(some, all, 2), 0.01)
                << scene::to_string(pose) << ' ' << samples;
            EXPECT_LE(test::share_of_others(some, all, 2), 0.5 * test::share_of_others(one, all, 2))
                << scene::to_string(pose) << ' ' << samples;
        }
    }
}

TEST(CastDriver, ChoosesFourSamples) {
    LitStage stage;
    stage.look_from(scene::Pose::low);
    DriverOptions options{.size = small_picture, .samples = view::automatic_samples};
    const Image chosen = drawn_with(stage.scene, options);
    options.samples = 4;
    EXPECT_EQ(chosen, drawn_with(stage.scene, options));
    EXPECT_NE(chosen, drawn_by_rays(stage.scene));
}

class ExactSources : public testing::TestWithParam<test::SampleSource> {};

INSTANTIATE_TEST_SUITE_P(CastDriver, ExactSources, test::exact_sources(), test::name_of_source);

TEST_P(ExactSources, AreWhereTheTruthIs) {
    LitStage stage;
    test::give_samples(*stage.terrain->get<scene::TerrainNode>(), GetParam());
    stage.look_from(scene::Pose::overview);
    render::bring_tiles(stage.scene, small_picture);
    Driver driver = test::must(Driver::create({.size = small_picture}));
    const auto drawn = test::must(driver.draw_hits(view::select(stage.scene, small_picture)));
    const auto errors = stage.errors(drawn.hits, stage.truth(small_picture));
    EXPECT_EQ(errors.wrong, 0U);
    EXPECT_EQ(drawn.stats.rays, drawn.hits.size());
}

class AllSources : public CastDriverGlTest,
                   public testing::WithParamInterface<test::SampleSource> {};

INSTANTIATE_TEST_SUITE_P(CastDriver, AllSources, test::all_sources(), test::name_of_source);

// By rays and by triangles, from near and from far.
TEST_P(AllSources, AreAsNearToTheTruthAsStated) {
    LitStage stage;
    test::give_samples(*stage.terrain->get<scene::TerrainNode>(), GetParam());
    scene::Polygons bounded;
    bounded.error = 0.7;
    Driver rays = test::must(Driver::create({.size = small_picture}));
    session::SceneRenderer triangles = test::must(test::make_renderer(small_picture));
    int coarse_tiles = 0;
    for (const scene::Pose pose : seen_poses) {
        stage.look_from(pose);
        const HitBuffer truth = stage.truth(small_picture);
        for (const bool by_rays : {true, false}) {
            SCOPED_TRACE(fmt::format("{}, {}", scene::to_string(pose), by_rays));
            stage.use(by_rays ? scene::Technique{scene::Exact{}} : scene::Technique{bounded});
            render::bring_tiles(stage.scene, small_picture);
            triangles.select(stage.scene);
            const view::DrawnHits drawn =
                test::must(by_rays ? rays.draw_hits(view::select(stage.scene, small_picture))
                                   : triangles.draw_selected_hits());
            const view::FrameStats& stats = drawn.stats;
            const auto errors = stage.errors(drawn.hits, truth);
            ASSERT_TRUE(errors.reprojection.distribution);
            EXPECT_EQ(errors.reprojection.unbounded, 0U);
            EXPECT_LE(errors.reprojection.distribution->max, stats.kept_error.value_or(0.0));
            if (GetParam() != test::SampleSource::finest_tiles) { // coarse ones have false errors
                EXPECT_LE(stats.kept_error.value_or(9.0), by_rays ? 1.0 : 0.7);
            }
            EXPECT_EQ(stats.tiles_unproven, 0);
            if (!by_rays) {
                const auto& tiles = triangles.select(stage.scene).list.tiles;
                coarse_tiles += static_cast<int>(
                    std::count_if(tiles.begin(), tiles.end(), [](const view::TileDraw& draw) {
                        return draw.tile->id.level > 0;
                    }));
            }
        }
    }
    EXPECT_EQ(coarse_tiles > 0, GetParam() == test::SampleSource::tiles);
}

TEST(CastDriver, KeepsErrorBoundsWithoutError) {
    LitStage stage;
    stage.look_from(scene::Pose::overview);
    const Image exact = drawn_by_rays(stage.scene);
    scene::Polygons bounded;
    bounded.error = 2.0;
    stage.use({bounded});
    Driver driver = test::must(Driver::create({.size = small_picture}));
    const auto stats = test::must(driver.draw(view::select(stage.scene, small_picture)));
    EXPECT_GT(stats.kept_error, 0.0); // what floats round
    EXPECT_LT(stats.kept_error, 0.01);
    EXPECT_EQ(driver.read_color(), exact);
}

// 0.00 px were stated beside steep ground, which turns what floats round of a place into a height,
// and nothing over nodes that are scaled.
TEST(CastDriver, StatesWhatFloatsRoundBesideSteepGround) {
    test::Chance chance(2);
    Grid<float> heights(2, 2);
    heights(0, 0) = 0.0F;
    heights(1, 0) = 10.0F;
    heights(0, 1) = 5.0F;
    heights(1, 1) = 100.0F;
    Stage stage(std::move(heights), {10.0, 10.0}, 100.0);
    stage.terrain->get<scene::TerrainNode>()->material.technique = {scene::Exact{}};
    Driver driver = test::must(Driver::create({.size = small_picture}));
    double largest = 0.0;
    for (int i = 0; i < test::rounds(120, 30); ++i) {
        const glm::dvec3 scale = i % 2 == 0 ? glm::dvec3(1.0) : glm::dvec3(30.0, 0.5, 7.0);
        stage.terrain->set_parent_from_local(glm::scale(glm::dmat4(1.0), scale));
        const glm::dvec2 below(chance.between(-4.9, 4.9), chance.between(-4.9, 4.9));
        const double ground = stage.surface().height_at(below.x, below.y).value();
        const glm::dvec3 eye =
            scale * glm::dvec3(below, ground + std::exp(chance.between(0.0, 6.0)));
        scene::Camera camera = test::camera_at(
            eye, eye + glm::dvec3(chance.between(-0.1, 0.1), chance.between(-0.1, 0.1), -1.0));
        camera.vertical_fov = 100.0;
        stage.look(camera);
        const auto drawn = test::must(driver.draw_hits(view::select(stage.scene, small_picture)));
        const auto errors = stage.errors(drawn.hits, stage.truth(small_picture));
        ASSERT_TRUE(drawn.stats.kept_error);
        if (errors.reprojection.distribution) {
            EXPECT_LE(errors.reprojection.distribution->max, *drawn.stats.kept_error) << i;
            largest = std::max(largest, double{errors.reprojection.distribution->max});
        }
    }
    EXPECT_GT(largest, 0.02); // far more than in other views
}

TEST(CastDriver, MakesMapsOnce) {
    LitStage stage;
    stage.look_from(scene::Pose::overview);
    Driver driver = test::must(Driver::create({.size = small_picture}));
    const auto first = test::must(driver.draw(view::select(stage.scene, small_picture)));
    EXPECT_EQ(first.uploads, 2);
    const auto second = test::must(driver.draw(view::select(stage.scene, small_picture)));
    EXPECT_EQ(second.uploads, 0);
    EXPECT_EQ(second.skipped.uploads_unchanged, 2);
}

std::string reason_against(const scene::Scene& scene) {
    Driver driver = test::must(Driver::create({.size = small_picture}));
    const auto drawn = driver.draw(view::select(scene, small_picture));
    return drawn ? std::string() : drawn.error().message;
}

TEST(CastDriver, NamesWhatItCannotDrawAndWhatDraws) {
    LitStage stage;
    stage.look_from(scene::Pose::overview);
    EXPECT_EQ(reason_against(stage.scene), "");
    stage.use({scene::Texture{}});
    EXPECT_EQ(reason_against(stage.scene),
              "rays on the CPU do not draw technique texture (exact or an error bound over one "
              "terrain was expected); --context osmesa does");
    scene::Technique shadowed{scene::Exact{}};
    shadowed.options.shadow = scene::Shadow{};
    stage.use(shadowed);
    EXPECT_NE(reason_against(stage.scene).find("shadow"), std::string::npos);
    stage.use({scene::Exact{}});
    auto& mesh = *stage.scene.add_mesh(scene::plane_mesh(glm::vec2(300.0F))).get<scene::MeshNode>();
    EXPECT_EQ(reason_against(stage.scene), "");
    mesh.material.detail.set =
        scene::picture_material(Image(1, 1, Rgba8{9, 9, 9, 255}), "grey").value();
    mesh.material.technique = scene::make_technique(scene::TechniqueId::relief);
    EXPECT_NE(reason_against(stage.scene).find("a mesh with technique relief"), std::string::npos);
    mesh.material.technique = scene::make_technique(scene::TechniqueId::texture);
    EXPECT_EQ(reason_against(stage.scene), "");
    mesh.material.wireframe = true;
    EXPECT_NE(reason_against(stage.scene).find("a wireframe"), std::string::npos);
}

TEST(CastDriver, RefusesSizesAndSamplesOutOfRange) {
    EXPECT_FALSE(Driver::create({.size = {0, 5}}));
    EXPECT_FALSE(Driver::create({.size = {5, 1 << 15}}));
    EXPECT_FALSE(Driver::create({.size = {5, 5}, .samples = 3}));
    EXPECT_TRUE(Driver::create({.size = {5, 5}, .samples = view::automatic_samples}));
}

} // namespace
} // namespace reljef::cast
