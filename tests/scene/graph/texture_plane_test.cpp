#include "engine/scene/graph/mesh.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

TEST(TexturePlane, OfAPlaneIsThePlane) {
    const auto plane = texture_plane(plane_mesh({6.0F, 4.0F}));
    ASSERT_TRUE(plane);
    EXPECT_LT(glm::distance(plane->origin, glm::dvec3(-3.0, 2.0, 0.0)), 1e-6);
    EXPECT_LT(glm::distance(plane->along_u, glm::dvec3(6.0, 0.0, 0.0)), 1e-6);
    EXPECT_LT(glm::distance(plane->along_v, glm::dvec3(0.0, -4.0, 0.0)), 1e-6);
    EXPECT_LT(glm::distance(plane->normal, glm::dvec3(0.0, 0.0, 1.0)), 1e-6);
    EXPECT_EQ(plane->low, glm::dvec2(0.0));
    EXPECT_EQ(plane->high, glm::dvec2(1.0));
}

TEST(TexturePlane, IsNoneOfWhatIsBentOrUnevenlyCovered) {
    EXPECT_FALSE(texture_plane(box_mesh(glm::vec3(1.0F))));
    EXPECT_FALSE(texture_plane(sphere_mesh(1.0F)));
    EXPECT_FALSE(texture_plane({}));
    Mesh uneven = plane_mesh({2.0F, 2.0F});
    uneven.texture_coordinates[2] = {0.9F, 0.0F};
    EXPECT_FALSE(texture_plane(uneven));
    Mesh covered_by_nothing = plane_mesh({2.0F, 2.0F});
    for (glm::vec2& coordinate : covered_by_nothing.texture_coordinates) {
        coordinate = glm::vec2(0.5F);
    }
    EXPECT_FALSE(texture_plane(covered_by_nothing));
}

} // namespace
} // namespace reljef::scene
