#include "engine/truth/scene_caster.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/render/made_scene.h"
#include "tests/terrain/brute_force.h"
#include "tests/terrain/chance.h"

namespace reljef::truth {
namespace {

constexpr Interval ahead{0.0, std::numeric_limits<double>::infinity()};

// One terrain on a plane whose node is turned, leaned, scaled and moved.
struct Placed {
    scene::Scene scene;
    const scene::TerrainSurface* surface = nullptr;
    glm::dmat4 world_from_local{1.0};

    [[nodiscard]] glm::dvec3 world(glm::dvec3 sample) const {
        return glm::dvec3(world_from_local *
                          glm::dvec4(surface->placement().world_from_sample(sample), 1.0));
    }
    [[nodiscard]] SceneCaster caster() const { return SceneCaster::create(scene).value(); }
    [[nodiscard]] double width() const {
        return glm::distance(world({0.0, 0.0, 0.0}),
                             world({surface->heightfield().heights.cols() - 1.0, 0.0, 0.0}));
    }
};

glm::dmat4 some_place() {
    const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), glm::dvec3(4000.0, -700.0, 90.0));
    const glm::dmat4 turned = glm::rotate(moved, 0.7, glm::dvec3(0.1, -0.2, 1.0));
    return glm::scale(turned, glm::dvec3(1.5, 0.8, 2.0));
}

Placed placed(Grid<float> heights, const glm::dmat4& world_from_local, double exaggeration = 1.0) {
    Placed made;
    auto& node =
        test::add_terrain(made.scene, test::plane_heightfield(std::move(heights), {3.0, 5.0}), {},
                          {.placement = {}, .exaggeration = exaggeration});
    node.set_parent_from_local(world_from_local);
    made.surface = &test::surface_of(node);
    made.world_from_local = world_from_local;
    return made;
}

// Rays from above to a known place of a surface that nothing hides must meet it there.
void expect_hits_target(const Placed& made, const SceneCaster& caster, glm::dvec3 eye_sample,
                        glm::dvec3 target_sample) {
    const glm::dvec3 eye = made.world(eye_sample);
    const glm::dvec3 target = made.world(target_sample);
    const Ray ray{eye, 0.5 * (target - eye)};
    const auto hit = caster.first_hit(ray, ahead);
    ASSERT_TRUE(hit) << eye_sample.x << ' ' << eye_sample.y << ' ' << eye_sample.z << " to "
                     << target_sample.x << ' ' << target_sample.y;
    ASSERT_LE(glm::distance(ray.at(hit->surface.t), target), 1e-9 * made.width());
    ASSERT_LE(glm::distance(made.world(hit->surface.sample), target), 1e-9 * made.width());
}

TEST(SceneCaster, MeetsAPlaneWhereGeometrySays) {
    test::Chance chance(1);
    const Placed made = placed(Grid<float>(65, 40, 7.0F), some_place(), 2.5);
    const SceneCaster caster = made.caster();
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec3 eye(chance.between(-30.0, 90.0), chance.between(-30.0, 90.0),
                             chance.between(7.5, 300.0));
        const glm::dvec3 target(chance.between(0.01, 63.99), chance.between(0.01, 38.99), 7.0);
        expect_hits_target(made, caster, eye, target);
        if (HasFatalFailure()) {
            return;
        }
    }
}

TEST(SceneCaster, MeetsARampWhereGeometrySays) {
    test::Chance chance(2);
    const auto ramp = [](double col, double row) { return 0.5 * col - 0.25 * row + 3.0; };
    const Placed made = placed(test::made_heights(65, 40, ramp), some_place());
    const SceneCaster caster = made.caster();
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec2 at(chance.between(-30.0, 90.0), chance.between(-30.0, 90.0));
        const glm::dvec2 to(chance.between(0.01, 63.99), chance.between(0.01, 38.99));
        expect_hits_target(made, caster,
                           {at, ramp(at.x, at.y) + std::exp(chance.between(-3.0, 6.0))},
                           {to, ramp(to.x, to.y)});
        if (HasFatalFailure()) {
            return;
        }
    }
}

// Low ground, one cell of wall, high ground: a ray towards the wall meets its foot, face or top.
TEST(SceneCaster, MeetsAStepWhereGeometrySays) {
    test::Chance chance(3);
    const Placed made =
        placed(test::made_heights(33, 33, [](int col, int) { return col < 16 ? 0.0 : 10.0; }),
               some_place());
    const SceneCaster caster = made.caster();
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec3 eye(chance.between(1.0, 15.0), chance.between(1.0, 31.0),
                             chance.between(0.5, 30.0));
        // In front of the wall everything above the ground is free, the wall's face too.
        const double col = chance.between(eye.x, 16.0);
        const glm::dvec3 target(col, chance.between(1.0, 31.0), 10.0 * std::max(0.0, col - 15.0));
        const bool faces = target.z < 10.0 && (eye - target).z > 10.0 * (eye.x - target.x) + 1e-3;
        if (faces) {
            expect_hits_target(made, caster, eye, target);
        }
        // From above the top, seen over the edge only.
        expect_hits_target(made, caster, {eye.x, eye.y, 10.5 + eye.z},
                           {chance.between(16.01, 31.9), target.y, 10.0});
        if (HasFatalFailure()) {
            return;
        }
    }
}

// x² + y² sampled on a grid is, between the samples, the sum of two convex polygons: what lies
// above is convex, so nothing hides one place from another.
TEST(SceneCaster, MeetsASampledParaboloidWhereItsPolygonsAre) {
    test::Chance chance(4);
    const auto square = [](double x) {
        const double low = std::floor(x);
        return low * low + (x - low) * (2.0 * low + 1.0);
    };
    const auto bowl = [&](double col, double row) { return square(col - 20) + square(row - 20); };
    const Placed made = placed(test::made_heights(41, 41, bowl), some_place(), 0.25);
    const SceneCaster caster = made.caster();
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec2 at(chance.between(0.5, 39.5), chance.between(0.5, 39.5));
        const glm::dvec2 to(chance.between(0.5, 39.5), chance.between(0.5, 39.5));
        expect_hits_target(made, caster,
                           {at, bowl(at.x, at.y) + std::exp(chance.between(-2.0, 6.0))},
                           {to, bowl(to.x, to.y)});
        if (HasFatalFailure()) {
            return;
        }
    }
}

// Samples of x·y: bilinear is x·y itself, and a ray's height over it one quadratic.
TEST(SceneCaster, MeetsASaddleWhereTheQuadraticSays) {
    test::Chance chance(5);
    const Placed made =
        placed(test::made_heights(33, 33,
                                  [](int col, int row) { return 0.125 * (col - 16) * (row - 16); }),
               glm::dmat4(1.0));
    const SceneCaster caster = made.caster();
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 from(chance.between(1.0, 31.0), chance.between(1.0, 31.0),
                              chance.between(-30.0, 40.0));
        const glm::dvec3 way =
            glm::dvec3(chance.between(1.0, 31.0), chance.between(1.0, 31.0), -33.0) - from;
        const double a = -0.125 * way.x * way.y;
        const double b = way.z - 0.125 * ((from.x - 16.0) * way.y + (from.y - 16.0) * way.x);
        const double c = from.z - 0.125 * (from.x - 16.0) * (from.y - 16.0);
        // From above to below: where the quadratic falls.
        const double root = (-b - std::sqrt(std::max(b * b - 4.0 * a * c, 0.0))) / (2.0 * a);
        if (c > 1e-3 && std::abs(a) > 1e-3) {
            ++hits;
            const glm::dvec3 eye = made.world(from);
            const auto hit = caster.first_hit({eye, made.world(from + way) - eye}, {0.0, 1.0});
            ASSERT_TRUE(hit);
            ASSERT_NEAR(hit->surface.t, root, 1e-10);
        }
    }
    EXPECT_GT(hits, 5000);
}

TEST(SceneCaster, AgreesWithBruteForceOverAllCells) {
    test::Chance chance(6);
    for (unsigned field = 0; field < 10; ++field) {
        const Placed made = placed(
            test::random_heights(chance.whole(2, 24), chance.whole(2, 24), -3.0F, 3.0F, field),
            some_place(), 1.5);
        const SceneCaster caster = made.caster();
        const Grid<float>& heights = made.surface->heightfield().heights;
        for (int i = 0; i < 10000; ++i) {
            // By chance never on a line between cells: tests/terrain has those, untransformed.
            const auto place = [&](double low, double high) {
                return glm::dvec3(chance.between(-6.0, heights.cols() + 5.0),
                                  chance.between(-6.0, heights.rows() + 5.0),
                                  chance.between(low, high));
            };
            const glm::dvec3 from = place(-4.0, 6.0);
            const glm::dvec3 to = place(-6.0, 4.0);
            const glm::dvec3 eye = made.world(from);
            const Interval range{chance.between(0.0, 0.3), chance.between(0.5, 3.0)};
            const auto hit = caster.first_hit({eye, made.world(to) - eye}, range);
            const auto expected = test::brute_force(heights, {from, to - from}, range);
            ASSERT_EQ(hit.has_value(), expected.has_value()) << field << ' ' << i;
            if (hit) {
                const double t_per_width = made.width() / glm::distance(eye, made.world(to));
                ASSERT_NEAR(hit->surface.t, *expected, std::max(1e-9 * t_per_width, 1e-9));
            }
        }
    }
}

TEST(SceneCaster, NoRayPassesThroughCornersAndEdges) {
    test::Chance chance(7);
    const Placed made = placed(test::random_heights(37, 53, -2.0F, 2.0F, 15), some_place());
    const SceneCaster caster = made.caster();
    for (int i = 0; i < 100000; ++i) {
        glm::dvec2 through(chance.whole(1, 35), chance.whole(1, 51));
        if (chance.one_in(2)) {
            through[chance.whole(0, 1)] += chance.between(0.0, 1.0) - 0.5;
        }
        const glm::dvec3 target(
            through, terrain::bilinear_height(made.surface->heightfield().heights.view(), through));
        const glm::dvec3 up(chance.between(-0.2, 0.2), chance.between(-0.2, 0.2), 1.0);
        const glm::dvec3 from = made.world(target + 4.5 * up);
        const glm::dvec3 to = made.world(target - 4.5 * up);
        ASSERT_TRUE(caster.first_hit({from, to - from}, {0.0, 1.0})) << i;
    }
}

TEST(SceneCaster, IsTheSameInMirrorAndTransposed) {
    test::Chance chance(8);
    const Grid<float> heights = test::random_heights(31, 31, -9.0F, 9.0F, 16);
    const auto scene_of = [](Grid<float> grid) {
        scene::Scene scene;
        test::add_terrain(scene, test::plane_heightfield(std::move(grid), {4.0, 4.0}));
        return SceneCaster::create(scene).value();
    };
    const SceneCaster straight = scene_of(heights);
    const SceneCaster mirrored = scene_of(
        test::made_heights(31, 31, [&](int col, int row) { return heights(30 - col, row); }));
    const SceneCaster transposed =
        scene_of(test::made_heights(31, 31, [&](int col, int row) { return heights(row, col); }));
    const auto mirror = [](glm::dvec3 v) { return glm::dvec3(-v.x, v.y, v.z); };
    const auto transpose = [](glm::dvec3 v) { return glm::dvec3(-v.y, -v.x, v.z); };
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 from(chance.between(-90.0, 90.0), chance.between(-90.0, 90.0),
                              chance.between(-9.0, 40.0));
        const glm::dvec3 way =
            glm::dvec3(chance.between(-60.0, 60.0), chance.between(-60.0, 60.0), -9.0) - from;
        const auto hit = straight.first_hit({from, way}, ahead);
        const auto in_mirror = mirrored.first_hit({mirror(from), mirror(way)}, ahead);
        const auto across = transposed.first_hit({transpose(from), transpose(way)}, ahead);
        ASSERT_EQ(hit.has_value(), in_mirror.has_value()) << i;
        ASSERT_EQ(hit.has_value(), across.has_value()) << i;
        if (hit) {
            ++hits;
            ASSERT_NEAR(hit->surface.sample.x, 30.0 - in_mirror->surface.sample.x, 1e-9);
            ASSERT_NEAR(hit->surface.sample.y, in_mirror->surface.sample.y, 1e-9);
            ASSERT_NEAR(hit->surface.sample.x, across->surface.sample.y, 1e-9);
            ASSERT_NEAR(hit->surface.sample.y, across->surface.sample.x, 1e-9);
        }
    }
    EXPECT_GT(hits, 5000);
}

TEST(SceneCaster, OnAnEllipsoidTheHitLiesOnTheRayAndOnTheSurface) {
    test::Chance chance(9);
    scene::Scene scene;
    auto& node = test::add_terrain(
        scene, test::geographic_heightfield(test::hills(121, 101, 900.0), 46.0, 7.0, 0.01, 20.0),
        {}, {.placement = {}, .exaggeration = 2.0});
    node.set_parent_from_local(some_place());
    const scene::TerrainSurface& surface = test::surface_of(node);
    const SceneCaster caster = SceneCaster::create(scene).value();
    int hits = 0;
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 eye(chance.between(-8e4, 8e4), chance.between(-5e4, 5e4),
                             chance.between(3000.0, 30000.0));
        const glm::dvec3 look(chance.between(-3e4, 3e4), chance.between(-2e4, 2e4), -3000.0);
        const Ray ray{eye, glm::normalize(look - eye)};
        if (const auto hit = caster.first_hit(ray, ahead)) {
            ++hits;
            const glm::dvec3 sample = hit->surface.sample;
            const glm::dvec3 local = surface.placement().world_from_sample(sample);
            const glm::dvec3 world(some_place() * glm::dvec4(local, 1.0));
            ASSERT_LE(glm::distance(world, ray.at(hit->surface.t)), 1e-4) << "of 120 km: 1e-9";
            ASSERT_NEAR(
                sample.z,
                terrain::bilinear_height(surface.heightfield().heights.view(), glm::dvec2(sample)),
                1e-4);
        }
    }
    EXPECT_GT(hits, 500);
}

TEST(SceneCaster, TheNearestOfSeveralTerrainsWins) {
    scene::Scene scene;
    for (const double z : {0.0, 20.0, 10.0}) {
        test::add_terrain(scene, test::plane_heightfield(Grid<float>(9, 9, 1.0F)))
            .set_position({0.0, 0.0, z});
    }
    auto& hidden = test::add_terrain(scene, test::plane_heightfield(Grid<float>(9, 9, 1.0F)));
    hidden.set_position({0.0, 0.0, 50.0});
    hidden.set_visible(false);
    const SceneCaster caster = SceneCaster::create(scene).value();
    const Ray down{{0.3, 0.4, 100.0}, {0.0, 0.0, -1.0}};
    const auto hit = caster.first_hit(down, ahead);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->terrain, 1U);
    EXPECT_NEAR(hit->surface.t, 79.0, 1e-12);
    EXPECT_NEAR(caster.first_hit(down, {85.0, 1e9})->surface.t, 89.0, 1e-12) << "beyond the first";
}

TEST(SceneCaster, HasTheVisibleMeshes) {
    scene::Scene scene;
    test::add_terrain(scene, test::plane_heightfield(Grid<float>(9, 9, 1.0F)));
    auto& mesh = scene.add_mesh(scene::box_mesh(glm::vec3(1.0F)));
    mesh.set_position({0.0, 0.0, 50.0});
    EXPECT_FALSE(SceneCaster::create(scene).value().meshes().empty());
    EXPECT_EQ(SceneCaster::create(scene).value().bounds().high.z, 50.5);
    mesh.set_visible(false);
    EXPECT_TRUE(SceneCaster::create(scene).value().meshes().empty());
}

TEST(SceneCaster, ANodeWithoutExtentIsNotMet) {
    scene::Scene scene;
    test::add_terrain(scene, test::plane_heightfield(Grid<float>(9, 9, 1.0F)))
        .set_parent_from_local(glm::scale(glm::dmat4(1.0), glm::dvec3(0.0)));
    EXPECT_FALSE(
        SceneCaster::create(scene).value().first_hit({{0.0, 0.0, 9.0}, {0.0, 0.0, -1.0}}, ahead));
}

} // namespace
} // namespace reljef::truth
