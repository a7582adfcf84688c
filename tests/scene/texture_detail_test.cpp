#include "engine/scene/texture_detail.h"

#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

TEST(TextureDetail, ATileIsAsWideAsThePlaneOverItsRepeats) {
    EXPECT_NEAR(tile_width(plane_mesh({6.0F, 6.0F}), {3.0F, 3.0F}), 2.0, 1e-6);
    // Not square: as wide as the square of its area.
    EXPECT_NEAR(tile_width(plane_mesh({8.0F, 2.0F}), {1.0F, 1.0F}), 4.0, 1e-6);
    EXPECT_NEAR(tile_width(plane_mesh({8.0F, 2.0F}), {4.0F, 1.0F}), 2.0, 1e-6);
}

TEST(TextureDetail, OfASphereIsItsAreaOverItsTiles) {
    // 4 pi r^2 of a finely cut sphere.
    EXPECT_NEAR(tile_width(sphere_mesh(2.0F, 200), {4.0F, 2.0F}), 2.5066, 1e-2);
}

TEST(TextureDetail, LiftsByItsScaleOfATile) {
    TextureDetail detail;
    detail.repeats = {3.0F, 3.0F};
    detail.scale = 0.1F;
    EXPECT_NEAR(relief_height(plane_mesh({6.0F, 6.0F}), detail), 0.2, 1e-6);
}

TEST(TextureDetail, WithoutTextureCoordinatesLiftsNothing) {
    Mesh mesh = plane_mesh({6.0F, 6.0F});
    for (glm::vec2& coordinate : mesh.texture_coordinates) {
        coordinate = glm::vec2(0.5F);
    }
    EXPECT_EQ(tile_width(mesh, {1.0F, 1.0F}), 0.0);
    EXPECT_EQ(tile_width({}, {1.0F, 1.0F}), 0.0);
}

} // namespace
} // namespace reljef::scene
