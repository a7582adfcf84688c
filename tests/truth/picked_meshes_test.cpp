#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/scene/graph/scene.h"
#include "engine/truth/mesh_caster.h"

namespace reljef::truth {
namespace {

constexpr Interval any_distance{0.0, std::numeric_limits<double>::infinity()};

// 60 instances of three shapes, turned, stretched and mirrored, around `middle`; some face the
// camera.
scene::Scene many_meshes(std::mt19937& random, glm::dvec3 middle) {
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const std::array shapes{
        std::make_shared<const scene::Mesh>(scene::box_mesh({2.0F, 3.0F, 4.0F})),
        std::make_shared<const scene::Mesh>(scene::torus_mesh(3.0F, 1.0F)),
        std::make_shared<const scene::Mesh>(scene::billboard_mesh({4.0F, 6.0F}))};
    scene::Scene scene;
    scene.add_camera({.eye = middle + glm::dvec3(0.0, -60.0, 20.0), .target = middle});
    for (std::size_t i = 0; i < 60; ++i) {
        glm::dmat4 place = glm::translate(
            glm::dmat4(1.0), middle + 20.0 * glm::dvec3(any(random), any(random), any(random)));
        place = glm::rotate(place, 3.0 * any(random), glm::dvec3(any(random), 1.0, any(random)));
        place = glm::scale(place, glm::dvec3(1.0, 1.5 + any(random), i % 5 == 0 ? -1.0 : 1.0));
        scene::MeshNode node{shapes.at(i % shapes.size()), {}};
        node.facing = i % 4 == 0 ? scene::Facing::camera : scene::Facing::node;
        scene.root().add("mesh", node).set_parent_from_local(place);
    }
    return scene;
}

TEST(PickedMeshes, AreThoseThatTheTruthMeets) {
    std::mt19937 random(2027);
    std::normal_distribution<double> axis;
    for (const glm::dvec3 middle : {glm::dvec3(0.0), glm::dvec3(3e4, -2e4, 1500.0)}) {
        const scene::Scene scene = many_meshes(random, middle);
        const MeshCaster caster = MeshCaster::create(scene).value();
        int met = 0;
        for (int i = 0; i < 10'000; ++i) {
            const glm::dvec3 from =
                middle +
                60.0 * glm::normalize(glm::dvec3(axis(random), axis(random), axis(random)));
            const glm::dvec3 to =
                middle + 10.0 * glm::dvec3(axis(random), axis(random), axis(random));
            const Ray ray{from, to - from};
            const auto expected = caster.first_hit(ray, any_distance);
            const auto pick = scene.pick(ray);
            ASSERT_EQ(pick.has_value(), expected.has_value()) << i;
            if (pick) {
                ++met;
                ASSERT_NEAR(pick->t, expected->t, 1e-9) << i;
                ASSERT_LT(glm::distance(pick->world, ray.at(expected->t)), 1e-7) << i;
                ASSERT_FALSE(pick->ground);
            }
        }
        EXPECT_GT(met, 5000);
        EXPECT_LT(met, 9900);
    }
}

} // namespace
} // namespace reljef::truth
