// Levels of detail of a city's buildings.
#include "engine/session/objects/building_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "engine/scene/levels/mesh_distance.h"
#include "engine/session/objects/building_meshes.h"
#include "engine/view/draw_list.h"

namespace reljef::session {
namespace {

// A house of 30 by 20 m with steps of 0.3 m in a wall, and a chimney on it.
std::vector<building::PaintedFaces> house(double x) {
    building::Ring outline{{x, 0.0}, {x + 30.0, 0.0}, {x + 30.0, 20.0}};
    for (int i = 10; i > 0; --i) {
        const double step = i % 2 == 0 ? 20.0 : 19.7;
        outline.emplace_back(x + 2.5 * i, step);
        outline.emplace_back(x + 2.5 * i, i % 2 == 0 ? 19.7 : 20.0);
    }
    outline.emplace_back(x, 20.0);
    building::Footprint footprint;
    footprint.rings = {outline};
    for (std::uint32_t i = 1; i + 1 < outline.size(); ++i) {
        footprint.triangles.emplace_back(0U, i, i + 1);
    }
    building::PaintedFaces walls;
    walls.faces = building::flat_building(footprint, {-1.0, 0.0, 12.0});
    walls.color = {0.5F, 0.1F, 0.1F};
    building::PaintedFaces chimney;
    chimney.faces =
        building::box_faces({{x + 9, 9}, {x + 10, 9}, {x + 10, 10}, {x + 9, 10}}, 12.0, 13.2);
    chimney.color = {0.1F, 0.1F, 0.5F};
    return {walls, chimney};
}

class LevelsOfBuildings : public testing::Test {
protected:
    LevelsOfBuildings() {
        BuildingMeshes meshes;
        for (int i = 0; i < 4; ++i) {
            for (const building::PaintedFaces& part : house(40.0 * i)) {
                meshes.add(part, glm::dmat4(1.0));
            }
        }
        EXPECT_TRUE(meshes.add_to(scene_.root(), true));
        const scene::Node& square = *scene_.root().children().front();
        walls_ = square.children().front()->get<scene::MeshNode>();
        roofs_ = square.children().back()->get<scene::MeshNode>();
    }
    static scene::Mesh joined(const scene::Mesh& a, const scene::Mesh& b) {
        scene::Mesh both = a;
        const auto first = static_cast<std::uint32_t>(a.positions.size());
        both.positions.insert(both.positions.end(), b.positions.begin(), b.positions.end());
        for (const std::uint32_t index : b.indices) {
            both.indices.push_back(first + index);
        }
        return both;
    }

    scene::Scene scene_;
    const scene::MeshNode* walls_ = nullptr;
    const scene::MeshNode* roofs_ = nullptr;
};

TEST_F(LevelsOfBuildings, StateHowFarTheyAreAway) {
    ASSERT_TRUE(walls_->levels && roofs_->levels);
    ASSERT_EQ(walls_->levels->size(), roofs_->levels->size());
    const scene::Mesh whole = joined(*walls_->mesh, *roofs_->mesh);
    std::size_t before = whole.indices.size();
    for (std::size_t i = 0; i < walls_->levels->size(); ++i) {
        const scene::MeshLevel& walls = (*walls_->levels)[i];
        const scene::MeshLevel& roofs = (*roofs_->levels)[i];
        EXPECT_EQ(walls.error, roofs.error) << "they change together";
        const scene::Mesh level = joined(*walls.mesh, *roofs.mesh);
        EXPECT_LE(8 * level.indices.size(), 7 * before);
        EXPECT_LE(*scene::max_distance_between(whole, level), walls.error);
        EXPECT_LE(walls.error, 4.0 * 1.5);
        before = level.indices.size();
    }
    EXPECT_LE(3 * before, whole.indices.size()) << "the steps and chimneys are gone";
}

TEST_F(LevelsOfBuildings, KeepTheSizeOfWindowsAndTheColoursOfRoofs) {
    ASSERT_TRUE(walls_->levels && !walls_->levels->empty());
    for (const scene::MeshLevel& level : *walls_->levels) {
        EXPECT_EQ(level.repeat, building::window_bay);
        for (std::size_t i = 0; i < level.mesh->indices.size(); i += 3) {
            const scene::TriangleEdges edges = scene::triangle_edges(*level.mesh, i);
            const glm::dvec2 windows(building::window_bay, building::window_storey);
            EXPECT_NEAR(glm::length(edges.s * windows), glm::length(edges.p), 1e-3);
            EXPECT_NEAR(glm::length(edges.t * windows), glm::length(edges.q), 1e-3);
        }
    }
    for (const scene::MeshLevel& level : *roofs_->levels) {
        EXPECT_EQ(level.repeat, building::window_bay) << "they wait for the windows";
        for (std::size_t i = 0; i < level.mesh->indices.size(); i += 3) {
            const scene::TriangleEdges edges = scene::triangle_edges(*level.mesh, i);
            EXPECT_EQ(edges.s, glm::dvec2(0.0)) << "one colour";
            EXPECT_EQ(edges.t, glm::dvec2(0.0));
            const auto& known = roofs_->mesh->texture_coordinates;
            EXPECT_NE(std::find(known.begin(), known.end(),
                                level.mesh->texture_coordinates[level.mesh->indices[i]]),
                      known.end());
        }
    }
}

// Only so is what is drawn what was proven.
TEST_F(LevelsOfBuildings, AreTheSameOfWallsAndRoofsFromEverywhere) {
    view::DrawList list;
    list.size = {512, 384};
    std::mt19937 random(7);
    std::uniform_real_distribution<double> power(1.5, 4.0); // of ten, metres
    std::uniform_real_distribution<double> turn(-180.0, 180.0);
    std::array<std::size_t, 3> chosen{};
    for (int i = 0; i < 4000; ++i) {
        const double distance = std::pow(10.0, power(random));
        const double angle = glm::radians(turn(random));
        list.camera.target = {70.0, 10.0, 5.0};
        list.camera.eye =
            list.camera.target + distance * glm::dvec3(std::cos(angle), std::sin(angle), 0.3);
        const auto level_of = [&](const scene::MeshNode& node) {
            view::MeshDraw draw;
            draw.mesh = &node;
            draw.local_bounds = scene::bounds_of(*node.mesh);
            return view::with_level(draw, list, 4.0);
        };
        const view::MeshDraw walls = level_of(*walls_);
        const view::MeshDraw roofs = level_of(*roofs_);
        ASSERT_EQ(walls.level, roofs.level) << distance;
        ASSERT_EQ(walls.error, roofs.error) << distance;
        ++chosen.at(std::min(walls.level, chosen.size() - 1));
    }
    EXPECT_GT(chosen[0], 100U);
    EXPECT_GT(chosen[1] + chosen[2], 100U);
}

} // namespace
} // namespace reljef::session
