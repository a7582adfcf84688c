#include "bench/suites/skip_check.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/render/made_scene.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::bench {
namespace {

// A flat square from above; each pixel shows the place below it.
struct Ground {
    scene::Scene scene;
    scene::Node* terrain = nullptr;
    DrawnPicture picture{Image(9, 9, {10, 20, 30, 255}), HitBuffer(9, 9)};

    Ground() {
        terrain = &test::add_terrain(scene, test::plane_heightfield(Grid<float>(101, 101, 0.0F)));
        scene::Camera camera = test::camera_at({0.0, 0.0, 40.0}, {0.0, 0.0, 0.0});
        camera.up = {0.0, 1.0, 0.0};
        scene.add_camera(camera);
        for (int row = 0; row < 9; ++row) {
            for (int col = 0; col < 9; ++col) {
                picture.hits(col, row) = hit_below({col, row});
            }
        }
    }
    [[nodiscard]] Hit hit_below(glm::ivec2 pixel) const {
        const Ray ray = scene::view_ray(scene.camera(), {9, 9}, glm::dvec2(pixel) + 0.5);
        const double depth = -ray.origin.z / ray.direction.z;
        const glm::dvec3 place = ray.origin + depth * ray.direction;
        return hit_at({50.0 + place.x, 50.0 - place.y}, 0.0, depth);
    }
};

TEST(SkipCheck, TheSamePictureIsTheSame) {
    const Ground ground;
    const auto found =
        difference_of(ground.scene, *ground.terrain, ground.picture, ground.picture, false);
    EXPECT_TRUE(found.is_same());
    EXPECT_TRUE(found.is_allowed());
}

TEST(SkipCheck, AnotherColourIsAnotherPicture) {
    const Ground ground;
    DrawnPicture other = ground.picture;
    other.colors(3, 4).g = 21;
    auto found = difference_of(ground.scene, *ground.terrain, ground.picture, other, false);
    EXPECT_EQ(found.pixels, 1U);
    EXPECT_EQ(found.levels, 1);
    EXPECT_FALSE(found.is_allowed());
    found.tolerance_levels = 1;
    EXPECT_TRUE(found.is_allowed());
}

TEST(SkipCheck, TheFarthestHitIsKeptWhicheverComesFirst) {
    const Ground ground;
    DrawnPicture other = ground.picture;
    other.hits(2, 2).col_low += 0.5F;
    other.hits(6, 6).col_low += 0.05F;
    const auto exact = difference_of(ground.scene, *ground.terrain, ground.picture, other, false);
    EXPECT_GT(exact.max_px, 0.05);
    other = ground.picture;
    other.hits(2, 2).col = std::numeric_limits<float>::quiet_NaN();
    other.hits(6, 6).col_low += 1e-6F;
    const auto no_place = difference_of(ground.scene, *ground.terrain, ground.picture, other, true);
    EXPECT_FALSE(no_place.is_allowed());
}

TEST(SkipCheck, AHitMayMoveByWhatFloatsRoundButNotByMore) {
    const Ground ground;
    for (const bool is_far : {false, true}) {
        DrawnPicture other = ground.picture;
        other.hits(6, 2).col_low += is_far ? 0.01F : 1e-6F;
        auto found = difference_of(ground.scene, *ground.terrain, ground.picture, other, true);
        EXPECT_EQ(found.hits, 1U);
        EXPECT_EQ(found.edges, 0U);
        EXPECT_EQ(found.is_allowed(), !is_far) << found.max_px << " of " << found.tolerance_px;
        found = difference_of(ground.scene, *ground.terrain, ground.picture, other, false);
        EXPECT_FALSE(found.is_allowed());
    }
}

TEST(SkipCheck, AHitInsteadOfSkyIsAtAnEdge) {
    const Ground ground;
    DrawnPicture other = ground.picture;
    other.hits(6, 2) = Hit();
    const auto found = difference_of(ground.scene, *ground.terrain, ground.picture, other, true);
    EXPECT_EQ(found.hits, 1U);
    EXPECT_EQ(found.edges, 1U);
}

} // namespace
} // namespace reljef::bench
