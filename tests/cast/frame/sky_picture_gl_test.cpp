#include <cmath>
#include <memory>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/cast/frame/driver.h"
#include "engine/scene/motion/poses.h"
#include "engine/truth/draw.h"
#include "engine/truth/image_error.h"
#include "tests/cast/frame/compared_pictures.h"
#include "tests/cast/made_rays.h"
#include "tests/gl/gl_fixture.h"
#include "tests/session/made_session.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::cast {
namespace {

constexpr glm::ivec2 sky_view{320, 240};

// A sky of waves in all directions, over hills without haze.
struct SkyStage : Stage {
    SkyStage() : Stage(test::hills(101, 97, 12.0), {1.0, 1.0}) {
        terrain->get<scene::TerrainNode>()->material.technique = scene::Technique{scene::Exact{}};
        scene.add_light();
        scene::Sky sky;
        sky.picture = std::make_shared<const material::SkyPicture>(256, [](glm::dvec3 to) {
            return glm::vec3(0.5 + 0.5 * glm::sin(20.0 * glm::normalize(to)));
        });
        scene.set_sky(sky);
    }
    // From the middle of the terrain, `altitude` above it.
    void look_towards(glm::dvec3 to) {
        scene::Camera camera;
        camera.eye = {0.0, 0.0, 40.0};
        camera.target = camera.eye + to;
        camera.vertical_fov = 80.0;
        look(camera);
    }
};

class SkyPictureGlTest : public test::GlTest {};

// All backends show the same picture: on all faces of the cube, at their edges, below the horizon.
TEST_F(SkyPictureGlTest, BackendsAndTheTruthAgree) {
    SkyStage stage;
    session::SceneRenderer opengl = test::must(test::make_renderer(sky_view));
    Driver rays = test::must(Driver::create({.size = sky_view}));
    for (const glm::dvec3 to :
         {glm::dvec3(0, 1, 0.4), glm::dvec3(1, 0.2, 0.1), glm::dvec3(-1, -1, 0.9),
          glm::dvec3(0.1, 0, 1), glm::dvec3(-1, 0.1, -0.3)}) {
        stage.look_towards(to);
        test::must(opengl.draw(stage.scene));
        test::must(rays.draw(view::select(stage.scene, sky_view)));
        const Image by_rays = rays.read_color();
        const auto between = truth::image_errors(by_rays, opengl.read_color());
        ASSERT_TRUE(between);
        EXPECT_LE(between->rmse, 0.006) << to.x << " " << to.y;
        const auto truth = truth::draw(stage.scene, sky_view);
        const auto off = truth::image_errors(by_rays, test::must(truth).image);
        ASSERT_TRUE(off);
        EXPECT_LE(off->rmse, 0.006) << to.x << " " << to.y;
    }
}

// On the Earth, far from the terrain's middle, too.
TEST_F(SkyPictureGlTest, StandsUprightAtTheEye) {
    scene::Scene scene;
    scene::Node& node = test::add_terrain(
        scene, test::geographic_heightfield(test::hills(41, 41, 12.0), 46.0, 7.0, 0.01));
    node.get<scene::TerrainNode>()->material.technique = scene::Technique{scene::Exact{}};
    scene::Sky sky; // red northern sky, blue other sky, black below the horizon
    sky.picture = std::make_shared<const material::SkyPicture>(128, [](glm::dvec3 to) {
        const bool is_north = to.y > std::abs(to.x);
        return to.z < 0.0 ? glm::vec3(0.0F) : is_north ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
    });
    scene.set_sky(sky);
    const terrain::Placement& placement = test::surface_of(node).placement();
    Driver rays = test::must(Driver::create({.size = sky_view}));
    session::SceneRenderer opengl = test::must(test::make_renderer(sky_view));
    scene::Node& camera = scene.add_camera();
    for (const double longitude : {7.0, 17.0, -30.0}) {
        const glm::dvec3 eye = placement.world_from_geodetic({46.0, longitude, 5e4}).value();
        const glm::dvec3 up = placement.up(eye);
        scene::Camera at;
        at.eye = eye;
        at.up = up;
        at.target = eye + placement.north(eye);
        *camera.get<scene::Camera>() = at;
        test::must(rays.draw(view::select(scene, sky_view)));
        test::must(opengl.draw(scene));
        const auto true_picture = test::must(truth::draw(scene, sky_view)).image;
        for (const Image& picture : {rays.read_color(), opengl.read_color(), true_picture}) {
            for (const int col : {20, 160, 300}) {
                EXPECT_GE(picture(col, 115).r, 254) << longitude << ", " << col;
                EXPECT_LE(picture(col, 125).r, 1) << longitude << ", " << col;
            }
        }
    }
}

// The plane below the horizon hides the picture; another picture replaces it.
TEST_F(SkyPictureGlTest, FollowsTheScene) {
    SkyStage stage;
    stage.look_towards({0, 1, 0.1});
    Driver rays = test::must(Driver::create({.size = sky_view}));
    const auto drawn = [&] {
        test::must(rays.draw(view::select(stage.scene, sky_view)));
        return rays.read_color();
    };
    const Image waves = drawn();
    scene::Sky sky = *stage.scene.sky();
    sky.base = -1e4;
    sky.plane = glm::vec3(0.2F);
    stage.scene.set_sky(sky);
    const Image over_plane = drawn();
    EXPECT_EQ(over_plane(160, 20), waves(160, 20));
    EXPECT_NE(over_plane(160, 235), waves(160, 235));
    sky.picture = std::make_shared<const material::SkyPicture>(
        4, [](glm::dvec3) { return glm::vec3(1.0F, 0.0F, 0.0F); });
    stage.scene.set_sky(sky);
    const Rgba8 red = drawn()(160, 20);
    EXPECT_GE(red.r, 254);
    EXPECT_EQ(red.g, 0);
    stage.scene.remove_sky();
    EXPECT_EQ(drawn()(160, 20), (Rgba8{0, 0, 0, 255}));
}

} // namespace
} // namespace reljef::cast
