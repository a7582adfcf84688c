#include "engine/scene/graph/terrain_base.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/made_heightfield.h"

namespace reljef::scene {
namespace {

TerrainSurface surface_over(terrain::Heightfield heightfield, const TerrainOptions& options = {}) {
    auto terrain = std::make_shared<terrain::Terrain>();
    terrain->heightfield = std::move(heightfield);
    return TerrainSurface::create(std::move(terrain), options).value();
}

TEST(TerrainBase, JoinsEverySampleOfTheBorderAndReachesBelowTheLowest) {
    const auto surface = surface_over(
        test::plane_heightfield(test::random_heights(7, 5, -20.0F, 90.0F, 1), {10.0, 20.0}),
        {.placement = terrain::PlacementKind::plane, .exaggeration = 2.0});
    const auto mesh = terrain_base(surface, block_bottom(surface));
    ASSERT_TRUE(mesh);
    const terrain::Heightfield& heightfield = surface.heightfield();
    ASSERT_EQ(mesh->positions.size(), 2U * (7 + 5 + 7 + 5));
    std::size_t tops = 0;
    for (int row = 0; row < 5; ++row) {
        for (int col = 0; col < 7; ++col) {
            const glm::vec3 place(
                surface.placement().world_from_sample({col, row, heightfield.heights(col, row)}));
            tops += static_cast<std::size_t>(
                std::count(mesh->positions.begin(), mesh->positions.end(), place));
        }
    }
    EXPECT_EQ(tops, 7U + 5U + 7U + 5U) << "corners belong to two sides";
    const double lowest = 2.0 * heightfield.range.low;
    for (std::size_t i = 1; i < mesh->positions.size(); i += 2) {
        EXPECT_NEAR(mesh->positions[i].z, lowest - 0.04 * 60.0, 1e-3);
    }
}

TEST(TerrainBase, FacesOutwards) {
    const auto surface = surface_over(test::plane_heightfield(Grid<float>(4, 6, 5.0F)));
    const auto mesh = terrain_base(surface, block_bottom(surface));
    ASSERT_TRUE(mesh);
    ASSERT_EQ(mesh->indices.size(), 2U * 3U * 2U * (3 + 5));
    for (std::size_t i = 0; i < mesh->indices.size(); i += 3) {
        const glm::vec3 a = mesh->positions[mesh->indices[i]];
        const glm::vec3 b = mesh->positions[mesh->indices[i + 1]];
        const glm::vec3 c = mesh->positions[mesh->indices[i + 2]];
        const glm::vec3 facing = glm::normalize(glm::cross(b - a, c - a));
        const glm::vec3 normal = mesh->normals[mesh->indices[i]];
        EXPECT_NEAR(glm::distance(facing, normal), 0.0F, 1e-5F);
        EXPECT_GT(glm::dot(glm::vec3(a.x, a.y, 0.0F), normal), 0.0F) << "away from the middle";
    }
}

TEST(TerrainBase, StandsUprightOnTheEllipsoid) {
    const auto curved =
        surface_over(test::geographic_heightfield(Grid<float>(9, 9, 100.0F), 60.0, 7.0, 0.5));
    ASSERT_EQ(curved.placement().kind(), terrain::PlacementKind::ellipsoid);
    const auto mesh = terrain_base(curved, block_bottom(curved));
    ASSERT_TRUE(mesh);
    for (std::size_t i = 0; i < mesh->positions.size(); i += 2) {
        const glm::dvec3 top(mesh->positions[i]);
        const glm::dvec3 down = glm::normalize(glm::dvec3(mesh->positions[i + 1]) - top);
        EXPECT_NEAR(glm::dot(down, curved.placement().up(top)), -1.0, 1e-6);
        EXPECT_NEAR(glm::dot(glm::vec3(down), mesh->normals[i]), 0.0, 1e-3);
    }
}

// Of an island that its border cuts.
TEST(TerrainBase, StandsOnlyWhereTheBorderIsHigherThanItsBottom) {
    const auto walls_over = [](float shore) {
        Grid<float> heights(6, 5, 0.0F);
        heights(1, 2) = 700.0F; // within
        heights(0, 4) = heights(5, 0) = -3.0F;
        heights(3, 4) = shore;
        return terrain_base(surface_over(test::plane_heightfield(heights, {10.0, 10.0})), 0.0);
    };
    EXPECT_FALSE(walls_over(0.0F));
    const auto mesh = walls_over(40.0F);
    ASSERT_TRUE(mesh);
    ASSERT_EQ(mesh->indices.size(), 2U * 6U) << "from the sea to the sea";
    for (const std::uint32_t index : mesh->indices) {
        const glm::vec3 place = mesh->positions[index];
        EXPECT_EQ(place.y, -20.0F) << "the southern border";
        EXPECT_TRUE(place.z == 0.0F || (place.z == 40.0F && place.x == 5.0F));
    }
}

TEST(TerrainBase, IsHiddenFromEyesOverTheTerrain) {
    for (const auto kind : {terrain::PlacementKind::plane, terrain::PlacementKind::ellipsoid}) {
        const auto surface =
            surface_over(test::geographic_heightfield(Grid<float>(9, 9, 100.0F), 60.0, 7.0, 0.5),
                         {.placement = kind});
        const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), glm::dvec3(7e5, 0.0, 0.0));
        const auto shows = [&](glm::dvec2 sample, ProjectionKind projection) {
            Camera camera;
            camera.projection = projection;
            camera.eye =
                glm::dvec3(moved[3]) + surface.placement().world_from_sample({sample, 5000.0});
            return may_show_base(surface, moved, camera);
        };
        EXPECT_FALSE(shows({4.0, 4.0}, ProjectionKind::perspective));
        EXPECT_FALSE(shows({0.1, 7.9}, ProjectionKind::perspective));
        EXPECT_TRUE(shows({-0.1, 4.0}, ProjectionKind::perspective));
        EXPECT_TRUE(shows({3.0, 8.1}, ProjectionKind::perspective));
        EXPECT_TRUE(shows({4.0, 4.0}, ProjectionKind::orthographic));
    }
}

TEST(TerrainBase, OnlyHeightsAtTheirPlacesHaveOne) {
    const auto shows = [](const char* technique) {
        return shows_heights(parse_technique(technique).value());
    };
    EXPECT_TRUE(shows("polygons"));
    EXPECT_TRUE(shows("exact"));
    EXPECT_TRUE(shows("relief"));
    EXPECT_FALSE(shows("texture"));
    EXPECT_FALSE(shows("parallax"));
    EXPECT_FALSE(shows("prewarp"));
    EXPECT_FALSE(shows("relief:fade=0.6..1,2"));
}

} // namespace
} // namespace reljef::scene
