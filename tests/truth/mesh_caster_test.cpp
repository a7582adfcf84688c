#include "engine/truth/mesh_caster.h"

#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/scene/graph/picture_detail.h"

namespace reljef::truth {
namespace {

constexpr Interval onward{0.0, std::numeric_limits<double>::infinity()};

glm::dvec3 any_direction(std::mt19937& random) {
    std::normal_distribution<double> axis;
    return glm::normalize(glm::dvec3(axis(random), axis(random), axis(random)));
}

TEST(MeshCaster, MeetsABoxWhereItIs) {
    scene::Scene scene;
    scene.add_mesh(scene::box_mesh({2.0F, 4.0F, 6.0F})).set_position({10.0, 0.0, 5.0});
    const MeshCaster caster = MeshCaster::create(scene).value();
    EXPECT_EQ(caster.bounds().low, glm::dvec3(9.0, -2.0, 2.0));
    const auto hit = caster.first_hit({{10.5, 1.0, 100.0}, {0.0, 0.0, -2.0}}, onward);
    ASSERT_TRUE(hit);
    EXPECT_DOUBLE_EQ(hit->t, 46.0);
    EXPECT_EQ(MeshCaster::as_shown(*hit).depth, 46.0F);
    EXPECT_EQ(MeshCaster::as_shown(*hit).col, -1.0F);
    EXPECT_FALSE(caster.first_hit({{10.5, 1.0, 100.0}, {0.0, 0.0, -2.0}}, {0.0, 45.9}));
    EXPECT_FALSE(caster.first_hit({{10.0, 0.0, 5.0}, {0.0, 0.0, 1.0}}, onward))
        << "from inside nothing is seen";
    EXPECT_FALSE(caster.first_hit({{11.5, 1.0, 100.0}, {0.0, 0.0, -1.0}}, onward));
}

TEST(MeshCaster, NoRayLeaksIntoAClosedMesh) {
    scene::Scene scene;
    scene.add_mesh(scene::sphere_mesh(1.0F, 48))
        .set_parent_from_local(
            glm::scale(glm::translate(glm::dmat4(1.0), {3.0, 1.0, 2.0}), glm::dvec3(2.0)));
    const MeshCaster caster = MeshCaster::create(scene).value();
    const glm::dvec3 middle(3.0, 1.0, 2.0);
    std::mt19937 random(7);
    for (int i = 0; i < 20'000; ++i) {
        const glm::dvec3 outward = any_direction(random);
        const Ray ray{middle + 10.0 * outward, -outward + 0.1 * any_direction(random)};
        const auto hit = caster.first_hit(ray, onward);
        ASSERT_TRUE(hit) << i;
        const double radius = glm::distance(ray.at(hit->t), middle);
        // Chords of 48 segments are at most 1 - cos(pi/48) below the sphere, twice over.
        EXPECT_LE(radius, 2.0 + 1e-6);
        EXPECT_GE(radius, 2.0 * std::pow(std::cos(3.14159265 / 48.0), 2));
    }
}

TEST(MeshCaster, TheNearestOfManyInstancesWins) {
    scene::Scene scene;
    const auto mesh = std::make_shared<const scene::Mesh>(scene::box_mesh(glm::vec3(1.0F)));
    for (int i = 0; i < 20; ++i) {
        scene.root()
            .add("box", scene::MeshNode{mesh, {}})
            .set_position({2.0 * ((7 * i) % 20), 0.0, 0.0});
    }
    const auto hit =
        MeshCaster::create(scene).value().first_hit({{7.0, 0.1, 0.2}, {1.0, 0.0, 0.0}}, onward);
    ASSERT_TRUE(hit);
    EXPECT_DOUBLE_EQ(hit->t, 0.5);
}

TEST(MeshCaster, ColoursAreThoseOfThePictureAndTheLight) {
    Image picture(2, 1);
    picture(0, 0) = {255, 0, 0, 255};
    picture(1, 0) = {0, 255, 0, 255};
    scene::Material material;
    material.detail.set = scene::picture_material(picture, "two").value();
    material.technique = scene::make_technique(scene::TechniqueId::texture);
    scene::Scene scene;
    scene.add_mesh(scene::plane_mesh({4.0F, 4.0F}), material);
    const MeshCaster caster = MeshCaster::create(scene).value();
    const auto color = [&](double x, const std::optional<scene::Light>& sun) {
        const auto hit = caster.first_hit({{x, 0.3, 1.0}, {0.0, 0.0, -1.0}}, onward);
        return caster.color_at(hit.value(), sun);
    };
    EXPECT_LT(glm::distance(color(-1.0, {}), glm::vec3(1.0F, 0.0F, 0.0F)), 1e-5F);
    EXPECT_LT(glm::distance(color(1.0, {}), glm::vec3(0.0F, 1.0F, 0.0F)), 1e-5F);
    EXPECT_LT(glm::distance(color(0.0, {}), glm::vec3(0.5F, 0.5F, 0.0F)), 1e-5F) << "between";
    scene::Light sun;
    sun.azimuth = 180.0;
    sun.altitude = 30.0;
    const glm::vec3 lit = color(-1.0, sun);
    EXPECT_NEAR(lit.r, sun.color.r * 0.5F + sun.ambient.r, 1e-5F);
}

TEST(MeshCaster, RefusesReliefOnAMesh) {
    Image picture(1, 1);
    auto relief = std::make_shared<material::ReliefMaterial>(
        *scene::picture_material(picture, "flat").value());
    relief->heights = Grid<float>(2, 2, 0.5F);
    scene::Material material;
    material.detail.set = relief;
    scene::Scene scene;
    scene.add_mesh(scene::box_mesh(glm::vec3(1.0F)), material);
    const auto refused = MeshCaster::create(scene);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, testing::HasSubstr("a mesh with relief"));
}

} // namespace
} // namespace reljef::truth
