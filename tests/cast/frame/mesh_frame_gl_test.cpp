#include "engine/cast/frame/mesh_frame.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/cast/frame/driver.h"
#include "engine/scene/motion/poses.h"
#include "engine/truth/image_error.h"
#include "tests/cast/frame/compared_pictures.h"
#include "tests/cast/frame/object_stage.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_stream.h"
#include "tests/scene/streaming/streamed_samples.h"
#include "tests/session/made_session.h"

namespace reljef::cast {
namespace {

bool are_same(const HitBuffer& a, const HitBuffer& b) {
    return std::memcmp(a.samples().data(), b.samples().data(), a.size() * sizeof(Hit)) == 0;
}

// The truth has no mip levels, so textures may differ a little where they are small.
TEST(MeshFrame, MeshesAndShadowsAreThoseOfTheTruth) {
    ObjectStage stage;
    for (const bool is_map : {false, true}) {
        is_map ? stage.look_from_above() : stage.look_near();
        const Image shown = stage.drawn();
        const Image expected = stage.true_picture(truth::SunShadow::ray);
        const auto errors = truth::image_errors(shown, expected);
        ASSERT_TRUE(errors);
        EXPECT_LE(errors->rmse, 0.02) << is_map;
        EXPECT_LE(test::share_of_others(shown, expected, 16), 0.01) << is_map;
        // Without shadows of meshes it is another picture, and without meshes yet another one.
        const Image unshadowed = stage.true_picture(truth::SunShadow::sweep);
        EXPECT_GE(test::share_of_others(shown, unshadowed, 16), 0.03) << is_map;
    }
}

TEST(MeshFrame, WithoutTheOptionNothingCastsShadows) {
    ObjectStage stage(false);
    stage.look_near();
    const Image expected = stage.true_picture(truth::SunShadow::sweep);
    const Image shown = stage.drawn();
    EXPECT_LE(test::share_of_others(shown, expected, 16), 0.01);
}

TEST(MeshFrame, BillboardsAndTextAreThoseOfTheTruth) {
    ObjectStage stage;
    stage.look_near();
    const Image without = stage.drawn();
    stage.add_billboards();
    for (const bool is_map : {false, true}) {
        is_map ? stage.look_from_above() : stage.look_near();
        const Image shown = stage.drawn();
        const Image expected = stage.true_picture(truth::SunShadow::ray);
        EXPECT_LE(test::share_of_others(shown, expected, 16), 0.01) << is_map;
        EXPECT_GE(test::share_of_others(shown, without, 16), 0.03) << is_map;
    }
}

// A sign is as wide on the picture from wherever it is seen, and has the same light.
TEST(MeshFrame, ABillboardLooksTheSameFromAllSides) {
    scene::Scene scene;
    scene.add_light();
    scene::Node& sign = scene.add_mesh(scene::billboard_mesh({3.0F, 2.0F}), picture_on_mesh());
    sign.get<scene::MeshNode>()->facing = scene::Facing::upright;
    scene::Node& camera = scene.add_camera();
    const auto seen_from = [&](double angle) {
        *camera.get<scene::Camera>() =
            test::camera_at({5.0 * std::sin(angle), -5.0 * std::cos(angle), 0.0}, {});
        Driver driver = test::must(Driver::create({.size = mesh_picture}));
        test::must(driver.draw(view::select(scene, mesh_picture)));
        return driver.read_color();
    };
    const Image front = seen_from(0.0);
    EXPECT_NE(front(120, 120), front(0, 0)) << "it is there";
    for (const double angle : {0.7, 1.6, 3.0, 4.4}) {
        EXPECT_LE(test::share_of_others(front, seen_from(angle), 8), 0.01) << angle;
    }
}

TEST(MeshFrame, HitsAreThoseOfTheTruth) {
    ObjectStage stage;
    for (const bool is_map : {false, true}) {
        is_map ? stage.look_from_above() : stage.look_near();
        Driver driver = test::must(Driver::create({.size = mesh_picture}));
        const auto frame = view::select(stage.scene, mesh_picture);
        const HitBuffer shown = test::must(driver.draw_hits(frame)).hits;
        const HitBuffer expected = stage.truth(mesh_picture);
        int meshes = 0;
        int others = 0;
        for (int row = 0; row < shown.rows(); ++row) {
            for (int col = 0; col < shown.cols(); ++col) {
                const Hit& a = shown(col, row);
                const Hit& b = expected(col, row);
                meshes += b.col < 0.0F && !b.is_sky() ? 1 : 0;
                const bool is_same = a.is_sky() == b.is_sky() && (a.col < 0.0F) == (b.col < 0.0F) &&
                                     (a.is_sky() || std::abs(a.depth - b.depth) <= 0.01F);
                others += is_same ? 0 : 1;
            }
        }
        EXPECT_GT(meshes, 3000) << is_map;
        EXPECT_LE(others, 15) << is_map; // at outlines, where a float decides
    }
}

TEST(MeshFrame, HasTheSameBitsOnAnyThreads) {
    ObjectStage stage;
    stage.look_near();
    for (const int samples : {1, 4}) {
        EXPECT_EQ(stage.drawn({.size = mesh_picture, .threads = 1, .samples = samples}),
                  stage.drawn({.size = mesh_picture, .threads = 3, .samples = samples}));
    }
    const auto frame = view::select(stage.scene, mesh_picture);
    Driver one = test::must(Driver::create({.size = mesh_picture, .threads = 1}));
    Driver three = test::must(Driver::create({.size = mesh_picture, .threads = 3}));
    EXPECT_TRUE(
        are_same(test::must(one.draw_hits(frame)).hits, test::must(three.draw_hits(frame)).hits));
}

TEST(MeshFrame, OutlinesGetSeveralSamples) {
    ObjectStage stage;
    stage.look_near();
    const Image one = stage.drawn();
    const Image some = stage.drawn({.size = mesh_picture, .samples = 4});
    const Image all = stage.drawn({.size = mesh_picture, .samples = 4, .samples_all = true});
    EXPECT_GE(test::share_of_others(one, all, 16), 0.01);
    EXPECT_LE(test::share_of_others(some, all, 16), 0.25 * test::share_of_others(one, all, 16));
}

// A mesh whose picture has left the frame still casts its shadow into it.
TEST(MeshFrame, MeshesBesideThePictureCastShadows) {
    ObjectStage stage;
    stage.look(test::camera_at({30.0, -43.0, 70.0}, {32.0, -43.0, 0.0}));
    stage.camera->get<scene::Camera>()->vertical_fov = 20.0;
    ASSERT_FALSE(view::select(stage.scene, mesh_picture).list.meshes_beside.empty());
    const Image shown = stage.drawn();
    const Image expected = stage.true_picture(truth::SunShadow::ray);
    EXPECT_LE(test::share_of_others(shown, expected, 16), 0.02);
    stage.remove_meshes();
    EXPECT_GE(test::share_of_others(shown, stage.drawn(), 16), 0.05);
}

TEST(MeshFrame, MeshesAloneAreDrawnBeforeTheSky) {
    ObjectStage stage;
    stage.terrain->set_visible(false);
    stage.look_near();
    Driver driver = test::must(Driver::create({.size = mesh_picture}));
    const auto stats = test::must(driver.draw(view::select(stage.scene, mesh_picture)));
    EXPECT_EQ(stats.rays, static_cast<std::size_t>(mesh_picture.x * mesh_picture.y));
    const Image expected = stage.true_picture(truth::SunShadow::sweep);
    EXPECT_LE(test::share_of_others(driver.read_color(), expected, 16), 0.01);
}

TEST(MeshFrame, GroundHidesTheSunFromMeshes) {
    ObjectStage stage(true, hills_and_wall());
    for (const bool is_map : {false, true}) {
        is_map ? stage.look_from_above() : stage.look_near();
        const Image expected = stage.true_picture(truth::SunShadow::ray);
        EXPECT_LE(test::share_of_others(stage.drawn(), expected, 16), 0.01) << is_map;
    }
}

TEST(MeshFrame, ShadowsOverAStreamAreThoseInMemory) {
    ObjectStage stage(true, hills_and_wall());
    ObjectStage streamed(true, hills_and_wall());
    test::stream_samples(*streamed.terrain->get<scene::TerrainNode>(), test::SeenLevels::finest);
    stage.look_near();
    streamed.look_near();
    render::bring_tiles(streamed.scene, mesh_picture);
    const Image in_memory = stage.drawn();
    EXPECT_LE(test::share_of_others(streamed.drawn(), in_memory, 24), 0.03);
}

class MeshFrameGlTest : public test::GlTest {};

// OpenGL filters textures with derivatives of four pixels.
TEST_F(MeshFrameGlTest, MeshesAreThoseOfTheShaders) {
    ObjectStage stage(false);
    stage.add_billboards();
    for (const bool is_map : {false, true}) {
        is_map ? stage.look_from_above() : stage.look_near();
        session::SceneRenderer made = test::must(test::make_renderer(mesh_picture));
        test::must(made.draw(stage.scene));
        const Image shaders = made.read_color();
        const Image rays = stage.drawn();
        const auto errors = truth::image_errors(rays, shaders);
        ASSERT_TRUE(errors);
        EXPECT_LE(errors->rmse, 0.02) << is_map;
        EXPECT_LE(errors->flip.mean, 0.02) << is_map;
        EXPECT_LE(test::share_of_others(rays, shaders, 8), 0.02) << is_map;
    }
}

} // namespace
} // namespace reljef::cast
