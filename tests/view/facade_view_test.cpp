#include "engine/view/facade_view.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "engine/view/grain_view.h"
#include "tests/gl/gl_fixture.h"
#include "tests/terrain/made_house.h"

namespace reljef::view {
namespace {

std::shared_ptr<const scene::TerrainSurface> house_surface(terrain::Terrain terrain) {
    return std::make_shared<const scene::TerrainSurface>(test::must(scene::TerrainSurface::create(
        std::make_shared<const terrain::Terrain>(std::move(terrain)))));
}

scene::TerrainLight sunlight_from(double azimuth, double altitude) {
    scene::TerrainLight light;
    light.sun.azimuth = azimuth;
    light.sun.altitude = altitude;
    return light;
}

TEST(FacadeMap, CountsWindowsAndStoreysAlongEachWall) {
    const auto house = house_surface(test::made_house());
    const FacadeMap map = facade_map(*house, glm::dmat4(1.0), std::nullopt);
    const auto& walls = house->terrain().facades.walls;
    ASSERT_EQ(map.walls.size(), walls.size());
    for (std::size_t i = 0; i < walls.size(); ++i) {
        const FacadeTexels& texels = map.walls[i];
        const auto window_at = [&](glm::dvec2 sample) {
            const glm::vec2 from = glm::vec2(sample) - glm::vec2(texels.along);
            return texels.storeys.x + glm::dot(from, glm::vec2(texels.along.z, texels.along.w));
        };
        EXPECT_NEAR(window_at(walls[i].begin), walls[i].windows.x, 1e-4);
        EXPECT_NEAR(window_at(walls[i].end), walls[i].windows.y, 1e-4);
        EXPECT_NEAR(texels.storeys.y * texels.storeys.z, 4.0, 1e-5);
        EXPECT_NEAR(texels.storeys.w, i % 2 == 0 ? 20.0 / 6.0 : 12.0 / 4.0, 1e-5);
    }
    EXPECT_EQ(map.sun, glm::vec3(0.0F)) << "without a light";
    EXPECT_EQ(map.sky, glm::vec3(1.0F));
}

TEST(FacadeMap, NormalsLeadAwayFromTheHouseAlsoWhenItIsTurned) {
    const auto house = house_surface(test::made_house());
    std::mt19937 random(3);
    std::uniform_real_distribution<double> degrees(0.0, 360.0);
    for (int i = 0; i < 100; ++i) {
        const double turn = glm::radians(degrees(random));
        glm::dmat4 world_from_local(1.0);
        world_from_local[0] = {std::cos(turn), std::sin(turn), 0.0, 0.0};
        world_from_local[1] = {-std::sin(turn), std::cos(turn), 0.0, 0.0};
        const scene::TerrainLight light{sunlight_from(degrees(random), 30.0).sun,
                                        glm::dmat3(world_from_local)};
        const FacadeMap map = facade_map(*house, world_from_local, light);
        for (std::size_t k = 0; k < map.walls.size(); ++k) {
            const terrain::Facade& wall = house->terrain().facades.walls[k];
            const auto local = [&](glm::dvec2 sample) {
                return house->placement().world_from_sample({sample, 0.0});
            };
            const glm::dvec3 out =
                local(0.5 * (wall.begin + wall.end)) - local(glm::dvec2(40.0, 40.0));
            const glm::dvec3 normal = glm::normalize(glm::dmat3(world_from_local) * out);
            const glm::dvec3 in_axes = turned(normal);
            EXPECT_NEAR(map.walls[k].facing.x, in_axes.x, 1e-5);
            EXPECT_NEAR(map.walls[k].facing.y, in_axes.y, 1e-5);
            const double to_sun = glm::dot(normal, scene::to_light(light.sun));
            EXPECT_NEAR(map.walls[k].facing.z, std::max(to_sun, 0.0), 1e-5);
        }
    }
}

// A long bank before a wall that faces the sun.
TEST(FacadeMap, ShadowsEndWhereTheSunPassesTheHouseOpposite) {
    constexpr int side = 101;
    constexpr double bank = 9.0; // metres high
    terrain::Terrain made;
    made.heightfield = test::plane_heightfield(
        test::made_heights(side, side,
                           [](int /*col*/, int row) {
                               return row == 70 ? bank : row < 40 ? 15.0 : 0.0;
                           }),
        {0.5, 0.5});
    made.facades.walls.push_back({.begin = {100.0, 39.5}, .end = {0.0, 39.5}, .eaves = 15.0});
    made.facades.wall_at = Grid<std::uint32_t>(side, side, 1U);
    const auto street = house_surface(std::move(made));
    for (const double altitude : {5.0, 20.0, 40.0}) {
        const FacadeMap map = facade_map(*street, glm::dmat4(1.0), sunlight_from(180.0, altitude));
        ASSERT_GT(map.walls[0].facing.z, 0.5F) << "it faces south";
        const double metres = 0.5 * (70.0 - 41.0);
        const double edge = bank - metres * std::tan(glm::radians(altitude));
        const double of_street = -0.5 * std::tan(glm::radians(altitude)); // the sample before
        EXPECT_NEAR(map.samples(50, 40).y, std::max(edge, of_street), 0.01) << altitude;
    }
    EXPECT_EQ(facade_map(*street, glm::dmat4(1.0), sunlight_from(180.0, -5.0)).sun,
              glm::vec3(0.0F));
}

TEST(FacadeMap, ComparisonsAndTerrainsWithoutWallsShowNone) {
    scene::TerrainNode node;
    node.surface = house_surface(test::made_house());
    EXPECT_TRUE(shows_facades(node));
    node.hides_overlay = true;
    EXPECT_FALSE(shows_facades(node));
    terrain::Terrain bare = test::made_house();
    bare.facades = {};
    node.hides_overlay = false;
    node.surface = house_surface(std::move(bare));
    EXPECT_FALSE(shows_facades(node));
}

} // namespace
} // namespace reljef::view
