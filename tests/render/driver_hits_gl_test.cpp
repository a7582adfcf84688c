#include <algorithm>
#include <array>
#include <cmath>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/terrain/field/surface_caster.h"
#include "tests/render/driver_fixture.h"
#include "tests/render/made_stream.h"
#include "tests/scene/streaming/streamed_samples.h"
#include "tests/session/made_session.h"

namespace reljef::render {
namespace {

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

// The triangle that is shown at a place, on the picture.
std::array<scene::Projected, 3> triangle_on_picture(const Camera& camera, glm::ivec2 picture,
                                                    const Node& node, const Hit& hit) {
    const auto& surface = surface_of(node);
    const Grid<float>& heights = surface.heightfield().heights;
    const int c = std::clamp(static_cast<int>(hit.col), 0, heights.cols() - 2);
    const int r = std::clamp(static_cast<int>(hit.row), 0, heights.rows() - 2);
    const bool is_lower = hit.row - static_cast<float>(r) >= hit.col - static_cast<float>(c);
    const auto corner = [&](int col, int row) {
        const glm::dvec3 local = surface.placement().world_from_sample(
            {static_cast<double>(col), static_cast<double>(row), heights(col, row)});
        return scene::project(camera, picture,
                              glm::dvec3(node.world_from_local() * glm::dvec4(local, 1.0)));
    };
    return {corner(c, r), corner(c + 1, r + 1), is_lower ? corner(c, r + 1) : corner(c + 1, r)};
}

// How far off floats put what they interpolate from the picture's corner, with a slope of one
// triangle to its least width: two products and two sums, as much for 1/w, each round by half of
// 2^-23. That is little but for triangles far narrower than a pixel.
struct FloatRounding {
    double pixels = 0.0;
    double depth = 0.0; // metres
};

FloatRounding float_rounding(const std::array<scene::Projected, 3>& corners, glm::ivec2 picture) {
    const auto [a, b, c] = corners;
    const glm::dvec2 ab = b.pixel - a.pixel;
    const glm::dvec2 ac = c.pixel - a.pixel;
    const double longest =
        std::max({glm::length(ab), glm::length(ac), glm::distance(b.pixel, c.pixel)});
    const double width = std::abs(ab.x * ac.y - ab.y * ac.x) / longest;
    const auto [nearest, farthest] = std::minmax({a.depth, b.depth, c.depth});
    const double share = 0x1p-21 * std::max(picture.x, picture.y) / width;
    return {share * longest, share * (farthest - nearest)};
}

// What is true of the hits of a picture.
struct HitReport {
    int hits = 0;
    int off_triangles = 0;     // farther from the triangles than 2 mm
    double farthest_off = 0.0; // metres of height from the triangles
    double beyond_patch = 0.0; // metres farther from the bilinear patch than its triangles are
    double reprojection = 0.0; // pixels, beyond what floats round
    double depth_error = 0.0;  // share of the depth, beyond what floats round
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
            const FloatRounding rounding =
                float_rounding(triangle_on_picture(camera, picture, node, hit), picture);
            report.reprojection =
                std::max(report.reprojection,
                         glm::distance(back.pixel, glm::dvec2(x + 0.5, y + 0.5)) - rounding.pixels);
            report.depth_error =
                std::max(report.depth_error, (std::abs(back.depth - hit.depth) - rounding.depth) /
                                                 std::max(std::abs(back.depth), 1.0));
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

class DriverHitsGlTest : public DriverGlTest,
                         public testing::WithParamInterface<test::SampleSource> {
protected:
    static void give_samples(Node& terrain) {
        test::give_samples(*terrain.get<scene::TerrainNode>(), GetParam());
    }
    HitBuffer hits_of(session::SceneRenderer& made, const Scene& scene, glm::ivec2 picture = size) {
        bring_tiles(scene, picture);
        return test::must(made.draw_hits(scene));
    }
    HitBuffer hits_of(const Scene& scene) {
        session::SceneRenderer made = driver();
        return hits_of(made, scene);
    }
};

INSTANTIATE_TEST_SUITE_P(Sources, DriverHitsGlTest, test::exact_sources(), test::name_of_source);

TEST_P(DriverHitsGlTest, HitsLieOnTheSurfaceAndProjectBackToTheirPixel) {
    World world;
    give_samples(*world.terrain);
    session::SceneRenderer made = driver();
    for (const auto which :
         {scene::Pose::overview, scene::Pose::low, scene::Pose::grazing, scene::Pose::map}) {
        world.look(pose(which, *world.terrain));
        const HitBuffer hits = hits_of(made, world.scene);
        ASSERT_EQ(hits.cols(), size.x);
        ASSERT_EQ(hits.rows(), size.y);
        SCOPED_TRACE(to_string(which));
        expect_true_hits(hits, world.scene.camera(), *world.terrain);
    }
}

TEST_P(DriverHitsGlTest, HitsOfAnExaggeratedTerrainAreInTrueMetres) {
    World world(3.0);
    give_samples(*world.terrain);
    const HitBuffer hits = hits_of(world.scene);
    expect_true_hits(hits, world.scene.camera(), *world.terrain);
}

TEST_P(DriverHitsGlTest, HitsFollowATurnedAndMovedNode) {
    World world;
    give_samples(*world.terrain);
    world.terrain->set_parent_from_local(
        glm::rotate(glm::translate(glm::dmat4(1.0), {20.0, -10.0, 5.0}), 0.8, {0.1, 0.05, 1.0}));
    const HitBuffer hits = hits_of(world.scene);
    expect_true_hits(hits, world.scene.camera(), *world.terrain);
}

TEST_P(DriverHitsGlTest, HitsOnAnEllipsoid) {
    Scene scene;
    Node& terrain = test::add_terrain(
        scene, test::geographic_heightfield(test::hills(301, 201, 600.0), 46.0, 7.0, 1.0 / 600.0));
    give_samples(terrain);
    const Camera camera = pose(scene::Pose::overview, terrain);
    scene.add_camera(camera);
    const HitBuffer hits = hits_of(scene);
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
    const scene::TerrainSurface& surface = surface_of(node);
    const terrain::SurfaceCaster exact(surface.heightfield().heights.view(), surface.pyramid(),
                                       surface.placement());
    Grid<std::uint8_t> cover(size.x, size.y, 0);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const Ray ray = scene::view_ray(camera, size, {x + 0.5, y + 0.5});
            cover(x, y) = exact.first_hit(ray) ? 1 : 0;
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

TEST_P(DriverHitsGlTest, ThePictureShowsTheTerrainExactlyWhereTheExactRaysDo) {
    World world;
    give_samples(*world.terrain);
    session::SceneRenderer made = driver();
    for (const auto which : {scene::Pose::overview, scene::Pose::low, scene::Pose::grazing}) {
        world.look(pose(which, *world.terrain));
        const HitBuffer hits = hits_of(made, world.scene);
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
TEST_P(DriverHitsGlTest, HasNoHolesBetweenTiles) {
    constexpr glm::ivec2 picture{800, 600};
    Scene scene;
    Node& terrain = test::add_terrain(
        scene, test::plane_heightfield(test::hills(641, 641, 150.0), {30.87, 29.3}));
    give_samples(terrain);
    const Box& bounds = surface_of(terrain).bounds();
    Node& camera = scene.add_camera();
    session::SceneRenderer made = driver(picture);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    int holes = 0;
    for (int i = 0; i < 20; ++i) {
        const glm::dvec3 eye(3e3 * unit(random), 3e3 * unit(random), 4e3 + 3e3 * unit(random));
        *camera.get<Camera>() = camera_at(eye, {3e3 * unit(random), 3e3 * unit(random), 0.0});
        holes += holes_in(hits_of(made, scene, picture), scene.camera(), bounds);
    }
    EXPECT_EQ(holes, 0) << "pixels of 20 pictures";
}

// A level plain around a pyramid, whose rays come in over the sides of its box where rows, or
// columns, meet: what floats round puts their places beside the border and into either cell.
TEST_P(DriverHitsGlTest, RaysThatComeInBetweenTwoCellsOfTheBorderFindTheGround) {
    constexpr int side = 256;       // so the last cell is the first of two
    constexpr double spacing = 0.3; // metres, no float
    Scene scene;
    Node& terrain = test::add_terrain(
        scene, test::plane_heightfield(
                   test::made_heights(
                       side, side,
                       [](int col, int row) {
                           const int nearest = std::min({col, row, side - 1 - col, side - 1 - row});
                           return 0.4 * nearest;
                       }),
                   {spacing, spacing}));
    give_samples(terrain);
    terrain.get<scene::TerrainNode>()->material.technique =
        scene::make_technique(scene::TechniqueId::exact);
    const Box& bounds = surface_of(terrain).bounds();
    Node& camera = scene.add_camera();
    session::SceneRenderer made = driver();
    int holes = 0;
    for (int i = 0; i < 40; ++i) {
        // The rays of neighbouring pixels come in two samples apart.
        Camera view = camera_at({bounds.high.x + size.y * spacing, 0.0, 1.0 + 0.37 * i},
                                {0.0, 0.0, 1.0 + 0.37 * i});
        view.eye.y = view.target.y = spacing * (i + 0.5);
        view.vertical_fov = 90.0;
        for (int turn = 0; turn < i % 4; ++turn) {
            view.eye = {-view.eye.y, view.eye.x, view.eye.z};
            view.target = {-view.target.y, view.target.x, view.target.z};
        }
        *camera.get<Camera>() = view;
        holes += holes_in(hits_of(made, scene, size), view, bounds);
    }
    EXPECT_EQ(holes, 0) << "pixels of 40 pictures";
}

TEST_P(DriverHitsGlTest, TheLeastHeightfieldIsDrawn) {
    Scene scene;
    Grid<float> heights(2, 2, 0.0F);
    heights(1, 1) = 1.0F;
    Node& terrain = test::add_terrain(scene, test::plane_heightfield(heights, {10.0, 10.0}));
    give_samples(terrain);
    scene.add_camera(pose(scene::Pose::map, terrain));
    scene.add_light();
    session::SceneRenderer made = driver();
    const HitBuffer hits = hits_of(made, scene);
    EXPECT_EQ(test::must(made.draw(scene)).triangles, 2U);
    expect_true_hits(hits, scene.camera(), terrain);
}

} // namespace
} // namespace reljef::render
