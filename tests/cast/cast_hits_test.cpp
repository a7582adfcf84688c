#include "engine/cast/cast_hits.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stop_token>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/cast/simd_target.h"
#include "engine/truth/eye.h"
#include "tests/cast/made_rays.h"
#include "tests/terrain/chance.h"

namespace reljef::cast {
namespace {

struct MadeSurface {
    std::string name;
    Grid<float> heights;
};

// Blocks of buildings with vertical walls one sample wide.
Grid<float> city(int cols, int rows) {
    return test::made_heights(cols, rows, [](int col, int row) {
        const int house = (col / 9 * 31 + row / 7 * 17) % 11;
        return col % 9 < 6 && row % 7 < 5 ? 6.0 * house : 0.02 * col;
    });
}

std::vector<MadeSurface> surfaces() {
    std::vector<MadeSurface> made;
    made.push_back({"hills", test::hills(129, 97, 12.0)});
    made.push_back({"noise", test::random_heights(66, 65, -3.0F, 8.0F, 3)});
    made.push_back({"level", Grid<float>(40, 30, 7.0F)});
    made.push_back({"city", city(150, 120)});
    Grid<float> spike(33, 33, 0.0F);
    spike(16, 16) = 20.0F;
    made.push_back({"spike", std::move(spike)});
    made.push_back(
        {"least", test::made_heights(2, 2, [](int col, int row) { return 0.3 * col * row; })});
    made.push_back(
        {"strip", test::made_heights(2, 200, [](int, int row) { return 0.1 * (row % 13); })});
    return made;
}

// Anywhere in and around the terrain, from 0.3 m above the ground up.
scene::Camera any_camera(const Stage& stage, test::Chance& chance) {
    const scene::TerrainSurface& surface = stage.surface();
    const Box& bounds = surface.bounds();
    const glm::dvec3 extent = bounds.size();
    scene::Camera camera;
    const double beyond = chance.one_in(2) ? 0.4 : -0.05;
    camera.eye = {
        chance.between(bounds.low.x - beyond * extent.x, bounds.high.x + beyond * extent.x),
        chance.between(bounds.low.y - beyond * extent.y, bounds.high.y + beyond * extent.y), 0.0};
    const double ground = surface.height_at(camera.eye.x, camera.eye.y).value_or(bounds.low.z);
    const double above = chance.one_in(2) ? 0.3 : chance.between(0.3, 1.0 + 0.5 * extent.x);
    camera.eye.z = ground + above;
    camera.target = camera.eye + glm::dvec3(chance.between(-1.0, 1.0), chance.between(-1.0, 1.0),
                                            chance.between(-1.2, 0.3));
    camera.near = 0.01;
    camera.vertical_fov = chance.one_in(4) ? 5.0 : 57.3;
    if (chance.one_in(5)) {
        camera.projection = scene::ProjectionKind::orthographic;
        camera.view_height = 0.6 * extent.y;
    }
    return camera;
}

bool same_bits(const HitBuffer& a, const HitBuffer& b) {
    return a.size() == b.size() &&
           std::memcmp(a.samples().data(), b.samples().data(), a.size() * sizeof(Hit)) == 0;
}

// Whether the truth is the same all around the pixel: no silhouette is near.
bool is_stable(const Stage& stage, const truth::SceneCaster& caster, glm::ivec2 size,
               glm::ivec2 pixel, double shift) {
    const truth::Eye eye(stage.scene.camera(), size, caster.bounds());
    std::vector<glm::dvec2> places;
    bool has_hit = false;
    bool has_sky = false;
    for (int i = 0; i < 9; ++i) {
        const glm::dvec2 place = glm::dvec2(pixel) + 0.5 + shift * glm::dvec2(i % 3 - 1, i / 3 - 1);
        const auto hit = caster.first_hit(eye.ray(place), eye.range());
        (hit ? has_hit : has_sky) = true;
        if (hit) {
            places.emplace_back(hit->surface.sample);
        }
    }
    const auto is_near = [&](glm::dvec2 place) {
        return glm::distance(place, places.front()) <= 0.05;
    };
    return !(has_hit && has_sky) && std::all_of(places.begin(), places.end(), is_near);
}

struct Difference {
    int terrain = 0;
    int wrong = 0;         // where the truth is stable
    double farthest = 0.0; // samples
    double worst_pixel = 0.0;
};

void compare(const Stage& stage, const HitBuffer& shown, const HitBuffer& truth,
             Difference& difference) {
    const auto caster = test::must(truth::SceneCaster::create(stage.scene));
    const glm::ivec2 size(shown.cols(), shown.rows());
    constexpr double shift = 0.01; // pixels
    for (int row = 0; row < size.y; ++row) {
        for (int col = 0; col < size.x; ++col) {
            const Hit& a = shown(col, row);
            const Hit& b = truth(col, row);
            difference.terrain += b.is_sky() ? 0 : 1;
            const double apart = a.is_sky() != b.is_sky() ? std::numeric_limits<double>::infinity()
                                 : a.is_sky()             ? 0.0
                                                          : glm::distance(a.place(), b.place());
            if (apart > 0.001 && !is_stable(stage, caster, size, {col, row}, shift)) {
                continue;
            }
            difference.wrong += apart > 0.05 ? 1 : 0;
            difference.farthest = std::max(difference.farthest, apart);
        }
    }
}

constexpr glm::ivec2 picture{71, 53};

CastOptions on_threads(unsigned threads) {
    CastOptions options;
    options.parallel.threads = threads;
    return options;
}

TEST(CastHits, AreThoseOfTheTruth) {
    test::Chance chance(7);
    Difference all;
    for (MadeSurface& made : surfaces()) {
        for (const double spacing : {1.0, 30.0}) {
            Stage stage(made.heights, {spacing, spacing});
            for (int i = 0; i < 6; ++i) {
                stage.look(any_camera(stage, chance));
                Difference difference;
                compare(stage, stage.cast(picture), stage.truth(picture), difference);
                EXPECT_EQ(difference.wrong, 0) << made.name << ' ' << spacing << ' ' << i;
                EXPECT_LE(difference.farthest, 0.001) << made.name << ' ' << spacing << ' ' << i;
                all.terrain += difference.terrain;
            }
        }
    }
    EXPECT_GT(all.terrain, 50'000);
}

TEST(CastHits, AreThoseOfTheTruthWhateverTurnsNodeAndCamera) {
    test::Chance chance(19);
    Stage stage(test::hills(65, 49, 6.0), {2.0, 2.0}, 2.0);
    const glm::dmat4 turned =
        glm::scale(glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(500.0, 40.0, -7.0)), 0.5,
                               glm::dvec3(0.2, 0.1, 1.0)),
                   glm::dvec3(1.2, 0.9, -1.4));
    stage.terrain->set_parent_from_local(turned);
    Difference all;
    for (int i = 0; i < 20; ++i) {
        scene::Camera camera = any_camera(stage, chance);
        camera.eye = glm::dvec3(turned * glm::dvec4(camera.eye, 1.0));
        camera.target = glm::dvec3(turned * glm::dvec4(camera.target, 1.0));
        camera.up = {0.3, 0.1, 1.0};
        stage.look(camera);
        Difference difference;
        compare(stage, stage.cast(picture), stage.truth(picture), difference);
        EXPECT_EQ(difference.wrong, 0) << i;
        EXPECT_LE(difference.farthest, 0.001) << i;
        all.terrain += difference.terrain;
    }
    EXPECT_GT(all.terrain, 5'000);
}

TEST(CastHits, AreThoseOfTheTruthAtAnyExaggeration) {
    test::Chance chance(23);
    int terrain = 0;
    for (const double exaggeration : {1e-6, 1e-3, 1e3, 1e6}) {
        Stage stage(test::hills(97, 80, 5.0), {1.0, 1.0}, exaggeration);
        for (int i = 0; i < 8; ++i) {
            stage.look(any_camera(stage, chance));
            Difference difference;
            compare(stage, stage.cast(picture), stage.truth(picture), difference);
            EXPECT_EQ(difference.wrong, 0) << exaggeration << ' ' << i;
            EXPECT_LE(difference.farthest, 0.001) << exaggeration << ' ' << i;
            terrain += difference.terrain;
        }
    }
    EXPECT_GT(terrain, 5'000);
}

// The error that counts: floats resolve a hundredth of a pixel near the eye and far away.
TEST(CastHits, LieWithinAHundredthOfAPixel) {
    test::Chance chance(31);
    for (const double spacing : {1.0, 90.0}) {
        Stage stage(test::made_heights(3000, 500,
                                       [](int col, int row) {
                                           return 2000.0 +
                                                  20.0 * std::sin(0.4 * col) * std::cos(0.3 * row) +
                                                  200.0 * std::sin(0.004 * col);
                                       }),
                    {spacing, spacing});
        for (const double above : {0.3, 3.0, 300.0, 30000.0}) {
            scene::Camera camera;
            const glm::dvec2 eye(chance.between(-1400.0, 1400.0) * spacing,
                                 chance.between(-100.0, 100.0) * spacing);
            camera.eye = glm::dvec3(eye, *stage.surface().height_at(eye.x, eye.y) + above);
            camera.target = {0.0, 0.0,
                             above > 10.0 ? 2000.0 : camera.eye.z - 0.2 * std::abs(eye.x)};
            camera.near = 0.01;
            stage.look(camera);
            const glm::ivec2 size(160, 120);
            const auto errors = stage.errors(stage.cast(size), stage.truth(size));
            ASSERT_TRUE(errors.reprojection.distribution);
            std::vector<float> pixels;
            for (const float error : errors.reprojection.map.samples()) {
                if (!std::isnan(error)) {
                    pixels.push_back(error);
                }
            }
            std::sort(pixels.begin(), pixels.end());
            EXPECT_LE(pixels[pixels.size() * 999 / 1000], 0.01F) << spacing << ' ' << above;
            EXPECT_EQ(errors.holes, 0U);
        }
    }
}

std::vector<RaySkips> without_one_each() {
    return {{.free_space = false},
            {.beams = false},
            {.free_space = false, .beams = false},
            {.blocks = false},
            {.cells = false}};
}

TEST(CastHits, HaveTheSameBitsForAnyThreadsAndWhateverIsSkipped) {
    test::Chance chance(11);
    for (MadeSurface& made : surfaces()) {
        Stage stage(made.heights, {3.0, 3.0});
        for (int i = 0; i < 6; ++i) {
            stage.look(any_camera(stage, chance));
            const HitBuffer one = stage.cast(picture, on_threads(1));
            EXPECT_TRUE(same_bits(one, stage.cast(picture, on_threads(3))));
            for (const RaySkips& skips : without_one_each()) {
                EXPECT_TRUE(same_bits(one, stage.cast(picture, {.skips = skips}))) << made.name;
            }
        }
    }
}

TEST(CastHits, OfAllInstructionSetsAgree) {
    test::Chance chance(13);
    const std::vector<SimdTarget> targets = simd_targets();
    ASSERT_FALSE(targets.empty());
    for (MadeSurface& made : surfaces()) {
        Stage stage(made.heights);
        stage.look(any_camera(stage, chance));
        const HitBuffer truth = stage.truth(picture);
        for (const SimdTarget& target : targets) {
            Difference difference;
            compare(stage, stage.cast(picture, {.target = target}), truth, difference);
            EXPECT_EQ(difference.wrong, 0) << made.name << ' ' << target.name;
            EXPECT_LE(difference.farthest, 0.001) << made.name << ' ' << target.name;
        }
    }
}

TEST(SimdTarget, UnknownOnesNameThoseOfTheMachine) {
    for (const SimdTarget& target : simd_targets()) {
        EXPECT_EQ(simd_target(target.name).value(), target);
    }
    const auto unknown = simd_target("mmx");
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().message.find(simd_targets().front().name), std::string::npos);
}

TEST(CastHits, AreNoneWithoutASurface) {
    Stage stage(Grid<float>(2, 2, 1.0F));
    stage.look(test::camera_at({0.0, 0.0, 9.0}, {0.0, 0.1, 0.0}));
    const Grid<float> line(1, 40, 2.0F);
    const HitBuffer hits = test::must(cast_hits(RayTile(line.view()), stage.rays(picture)));
    for (const Hit& hit : hits.samples()) {
        ASSERT_TRUE(hit.is_sky());
    }
}

TEST(CastHits, AreNoneOfRaysThatAreNotFinite) {
    Stage stage(Grid<float>(9, 9, 1.0F));
    stage.look(test::camera_at({0.0, 0.0, 9.0}, {0.0, 0.1, 0.0}));
    PictureRays rays = stage.rays(picture);
    rays.direction.right.x = std::numeric_limits<double>::quiet_NaN();
    const RayTile tile(stage.surface().heightfield().heights.view());
    const HitBuffer hits = test::must(cast_hits(tile, rays));
    for (const Hit& hit : hits.samples()) {
        ASSERT_TRUE(hit.is_sky());
    }
}

TEST(CastHits, StopWhenAsked) {
    Stage stage(Grid<float>(9, 9, 1.0F));
    std::stop_source stop;
    stop.request_stop();
    const RayTile tile(stage.surface().heightfield().heights.view());
    CastOptions options;
    options.parallel.stop = stop.get_token();
    EXPECT_FALSE(cast_hits(tile, stage.rays(picture), options));
}

} // namespace
} // namespace reljef::cast
