#include "bench/suites/frame_check.h"

#include <memory>

#include <gtest/gtest.h>

#include "tests/terrain/made_heightfield.h"

namespace reljef::bench {
namespace {

constexpr glm::ivec2 pit_picture{16, 12};
constexpr std::size_t row_of_picture = 16; // pixels
constexpr std::size_t all_of_picture = 12 * row_of_picture;
constexpr int pit_side = 129; // samples, a metre apart

// High ground with a pit in its middle.
scene::TerrainSurface ground_with_pit() {
    auto terrain = std::make_shared<terrain::Terrain>();
    terrain->heightfield =
        test::plane_heightfield(test::made_heights(pit_side, pit_side, [](int col, int row) {
            const int from_middle =
                std::max(std::abs(col - pit_side / 2), std::abs(row - pit_side / 2));
            return from_middle < 30 ? -40.0 : 60.0;
        }));
    return scene::TerrainSurface::create(std::move(terrain)).value();
}

// Towards the middle; north is y.
scene::Camera camera_at(double y, double z) {
    scene::Camera camera;
    camera.eye = {0.0, y, z};
    camera.target = {0.0, 0.0, 0.0};
    camera.vertical_fov = 10.0;
    camera.near = 0.01;
    return camera;
}

std::size_t holes_without_hits(const scene::Camera& camera) {
    const scene::TerrainSurface surface = ground_with_pit();
    const HitBuffer nothing(pit_picture.x, pit_picture.y);
    const FrameChecker checker(surface, glm::dmat4(1.0), pit_picture, {});
    return checker.check_frame(camera, nothing, 1.0, {}).holes;
}

TEST(FrameChecker, CountsGroundThatIsNotDrawnAsHoles) {
    EXPECT_EQ(holes_without_hits(camera_at(-55.0, 300.0)), all_of_picture);
    EXPECT_EQ(holes_without_hits(camera_at(-80.0, 300.0)), all_of_picture);
}

// The far wall of the pit is seen from beneath the ground before it.
TEST(FrameChecker, CountsNothingThatIsSeenFromBeneathTheBorder) {
    const scene::Camera beside = camera_at(-200.0, 10.0);
    EXPECT_TRUE(ground_with_pit().pick(
        scene::view_ray(beside, pit_picture, glm::dvec2(pit_picture) * 0.5)));
    EXPECT_EQ(holes_without_hits(beside), 0U);
}

// The end of the terrain crosses the picture: a pixel beside it may show what is beyond.
TEST(FrameChecker, CountsNothingBesideTheEndOfTheTerrain) {
    scene::Camera camera = camera_at(-55.0, 300.0);
    camera.target = {0.0, 0.5 * (pit_side - 1), 60.0};
    const std::size_t holes = holes_without_hits(camera);
    EXPECT_GT(holes, all_of_picture / 5);
    EXPECT_LT(holes, all_of_picture / 2 - row_of_picture);
}

TEST(FrameChecker, CountsPixelsThatAreFartherOffThanStated) {
    const scene::TerrainSurface surface = ground_with_pit();
    const scene::Camera camera = camera_at(-55.0, 300.0);
    const FrameChecker checker(surface, glm::dmat4(1.0), pit_picture, {});
    HitBuffer hits(pit_picture.x, pit_picture.y);
    for (int y = 0; y < pit_picture.y; ++y) {
        for (int x = 0; x < pit_picture.x; ++x) {
            const auto hit =
                surface.pick(scene::view_ray(camera, pit_picture, glm::dvec2(x, y) + 0.5));
            ASSERT_TRUE(hit);
            const double off = x == 7 && y == 5 ? 2.0 : 0.0; // samples
            hits(x, y) = hit_at({hit->sample.x + off, hit->sample.y}, hit->sample.z, hit->t);
        }
    }
    const FrameErrors found = checker.check_frame(camera, hits, 0.1, {});
    EXPECT_EQ(found.pixels, all_of_picture);
    EXPECT_EQ(found.violations, 1U);
    EXPECT_GT(found.worst, 0.1);
    EXPECT_EQ(checker.check_frame(camera, hits, 0.1, {{0, 0}, 4}).violations, 0U);
}

} // namespace
} // namespace reljef::bench
