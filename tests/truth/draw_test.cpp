#include "engine/truth/draw.h"

#include <cmath>
#include <stop_token>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/render/made_scene.h"

namespace reljef::truth {
namespace {

// Hills of 128 × 96 m below a sun and a hazy sky.
scene::Scene hilly_scene() {
    scene::Scene scene;
    test::add_terrain(scene, test::plane_heightfield(test::hills(65, 49, 6.0), {2.0, 2.0}));
    scene.add_light();
    scene.set_sky({.visibility = 400.0});
    scene.add_camera(test::camera_at({-10.0, -70.0, 25.0}, {0.0, 0.0, 0.0}));
    return scene;
}

TEST(Draw, ShowsAtEachPixelWhatTheRayThroughItsCentreMeets) {
    const scene::Scene scene = hilly_scene();
    const glm::ivec2 size(57, 43);
    const auto picture = draw(scene, size);
    ASSERT_TRUE(picture);
    int terrain = 0;
    for (int row = 0; row < size.y; ++row) {
        for (int col = 0; col < size.x; ++col) {
            const Hit& hit = picture->hits(col, row);
            const auto expected =
                scene.pick(scene::view_ray(scene.camera(), size, glm::dvec2(col, row) + 0.5));
            ASSERT_EQ(hit.is_sky(), !expected);
            if (expected) {
                ++terrain;
                ASSERT_NEAR(hit.col, expected->ground->sample.x, 1e-5);
                ASSERT_NEAR(hit.row, expected->ground->sample.y, 1e-5);
                ASSERT_NEAR(hit.height, expected->ground->sample.z, 1e-5);
            }
        }
    }
    EXPECT_GT(terrain, 1000);
    EXPECT_LT(terrain, size.x * size.y);
}

// Through the whole chain backwards: sample, node, camera, pixel.
void expect_hits_project_to_their_pixels(const scene::Scene& scene, const scene::Node& node) {
    const glm::ivec2 size(41, 31);
    const auto hits = draw_hits(scene, size);
    ASSERT_TRUE(hits);
    int terrain = 0;
    for (int row = 0; row < size.y; ++row) {
        for (int col = 0; col < size.x; ++col) {
            const Hit& hit = (*hits)(col, row);
            if (hit.is_sky()) {
                continue;
            }
            ++terrain;
            const glm::dvec3 local = test::surface_of(node).placement().world_from_sample(
                {hit.col, hit.row, hit.height});
            const auto seen = scene::project(
                scene.camera(), size, glm::dvec3(node.world_from_local() * glm::dvec4(local, 1.0)));
            ASSERT_LE(glm::distance(seen.pixel, glm::dvec2(col, row) + 0.5), 2e-3)
                << col << ' ' << row;
            ASSERT_NEAR(hit.depth, seen.depth, 2e-5 * std::abs(seen.depth) + 1e-3);
        }
    }
    EXPECT_GT(terrain, 300);
}

TEST(Draw, HitsProjectToTheirPixelsWhateverTurnsNodeAndCamera) {
    for (const auto kind :
         {scene::ProjectionKind::perspective, scene::ProjectionKind::orthographic}) {
        scene::Scene scene;
        auto& node =
            test::add_terrain(scene, test::plane_heightfield(test::hills(65, 49, 6.0), {2.0, 2.0}),
                              {}, {.placement = {}, .exaggeration = 2.0});
        node.set_parent_from_local(
            glm::scale(glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(500.0, 40.0, -7.0)),
                                   0.5, glm::dvec3(0.2, 0.1, 1.0)),
                       glm::dvec3(1.2, 0.9, 1.4)));
        scene::Camera camera = test::camera_at({0.0, -120.0, 80.0}, {0.0, 0.0, 0.0});
        camera.projection = kind;
        camera.view_height = 90.0;
        scene.add_camera(camera).set_parent_from_local(
            glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(500.0, 40.0, 0.0)), 2.0,
                        glm::dvec3(0.0, 0.0, 1.0)));
        expect_hits_project_to_their_pixels(scene, node);
    }
}

TEST(Draw, HitsProjectToTheirPixelsOnTheEllipsoid) {
    scene::Scene scene;
    auto& node = test::add_terrain(
        scene, test::geographic_heightfield(test::hills(121, 101, 900.0), 46.0, 7.0, 0.01));
    scene.add_camera(test::camera_at({0.0, -90000.0, 40000.0}, {0.0, 0.0, 0.0}));
    expect_hits_project_to_their_pixels(scene, node);
}

TEST(Draw, OrthographicRaysBeginBeforeAllOfTheScene) {
    scene::Scene scene = hilly_scene();
    scene::Camera camera = test::camera_at({0.0, 0.0, -500.0}, {0.0, 0.0, -501.0});
    camera.up = {0.0, 1.0, 0.0};
    camera.projection = scene::ProjectionKind::orthographic;
    camera.view_height = 90.0;
    scene.set_active_camera(scene.add_camera(camera));
    const auto hits = draw_hits(scene, {12, 9});
    ASSERT_TRUE(hits);
    for (const Hit& hit : hits->samples()) {
        ASSERT_FALSE(hit.is_sky());
        ASSERT_NEAR(hit.depth, -500.0 - hit.height, 1e-3) << "behind the eye, from above";
    }
    EXPECT_NEAR((*hits)(0, 0).col, 32.0 + (0.5 * 10.0 - 60.0) / 2.0, 1e-5) << "10 m a pixel";
}

TEST(Draw, WhatIsNearerThanTheNearDepthIsNotSeen) {
    scene::Scene scene;
    test::add_terrain(scene, test::plane_heightfield(Grid<float>(9, 9, 1.0F)))
        .set_position({0.0, 0.0, 10.0});
    test::add_terrain(scene, test::plane_heightfield(Grid<float>(9, 9, 1.0F)));
    scene::Camera camera = test::camera_at({0.0, 0.0, 13.0}, {0.0, 0.0, 0.0});
    camera.vertical_fov = 10.0;
    auto& node = scene.add_camera(camera);
    EXPECT_NEAR((*draw_hits(scene, {1, 1}))(0, 0).depth, 2.0, 1e-6);
    node.get<scene::Camera>()->near = 2.5;
    EXPECT_NEAR((*draw_hits(scene, {1, 1}))(0, 0).depth, 12.0, 1e-6);
}

TEST(Draw, ASceneWithoutTerrainIsAllSky) {
    scene::Scene scene;
    const auto picture = draw(scene, {3, 2});
    ASSERT_TRUE(picture);
    EXPECT_TRUE(picture->hits(2, 1).is_sky());
    EXPECT_EQ(picture->hits(2, 1).col, -1.0F);
    EXPECT_EQ(picture->image(0, 0), (Rgba8{0, 0, 0, 255})) << "black without a sky";
}

// Level ground of one colour, unlit: what a pixel shows is known from its depth alone.
TEST(Draw, SeesThroughTheAirInPerspectiveOnly) {
    scene::Scene scene;
    test::add_terrain(scene, test::plane_heightfield(Grid<float>(9, 9, 0.0F), {100.0, 100.0}),
                      Image(9, 9, Rgba8{200, 90, 10, 255}));
    const scene::Sky sky{.visibility = 900.0};
    scene.set_sky(sky);
    scene::Camera camera = test::camera_at({0.0, -300.0, 100.0}, {0.0, 0.0, 0.0});
    camera.view_height = 300.0;
    auto& node = scene.add_camera(camera);
    const glm::vec3 albedo = linear_from_rgba8({200, 90, 10, 255});
    const glm::ivec2 size(16, 12);
    for (const auto kind :
         {scene::ProjectionKind::perspective, scene::ProjectionKind::orthographic}) {
        node.get<scene::Camera>()->projection = kind;
        const auto picture = draw(scene, size);
        for (int i = 0; i < size.x * size.y; ++i) {
            const glm::ivec2 pixel(i % size.x, i / size.x);
            const Ray ray = scene::view_ray(scene.camera(), size, glm::dvec2(pixel) + 0.5);
            const Hit& hit = picture->hits(pixel.x, pixel.y);
            const double distance = glm::distance(ray.origin, ray.at(hit.depth));
            const glm::vec3 ground = kind == scene::ProjectionKind::perspective
                                         ? seen_through_air(sky, {}, albedo, ray, distance)
                                         : albedo;
            const Rgba8 expected =
                rgba8_from_linear(hit.is_sky() ? sky_color(sky, {}, ray) : ground);
            ASSERT_NEAR(picture->image(pixel.x, pixel.y).r, expected.r, 1) << i;
            ASSERT_NEAR(picture->image(pixel.x, pixel.y).b, expected.b, 1) << i;
        }
        EXPECT_FALSE(picture->hits(8, 6).is_sky());
        EXPECT_TRUE(picture->hits(8, 0).is_sky());
    }
}

TEST(Draw, TheTechniqueChangesNothing) {
    scene::Scene scene = hilly_scene();
    const auto polygons = draw(scene, {32, 24});
    scene.root().children().front()->get<scene::TerrainNode>()->material.technique =
        scene::make_technique(scene::TechniqueId::texture);
    const auto flat = draw(scene, {32, 24});
    EXPECT_EQ(polygons->image, flat->image);
}

DrawOptions two_rays(unsigned threads) {
    DrawOptions options;
    options.rays_per_side = 2;
    options.parallel.threads = threads;
    return options;
}

TEST(Draw, IsTheSameWithAnyNumberOfThreads) {
    const scene::Scene scene = hilly_scene();
    const auto one = draw(scene, {64, 48}, two_rays(1));
    for (const unsigned threads : {2U, 3U, 8U}) {
        const auto many = draw(scene, {64, 48}, two_rays(threads));
        EXPECT_EQ(one->image, many->image);
        for (std::size_t i = 0; i < one->hits.size(); ++i) {
            const Hit& a = one->hits.samples()[i];
            const Hit& b = many->hits.samples()[i];
            ASSERT_TRUE(a.col == b.col && a.row == b.row && a.depth == b.depth);
        }
    }
}

// A white step before black: the pixel on the edge is grey by the share of its rays.
TEST(Draw, ManyRaysShowTheLinearMeanAndLeaveTheHit) {
    scene::Scene scene;
    test::add_terrain(scene, test::plane_heightfield(Grid<float>(9, 9, 0.0F)),
                      Image(9, 9, Rgba8{255, 255, 255, 255}));
    scene::Camera camera = test::camera_at({4.0, 0.0, 10.0}, {4.0, 0.0, 0.0});
    camera.up = {0.0, 1.0, 0.0};
    camera.projection = scene::ProjectionKind::orthographic;
    camera.view_height = 1.0;
    scene.add_camera(camera);
    // The border is at x = 4: the middle of the only pixel, whose rays lie at −3/8, −1/8, 1/8, 3/8.
    const auto picture = draw(scene, {1, 1}, {.rays_per_side = 4, .parallel = {}});
    EXPECT_EQ(picture->image(0, 0), rgba8_from_linear(glm::vec3(0.5F)));
    EXPECT_FALSE(picture->hits(0, 0).is_sky()) << "the centre's ray, on the border itself";
    camera.eye.x = camera.target.x = 4.25;
    scene.set_active_camera(scene.add_camera(camera));
    const auto moved = draw(scene, {1, 1}, {.rays_per_side = 4, .parallel = {}});
    EXPECT_EQ(moved->image(0, 0), rgba8_from_linear(glm::vec3(0.25F)));
    EXPECT_TRUE(moved->hits(0, 0).is_sky());
}

TEST(Draw, ReportsProgressAndCanBeStopped) {
    const scene::Scene scene = hilly_scene();
    std::stop_source source;
    double last = 0.0;
    int calls = 0;
    ParallelOptions parallel;
    parallel.stop = source.get_token();
    parallel.progress = [&](double fraction) {
        last = fraction;
        ++calls;
    };
    ASSERT_TRUE(draw(scene, {16, 20}, {.rays_per_side = 1, .parallel = parallel}));
    EXPECT_EQ(last, 1.0);
    EXPECT_EQ(calls, 20);
    parallel.progress = [&](double) { source.request_stop(); };
    const auto stopped = draw(scene, {16, 200}, {.rays_per_side = 1, .parallel = parallel});
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().message, "the exact picture: drawing was stopped");
    EXPECT_FALSE(draw_hits(scene, {16, 20}, parallel));
}

TEST(Draw, AMeshHidesWhatIsBehindIt) {
    scene::Scene scene = hilly_scene();
    const HitBuffer bare = draw_hits(scene, {40, 30}).value();
    const Box bounds = scene.root().world_bounds();
    scene.add_mesh(scene::box_mesh({8.0F, 8.0F, 60.0F})).set_position(bounds.center());
    const HitBuffer hits = draw_hits(scene, {40, 30}).value();
    const Picture picture = draw(scene, {40, 30}).value();
    int on_mesh = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const Hit& hit = hits.samples()[i];
        const Hit& before = bare.samples()[i];
        EXPECT_EQ(picture.hits.samples()[i].depth, hit.depth);
        const bool shows_mesh = !hit.is_sky() && hit.col == -1.0F && hit.row == -1.0F;
        on_mesh += shows_mesh ? 1 : 0;
        EXPECT_TRUE(shows_mesh ? hit.depth <= before.depth : hit.depth == before.depth) << i;
    }
    EXPECT_GT(on_mesh, 10);
    EXPECT_LT(on_mesh, 1000);
}

} // namespace
} // namespace reljef::truth
