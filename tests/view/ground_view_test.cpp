#include "engine/view/draw_list.h"

#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "engine/scene/graph/scene.h"
#include "tests/render/made_scene.h"

namespace reljef::render {
namespace {

constexpr glm::ivec2 field_picture{640, 480};

// A level terrain with a tile of 4 m whose heights are 0.4 m.
struct Field {
    scene::Scene scene;
    scene::TerrainNode* terrain = nullptr;
    scene::Camera camera = test::camera_at({0.0, 0.0, 2.0}, {0.0, 1.0, 2.0});

    explicit Field(const std::string& technique = "relief", double error = 0.0) {
        terrain = test::add_terrain(scene, test::plane_heightfield(Grid<float>(3, 3, 0.0F)))
                      .get<scene::TerrainNode>();
        scene::TerrainDetail detail;
        detail.set = std::make_shared<const material::ReliefMaterial>();
        detail.scale = 0.1F;
        detail.technique = scene::parse_technique(technique).value();
        terrain->detail = std::make_shared<const scene::TerrainDetail>(detail);
        terrain->material.technique = {scene::Polygons{.error = error}, {}};
    }
    [[nodiscard]] view::DetailLevel at(double distance) const {
        return view::seen_detail(*terrain, camera, field_picture, distance);
    }
    // Where what is so long on the ground is so many pixels on the picture.
    [[nodiscard]] double distance_of(double metres, double pixels) const {
        const double half = std::tan(0.5 * camera.vertical_fov * std::acos(-1.0) / 180.0);
        return metres / pixels * field_picture.y / (2.0 * half);
    }
};

TEST(GroundView, HeightsAreLookedForToAPixelAndTheTileIsSeenToEight) {
    const Field field;
    EXPECT_EQ(field.at(0.0), view::DetailLevel::relief);
    EXPECT_EQ(field.at(field.distance_of(0.4, 1.001)), view::DetailLevel::relief);
    EXPECT_EQ(field.at(field.distance_of(0.4, 0.999)), view::DetailLevel::light);
    EXPECT_EQ(field.at(field.distance_of(4.0, 8.001)), view::DetailLevel::light);
    EXPECT_EQ(field.at(field.distance_of(4.0, 7.999)), view::DetailLevel::none);
    EXPECT_EQ(field.at(std::numeric_limits<double>::infinity()), view::DetailLevel::none);
}

TEST(GroundView, HeightsUnderTheErrorOfThePolygonsAreNotLookedFor) {
    const Field field("exact", 4.0);
    EXPECT_EQ(field.at(field.distance_of(0.4, 4.001)), view::DetailLevel::relief);
    EXPECT_EQ(field.at(field.distance_of(0.4, 3.999)), view::DetailLevel::light);
}

TEST(GroundView, WhatLooksForNoSurfaceIsLightEverywhere) {
    const Field field("normal");
    EXPECT_EQ(field.at(0.0), view::DetailLevel::light);
}

TEST(GroundView, OnAMapTheDistanceDoesNotCount) {
    Field field;
    field.camera.projection = scene::ProjectionKind::orthographic;
    field.camera.view_height = field_picture.y * 4.0 / 9.0; // nine pixels a tile
    EXPECT_EQ(field.at(0.0), view::DetailLevel::light);
    EXPECT_EQ(field.at(1e6), view::DetailLevel::light);
    field.camera.view_height = field_picture.y * 4.0 / 7.0;
    EXPECT_EQ(field.at(0.0), view::DetailLevel::none);
}

TEST(GroundView, OnlyPolygonsCarryIt) {
    Field field;
    field.terrain->material.technique = scene::make_technique(scene::TechniqueId::exact);
    EXPECT_EQ(field.at(0.0), view::DetailLevel::none);
    field.terrain->material.technique = scene::make_technique(scene::TechniqueId::polygons);
    EXPECT_EQ(field.at(0.0), view::DetailLevel::relief);
    field.terrain->detail = nullptr;
    EXPECT_EQ(field.at(0.0), view::DetailLevel::none);
}

} // namespace
} // namespace reljef::render
