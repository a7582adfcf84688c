#include "engine/render/driver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/render/frame_block.h"
#include "engine/scene/poses.h"
#include "engine/terrain/ray_cast.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_scene.h"

namespace reljef::render {
namespace {

using scene::Camera;
using scene::Node;
using scene::Scene;
using test::camera_at;
using test::surface_of;

constexpr glm::ivec2 size{320, 240};
constexpr double infinity = std::numeric_limits<double>::infinity();

class DriverGlTest : public test::GlTest {
protected:
    static Driver driver(glm::ivec2 picture = size) {
        return test::must(Driver::create({.size = picture, .shader_dir = {}, .software = true}));
    }
    static Image draw(const Scene& scene) {
        Driver made = driver();
        test::must(made.draw(scene));
        return made.read_color();
    }
};

int brightness(Rgba8 color) {
    return color.r + color.g + color.b;
}

Camera pose(scene::Pose which, const Node& node) {
    const auto& surface = surface_of(node);
    return scene::pose_camera(which, surface.bounds(), [&](double x, double y) {
        return surface.height_at(x, y).value_or(0.0);
    });
}

// A bumpy square of nine tiles, 300 m wide, with sun and sky.
struct World {
    Scene scene;
    Node* terrain = nullptr;
    Node* camera = nullptr;

    explicit World(double exaggeration = 1.0) {
        terrain = &test::add_terrain(scene, test::plane_heightfield(test::hills(301, 301, 12.0)),
                                     {}, {.placement = {}, .exaggeration = exaggeration});
        camera = &scene.add_camera(pose(scene::Pose::overview, *terrain));
        scene.add_light();
        scene.set_sky({});
    }
    void look(const Camera& at) { *camera->get<Camera>() = at; }
};

// Height of the triangles, split from the north-west to the south-east corner, at a place.
double triangle_height(const Grid<float>& heights, double col, double row) {
    const int c = std::clamp(static_cast<int>(col), 0, heights.cols() - 2);
    const int r = std::clamp(static_cast<int>(row), 0, heights.rows() - 2);
    const double u = col - c;
    const double v = row - r;
    const double h00 = heights(c, r);
    const double h10 = heights(c + 1, r);
    const double h01 = heights(c, r + 1);
    const double h11 = heights(c + 1, r + 1);
    return v >= u ? h00 + v * (h01 - h00) + u * (h11 - h01)
                  : h00 + u * (h10 - h00) + v * (h11 - h10);
}

// Greatest difference between two triangles and the bilinear patch of a cell: at its middle.
double triangle_excess(const Grid<float>& heights, double col, double row) {
    const int c = std::clamp(static_cast<int>(col), 0, heights.cols() - 2);
    const int r = std::clamp(static_cast<int>(row), 0, heights.rows() - 2);
    return 0.25 *
           std::abs(heights(c, r) - heights(c + 1, r) - heights(c, r + 1) + heights(c + 1, r + 1));
}

// What is true of the hits of a picture.
struct HitReport {
    int hits = 0;
    int off_triangles = 0;     // farther from the triangles than 2 mm
    double farthest_off = 0.0; // metres of height from the triangles
    double beyond_patch = 0.0; // metres farther from the bilinear patch than its triangles are
    double reprojection = 0.0; // pixels
    double depth_error = 0.0;  // share of the depth
};

HitReport report_of(const HitBuffer& hits, const Camera& camera, const Node& node) {
    const auto& surface = surface_of(node);
    const Grid<float>& heights = surface.heightfield().heights;
    const glm::ivec2 picture{hits.cols(), hits.rows()};
    HitReport report;
    for (int y = 0; y < picture.y; ++y) {
        for (int x = 0; x < picture.x; ++x) {
            const Hit& hit = hits(x, y);
            if (hit.is_sky()) {
                EXPECT_TRUE(hit.col == -1.0F && hit.row == -1.0F && hit.height == 0.0F);
                continue;
            }
            ++report.hits;
            const double off = std::abs(hit.height - triangle_height(heights, hit.col, hit.row));
            report.off_triangles += off > 2e-3 ? 1 : 0;
            report.farthest_off = std::max(report.farthest_off, off);
            const double from_patch =
                std::abs(hit.height - terrain::bilinear_height(heights.view(), {hit.col, hit.row}));
            report.beyond_patch = std::max(report.beyond_patch,
                                           from_patch - triangle_excess(heights, hit.col, hit.row));
            const glm::dvec3 local =
                surface.placement().world_from_sample({hit.col, hit.row, hit.height});
            const auto back = scene::project(
                camera, picture, glm::dvec3(node.world_from_local() * glm::dvec4(local, 1.0)));
            report.reprojection = std::max(report.reprojection,
                                           glm::distance(back.pixel, glm::dvec2(x + 0.5, y + 0.5)));
            report.depth_error =
                std::max(report.depth_error,
                         std::abs(back.depth - hit.depth) / std::max(std::abs(back.depth), 1.0));
        }
    }
    return report;
}

void expect_true_hits(const HitBuffer& hits, const Camera& camera, const Node& node) {
    const HitReport report = report_of(hits, camera, node);
    EXPECT_GT(report.hits, 10000);
    EXPECT_LE(report.reprojection, 0.01) << "pixels";
    EXPECT_LE(report.depth_error, 1e-4);
    // The rasterizer moves vertices by up to 1/512 pixel: a triangle seen edge-on shows a little
    // beyond its own border.
    EXPECT_LE(report.off_triangles, report.hits / 1000);
    EXPECT_LE(report.farthest_off, 0.05) << "metres, of 24";
    EXPECT_LE(report.beyond_patch, 0.05) << "metres, of 24";
}

TEST_F(DriverGlTest, HitsLieOnTheSurfaceAndProjectBackToTheirPixel) {
    World world;
    Driver made = driver();
    for (const auto which :
         {scene::Pose::overview, scene::Pose::low, scene::Pose::grazing, scene::Pose::map}) {
        world.look(pose(which, *world.terrain));
        const HitBuffer hits = test::must(made.draw_hits(world.scene));
        ASSERT_EQ(hits.cols(), size.x);
        ASSERT_EQ(hits.rows(), size.y);
        SCOPED_TRACE(to_string(which));
        expect_true_hits(hits, world.scene.camera(), *world.terrain);
    }
}

TEST_F(DriverGlTest, HitsOfAnExaggeratedTerrainAreInTrueMetres) {
    World world(3.0);
    const HitBuffer hits = test::must(driver().draw_hits(world.scene));
    expect_true_hits(hits, world.scene.camera(), *world.terrain);
}

TEST_F(DriverGlTest, HitsFollowATurnedAndMovedNode) {
    World world;
    world.terrain->set_parent_from_local(
        glm::rotate(glm::translate(glm::dmat4(1.0), {20.0, -10.0, 5.0}), 0.8, {0.1, 0.05, 1.0}));
    const HitBuffer hits = test::must(driver().draw_hits(world.scene));
    expect_true_hits(hits, world.scene.camera(), *world.terrain);
}

TEST_F(DriverGlTest, HitsOnAnEllipsoid) {
    Scene scene;
    Node& terrain = test::add_terrain(
        scene, test::geographic_heightfield(test::hills(301, 201, 600.0), 46.0, 7.0, 1.0 / 600.0));
    const Camera camera = pose(scene::Pose::overview, terrain);
    scene.add_camera(camera);
    const HitBuffer hits = test::must(driver().draw_hits(scene));
    int count = 0;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const Hit& hit = hits(x, y);
            if (!hit.is_sky()) {
                ++count;
                const auto back = scene::project(camera, size,
                                                 surface_of(terrain).placement().world_from_sample(
                                                     {hit.col, hit.row, hit.height}));
                ASSERT_LE(glm::distance(back.pixel, glm::dvec2(x + 0.5, y + 0.5)), 0.01)
                    << x << ' ' << y;
            }
        }
    }
    EXPECT_GT(count, 10000);
}

// What the exact rays say: whether each pixel shows the terrain.
Grid<std::uint8_t> exact_cover(const Camera& camera, const Node& node) {
    Grid<std::uint8_t> cover(size.x, size.y, 0);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const Ray ray = scene::view_ray(camera, size, {x + 0.5, y + 0.5});
            cover(x, y) = surface_of(node).pick(ray) ? 1 : 0;
        }
    }
    return cover;
}

// Whether all pixels around show the same as this one.
bool is_inner(const Grid<std::uint8_t>& cover, int col, int row) {
    for (int y = row - 1; y <= row + 1; ++y) {
        for (int x = col - 1; x <= col + 1; ++x) {
            if (cover.clamped(x, y) != cover(col, row)) {
                return false;
            }
        }
    }
    return true;
}

TEST_F(DriverGlTest, ThePictureShowsTheTerrainExactlyWhereTheExactRaysDo) {
    World world;
    Driver made = driver();
    for (const auto which : {scene::Pose::overview, scene::Pose::low, scene::Pose::grazing}) {
        world.look(pose(which, *world.terrain));
        const HitBuffer hits = test::must(made.draw_hits(world.scene));
        const auto cover = exact_cover(world.scene.camera(), *world.terrain);
        int inner = 0;
        int wrong = 0;
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                if (is_inner(cover, x, y)) {
                    ++inner;
                    wrong += hits(x, y).is_sky() == (cover(x, y) != 0) ? 1 : 0;
                }
            }
        }
        EXPECT_GT(inner, size.x * size.y / 2);
        EXPECT_EQ(wrong, 0) << to_string(which);
    }
}

// Pixels of a picture that show sky although their ray meets all heights inside the border.
int holes_in(const HitBuffer& hits, const Camera& camera, const Box& bounds) {
    int holes = 0;
    for (int y = 0; y < hits.rows(); ++y) {
        for (int x = 0; x < hits.cols(); ++x) {
            const Ray ray = scene::view_ray(camera, {hits.cols(), hits.rows()}, {x + 0.5, y + 0.5});
            const glm::dvec3 deep = ray.at((bounds.low.z - camera.eye.z) / ray.direction.z);
            const bool inside = ray.direction.z < 0.0 && deep.x > bounds.low.x &&
                                deep.x < bounds.high.x && deep.y > bounds.low.y &&
                                deep.y < bounds.high.y;
            holes += inside && hits(x, y).is_sky() ? 1 : 0;
        }
    }
    return holes;
}

// Borders between tiles, where vertices are shared by position only, have no crack.
TEST_F(DriverGlTest, HasNoHolesBetweenTiles) {
    constexpr glm::ivec2 picture{800, 600};
    Scene scene;
    Node& terrain = test::add_terrain(
        scene, test::plane_heightfield(test::hills(641, 641, 150.0), {30.87, 29.3}));
    const Box& bounds = surface_of(terrain).bounds();
    Node& camera = scene.add_camera();
    Driver made = driver(picture);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    int holes = 0;
    for (int i = 0; i < 20; ++i) {
        const glm::dvec3 eye(3e3 * unit(random), 3e3 * unit(random), 4e3 + 3e3 * unit(random));
        *camera.get<Camera>() = camera_at(eye, {3e3 * unit(random), 3e3 * unit(random), 0.0});
        holes += holes_in(test::must(made.draw_hits(scene)), scene.camera(), bounds);
    }
    EXPECT_EQ(holes, 0) << "pixels of 20 pictures";
}

TEST_F(DriverGlTest, AMapHasNorthUpAndEastRight) {
    Scene scene;
    Image color(64, 64, Rgba8{20, 20, 20, 255});
    for (int row = 0; row < 16; ++row) {
        for (int col = 48; col < 64; ++col) {
            color(col, row) = {255, 255, 255, 255};
        }
    }
    Node& terrain = test::add_terrain(
        scene,
        test::plane_heightfield(test::made_heights(
            64, 64, [](int col, int row) { return col >= 48 && row < 16 ? 5.0 : 0.0; })),
        color);
    scene.add_camera(pose(scene::Pose::map, terrain));
    Driver made = driver();
    test::must(made.draw(scene));
    const Image picture = made.read_color();
    const HitBuffer hits = test::must(made.draw_hits(scene));
    int bright = 0;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const Hit& hit = hits(x, y);
            if (hit.is_sky()) {
                continue;
            }
            const bool north_east = hit.col > 49.0F && hit.row < 14.0F;
            const bool elsewhere = hit.col < 46.0F || hit.row > 17.0F;
            if (north_east) {
                ++bright;
                ASSERT_GT(x, size.x / 2);
                ASSERT_LT(y, size.y / 2);
                ASSERT_GT(picture(x, y).g, 250);
                ASSERT_EQ(hit.height, 5.0F);
            } else if (elsewhere) {
                ASSERT_LT(picture(x, y).g, 40);
                ASSERT_EQ(hit.height, 0.0F);
            }
        }
    }
    EXPECT_GT(bright, 1000);
}

TEST_F(DriverGlTest, ASunInTheEastLightsTheSlopesThatFaceEast) {
    Scene scene;
    Node& terrain = test::add_terrain(
        scene, test::plane_heightfield(test::made_heights(
                   65, 65, [](int col, int) { return 20.0 - 0.5 * std::abs(col - 32.0); })));
    scene.add_camera(pose(scene::Pose::map, terrain));
    Node& sun = scene.add_light({.azimuth = 90.0, .altitude = 40.0});
    Image picture = draw(scene);
    EXPECT_GT(brightness(picture(200, 120)), brightness(picture(120, 120)) + 100);
    sun.get<scene::Light>()->azimuth = 270.0;
    picture = draw(scene);
    EXPECT_GT(brightness(picture(120, 120)), brightness(picture(200, 120)) + 100);
}

TEST_F(DriverGlTest, ATurnedTerrainIsLitByTheSameSun) {
    Scene scene;
    Node& terrain = test::add_terrain(
        scene, test::plane_heightfield(test::made_heights(
                   65, 65, [](int col, int) { return 20.0 - 0.5 * std::abs(col - 32.0); })));
    scene.add_camera(pose(scene::Pose::map, terrain));
    scene.add_light({.azimuth = 90.0, .altitude = 40.0});
    terrain.set_parent_from_local(glm::rotate(glm::dmat4(1.0), std::acos(-1.0), {0.0, 0.0, 1.0}));
    const Image picture = draw(scene);
    EXPECT_GT(brightness(picture(200, 120)), brightness(picture(120, 120)) + 100);
}

// A node twice as large has the same slopes and the same light.
TEST_F(DriverGlTest, AScaledTerrainIsLitAsAnyOther) {
    World world;
    world.scene.remove_sky();
    const Image before = draw(world.scene);
    Camera camera = world.scene.camera();
    camera.eye *= 2.0;
    camera.look *= 2.0;
    world.look(camera);
    world.terrain->set_parent_from_local(glm::scale(glm::dmat4(1.0), glm::dvec3(2.0)));
    const Image after = draw(world.scene);
    int different = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        different +=
            std::abs(brightness(before.samples()[i]) - brightness(after.samples()[i])) > 6 ? 1 : 0;
    }
    EXPECT_LE(different, 8);
}

TEST_F(DriverGlTest, TwoNodesMayShareASurface) {
    Scene scene;
    Node& one = test::add_terrain(scene, test::plane_heightfield(test::made_heights(
                                             33, 33, [](int col, int) { return 0.5 * col; })));
    Node& other = scene.root().add("other", *one.get<scene::TerrainNode>());
    one.set_position({-20.0, 0.0, 0.0});
    // The other one is turned: its slope faces east, the first one's west.
    other.set_parent_from_local(glm::rotate(glm::translate(glm::dmat4(1.0), {20.0, 0.0, 0.0}),
                                            std::acos(-1.0), {0.0, 0.0, 1.0}));
    scene.add_camera(scene::pose_camera(scene::Pose::map, scene.root().world_bounds(), {}));
    scene.add_light({.azimuth = 90.0, .altitude = 20.0});
    Driver made = driver();
    test::must(made.draw(scene));
    const Image picture = made.read_color();
    EXPECT_GT(brightness(picture(240, 120)), brightness(picture(80, 120)) + 60);
}

TEST_F(DriverGlTest, ASecondFrameUploadsTheFrameBlockOnly) {
    World world;
    world.look(camera_at({0.0, -350.0, 250.0}, {0.0, 0.0, 0.0}));
    Driver made = driver();
    const FrameStats first = test::must(made.draw(world.scene));
    EXPECT_EQ(first.tiles, 9);
    EXPECT_EQ(first.triangles, 2U * 300U * 300U);
    EXPECT_EQ(first.draws, 10) << "the sky's included";
    EXPECT_GT(first.upload_bytes, 300U * 300U * 16U);
    const Image picture = made.read_color();
    const FrameStats second = test::must(made.draw(world.scene));
    EXPECT_EQ(second.uploads, 1);
    EXPECT_EQ(second.upload_bytes, sizeof(FrameBlock));
    EXPECT_EQ(second.skipped.uploads_unchanged, 9 + 1) << "nine tiles and the maps";
    EXPECT_EQ(made.read_color(), picture);
}

TEST_F(DriverGlTest, AMovedSunUploadsTheMapsAgain) {
    World world;
    Driver made = driver();
    test::must(made.draw(world.scene));
    const Image before = made.read_color();
    for (const auto& child : world.scene.root().children()) {
        if (auto* light = child->get<scene::Light>()) {
            light->azimuth += 90.0;
        }
    }
    const FrameStats stats = test::must(made.draw(world.scene));
    EXPECT_EQ(stats.uploads, 1 + 1) << "the map of what is lit";
    EXPECT_NE(made.read_color(), before);
    EXPECT_EQ(test::must(made.draw(world.scene)).uploads, 1);
}

TEST_F(DriverGlTest, WhatIsGoneFromTheSceneLeavesTheDriver) {
    Scene scene;
    scene.add_camera(camera_at({0.0, -40.0, 30.0}, {0.0, 0.0, 0.0}));
    Driver made = driver();
    for (int i = 0; i < 20; ++i) {
        Node& terrain = test::add_terrain(
            scene, test::plane_heightfield(Grid<float>(20, 20, 0.1F * static_cast<float>(i))));
        const FrameStats stats = test::must(made.draw(scene));
        EXPECT_GE(stats.uploads, 3)
            << "a new surface is uploaded, even at an address of an old one";
        (void)scene.root().remove(terrain);
    }
}

int terrain_pixels(const HitBuffer& hits) {
    return static_cast<int>(std::count_if(hits.samples().begin(), hits.samples().end(),
                                          [](const Hit& hit) { return !hit.is_sky(); }));
}

TEST_F(DriverGlTest, AWireframeCoversFewerPixels) {
    Scene scene;
    Node& terrain =
        test::add_terrain(scene, test::plane_heightfield(test::hills(20, 20, 1.0), {10.0, 10.0}));
    scene.add_camera(pose(scene::Pose::overview, terrain));
    Driver made = driver();
    const int filled = terrain_pixels(test::must(made.draw_hits(scene)));
    terrain.get<scene::TerrainNode>()->material.wireframe = true;
    const int lines = terrain_pixels(test::must(made.draw_hits(scene)));
    EXPECT_GT(lines, 1000);
    EXPECT_LT(lines, filled / 2);
    terrain.get<scene::TerrainNode>()->material.wireframe = false;
    EXPECT_EQ(terrain_pixels(test::must(made.draw_hits(scene))), filled) << "the mode is set back";
}

TEST_F(DriverGlTest, AResizedOneDrawsAsOneMadeOfThatSize) {
    World world;
    Driver made = driver({100, 50});
    test::must(made.draw(world.scene));
    EXPECT_EQ(made.read_color().cols(), 100);
    EXPECT_EQ(test::must(made.draw_hits(world.scene)).rows(), 50);
    ASSERT_TRUE(made.resize(size));
    EXPECT_EQ(made.size(), size);
    test::must(made.draw(world.scene));
    EXPECT_EQ(made.read_color(), draw(world.scene));
    EXPECT_EQ(test::must(made.draw_hits(world.scene)).cols(), size.x);
    EXPECT_FALSE(made.resize({0, 10}));
    EXPECT_FALSE(made.resize({1 << 20, 10}));
    EXPECT_EQ(made.size(), size) << "a failed one changes nothing";
    EXPECT_TRUE(made.draw(world.scene));
}

TEST_F(DriverGlTest, ASizeThatCannotBeIsAnError) {
    EXPECT_FALSE(Driver::create({.size = {0, 0}, .shader_dir = {}, .software = true}));
    EXPECT_FALSE(Driver::create({.size = {100000, 100000}, .shader_dir = {}, .software = true}));
}

TEST_F(DriverGlTest, WithoutSunAndSkyTheImageryItselfShows) {
    Scene scene;
    Node& terrain = test::add_terrain(scene, test::plane_heightfield(test::hills(50, 50, 1.0)),
                                      Image(50, 50, Rgba8{100, 150, 200, 255}));
    scene.add_camera(pose(scene::Pose::overview, terrain));
    Driver made = driver();
    const FrameStats stats = test::must(made.draw(scene));
    EXPECT_EQ(stats.draws, 1);
    EXPECT_EQ(stats.skipped.sky, 1);
    const Image picture = made.read_color();
    EXPECT_EQ(picture(0, 0), (Rgba8{0, 0, 0, 255}));
    const Rgba8 ground = picture(size.x / 2, size.y / 2);
    EXPECT_NEAR(ground.r, 100, 1);
    EXPECT_NEAR(ground.g, 150, 1);
    EXPECT_NEAR(ground.b, 200, 1);
}

TEST_F(DriverGlTest, AnEmptySceneIsSky) {
    Scene scene;
    Driver made = driver();
    EXPECT_EQ(test::must(made.draw(scene)).draws, 0);
    scene.set_sky({});
    EXPECT_EQ(test::must(made.draw(scene)).draws, 1);
    const HitBuffer hits = test::must(made.draw_hits(scene));
    EXPECT_EQ(terrain_pixels(hits), 0);
    EXPECT_EQ(hits(5, 5).depth, infinity);
}

TEST_F(DriverGlTest, FogHidesWhatIsFarAway) {
    World world;
    scene::Sky sky;
    sky.visibility = 30.0;
    const Image clear = draw(world.scene);
    world.scene.set_sky(sky);
    const Image foggy = draw(world.scene);
    const Rgba8 horizon = rgba8_from_linear(sky.horizon);
    const Rgba8 far = foggy(size.x / 2, size.y / 3);
    EXPECT_NEAR(far.r, horizon.r, 3);
    EXPECT_NEAR(far.b, horizon.b, 3);
    EXPECT_NE(clear(size.x / 2, size.y / 3), far);
}

int different_pixels(const Image& a, const Image& b, int tolerance) {
    int count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Rgba8 p = a.samples()[i];
        const Rgba8 q = b.samples()[i];
        count +=
            std::max({std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b)}) > tolerance
                ? 1
                : 0;
    }
    return count;
}

TEST_F(DriverGlTest, TenThousandKilometresAwayThePictureIsTheSame) {
    World world;
    const Image here = draw(world.scene);
    const Camera camera = world.scene.camera();
    for (const glm::dvec3 offset :
         {glm::dvec3(1e7, -1e7, 1e6), glm::dvec3(1e7 + 0.001, 2e6, -3e6)}) {
        world.terrain->set_position(offset);
        Camera moved = camera;
        moved.eye += offset;
        moved.look += offset;
        world.look(moved);
        EXPECT_LE(different_pixels(here, draw(world.scene), 1), size.x * size.y / 10000);
    }
}

TEST_F(DriverGlTest, AMillimetreFarAwayIsSeen) {
    World world;
    const glm::dvec3 offset(1e7, -1e7, 1e6);
    const double ground = surface_of(*world.terrain).height_at(0.0, 0.0).value();
    const auto depth_below = [&](double shift) {
        world.terrain->set_position(offset + glm::dvec3(0.0, 0.0, shift));
        world.look(camera_at(offset + glm::dvec3(0.0, 0.0, ground + 1.0),
                             offset + glm::dvec3(0.0, 0.0, ground)));
        return test::must(driver().draw_hits(world.scene))(size.x / 2, size.y / 2).depth;
    };
    EXPECT_NEAR(depth_below(0.0) - depth_below(0.001), 0.001F, 2e-5F);
}

TEST_F(DriverGlTest, TheLeastHeightfieldIsDrawn) {
    Scene scene;
    Grid<float> heights(2, 2, 0.0F);
    heights(1, 1) = 1.0F;
    Node& terrain = test::add_terrain(scene, test::plane_heightfield(heights, {10.0, 10.0}));
    scene.add_camera(pose(scene::Pose::map, terrain));
    scene.add_light();
    Driver made = driver();
    EXPECT_EQ(test::must(made.draw(scene)).triangles, 2U);
    const HitBuffer hits = test::must(made.draw_hits(scene));
    expect_true_hits(hits, scene.camera(), terrain);
}

TEST_F(DriverGlTest, AMeshInFrontHidesTheTerrain) {
    World world;
    Node& box = world.scene.add_mesh(scene::box_mesh(glm::vec3(10.0F)));
    world.look(camera_at({0.0, -100.0, 60.0}, {0.0, 0.0, 20.0}));
    box.set_position({0.0, 0.0, 20.0});
    Driver made = driver();
    test::must(made.draw(world.scene));
    const HitBuffer hits = test::must(made.draw_hits(world.scene));
    const Hit& middle = hits(size.x / 2, size.y / 2);
    EXPECT_FALSE(middle.is_sky());
    EXPECT_EQ(middle.col, -1.0F);
    EXPECT_EQ(middle.row, -1.0F);
    EXPECT_NEAR(middle.depth, glm::length(glm::dvec3(0.0, 100.0, 40.0)) - 5.0, 1.5);
    box.set_position({0.0, 200.0, -200.0});
    EXPECT_GE(test::must(made.draw_hits(world.scene))(size.x / 2, size.y / 2).col, 0.0F);
}

// Depths along the view axis of an orthographic camera may be negative.
TEST_F(DriverGlTest, AnOrthographicCameraSeesWhatIsBehindItsEye) {
    World world;
    world.scene.add_mesh(scene::box_mesh(glm::vec3(20.0F))).set_position({0.0, 0.0, 40.0});
    Camera map = pose(scene::Pose::map, *world.terrain);
    map.eye.z = -200.0;
    map.look.z = -201.0;
    world.look(map);
    const HitBuffer hits = test::must(driver().draw_hits(world.scene));
    const Hit& box = hits(size.x / 2, size.y / 2);
    EXPECT_EQ(box.col, -1.0F);
    EXPECT_NEAR(box.depth, -250.0F, 1e-2F);
    const Hit& ground = hits(size.x / 2, 40);
    EXPECT_GE(ground.col, 0.0F);
    EXPECT_NEAR(ground.depth, -200.0F - ground.height, 1e-2F);
}

TEST_F(DriverGlTest, TheTextureTechniqueIsFlatAtTheMiddleOfTheRange) {
    World world;
    world.terrain->get<scene::TerrainNode>()->material.technique =
        scene::make_technique(scene::TechniqueId::texture);
    world.look(camera_at({0.0, -350.0, 250.0}, {0.0, 0.0, 0.0}));
    Driver made = driver();
    EXPECT_EQ(test::must(made.draw(world.scene)).triangles, 2U * 9U);
    const HitBuffer hits = test::must(made.draw_hits(world.scene));
    const double reference = terrain::reference_height(surface_of(*world.terrain).heightfield());
    int count = 0;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const Hit& hit = hits(x, y);
            if (!hit.is_sky()) {
                ++count;
                ASSERT_NEAR(hit.height, reference, 1e-4);
                const auto back =
                    scene::project(world.scene.camera(), size,
                                   surface_of(*world.terrain)
                                       .placement()
                                       .world_from_sample({hit.col, hit.row, hit.height}));
                ASSERT_LE(glm::distance(back.pixel, glm::dvec2(x + 0.5, y + 0.5)), 0.01);
            }
        }
    }
    EXPECT_GT(count, 10000);
}

TEST_F(DriverGlTest, CamerasThatAreNowhereDrawNothingAndDoNoHarm) {
    World world;
    Driver made = driver();
    const double nan = std::nan("");
    for (const Camera& camera :
         {camera_at(glm::dvec3(nan), glm::dvec3(0.0)), camera_at(glm::dvec3(0.0), glm::dvec3(0.0)),
          camera_at({0.0, 0.0, 1e300}, glm::dvec3(0.0)),
          camera_at({0.0, 0.0, -500.0}, {0.0, 0.0, 0.0}),
          camera_at({0.0, 0.0, 500.0}, {0.0, 0.0, 0.0})}) {
        world.look(camera);
        EXPECT_TRUE(made.draw(world.scene));
        EXPECT_TRUE(made.draw_hits(world.scene));
    }
}

} // namespace
} // namespace reljef::render
