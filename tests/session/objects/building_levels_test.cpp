// Levels of detail of a city's buildings.
#include "engine/session/objects/building_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

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

using Chance = std::mt19937;

double between(Chance& chance, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(chance);
}

// A convex outline with short edges among long ones, a flat or hipped roof, and a box on it.
std::vector<building::PaintedFaces> random_house(Chance& chance) {
    const glm::dvec2 middle(between(chance, 0.0, 200.0), between(chance, 0.0, 200.0));
    const glm::dvec2 radius(between(chance, 2.0, 20.0), between(chance, 2.0, 20.0));
    building::Footprint footprint;
    footprint.rings.emplace_back();
    const double step = between(chance, 0.02, 1.2);
    for (double turn = between(chance, 0.0, 1.0); turn < 2.0 * std::numbers::pi;
         turn += step * between(chance, 0.1, 1.0)) {
        footprint.rings[0].push_back(middle + radius * glm::dvec2(std::cos(turn), std::sin(turn)));
    }
    for (std::uint32_t i = 1; i + 1 < footprint.rings[0].size(); ++i) {
        footprint.triangles.emplace_back(0U, i, i + 1);
    }
    const double height = between(chance, 3.0, 40.0);
    const auto roof = chance() % 2 == 0 ? building::RoofKind::flat : building::RoofKind::hipped;
    building::PaintedFaces walls;
    walls.faces = building::building_of(footprint, roof, between(chance, -3.0, 0.0), height);
    walls.color = glm::vec3(between(chance, 0.0, 1.0), 0.2F, 0.2F);
    building::PaintedFaces box;
    const double side = between(chance, 0.1, 2.0);
    box.faces = building::box_faces(
        {middle, middle + glm::dvec2(side, 0.0), middle + side, middle + glm::dvec2(0.0, side)},
        height - 2.0, height + between(chance, 0.1, 6.0));
    box.color = glm::vec3(0.1F, 0.1F, between(chance, 0.0, 1.0));
    return {walls, box};
}

glm::dvec3 random_place(const scene::Mesh& mesh, Chance& chance) {
    const auto corners = scene::triangle_corners(mesh, chance() % (mesh.indices.size() / 3) * 3);
    double p = between(chance, 0.0, 1.0);
    double q = between(chance, 0.0, 1.0);
    if (p + q > 1.0) {
        p = 1.0 - p;
        q = 1.0 - q;
    }
    return corners[0] + p * (corners[1] - corners[0]) + q * (corners[2] - corners[0]);
}

// By all triangles.
double distance_to(std::initializer_list<const scene::Mesh*> meshes, glm::dvec3 place) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const scene::Mesh* const mesh : meshes) {
        for (std::size_t i = 0; i < mesh->indices.size(); i += 3) {
            const auto corners = scene::triangle_corners(*mesh, i);
            nearest = std::min(nearest, glm::distance(place, scene::nearest_point(corners, place)));
        }
    }
    return nearest;
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

// The proof's trees and bounds are left out: points are compared with all triangles.
TEST(LevelsOfRandomBuildings, AreNoFartherAwayThanTheySay) {
    constexpr int places = 150;
    constexpr double rounding = 1e-4; // metres: vertices are floats
    std::size_t levels = 0;
    for (const unsigned seed : {1U, 2U, 3U, 4U}) {
        Chance chance(seed);
        BuildingMeshes meshes;
        for (int i = 0; i < 12; ++i) {
            for (const building::PaintedFaces& part : random_house(chance)) {
                meshes.add(part, glm::dmat4(1.0));
            }
        }
        scene::Scene scene;
        ASSERT_TRUE(meshes.add_to(scene.root(), true));
        const scene::Node& square = *scene.root().children().front();
        const auto* const walls = square.children().front()->get<scene::MeshNode>();
        const auto* const others = square.children().back()->get<scene::MeshNode>();
        ASSERT_TRUE(walls->levels && others->levels) << seed;
        ASSERT_EQ(walls->levels->size(), others->levels->size());
        for (std::size_t i = 0; i < walls->levels->size(); ++i, ++levels) {
            const scene::MeshLevel& wall = (*walls->levels)[i];
            const scene::MeshLevel& other = (*others->levels)[i];
            for (int place = 0; place < places; ++place) {
                const auto& [coarse, whole] = place % 2 == 0
                                                  ? std::pair(wall.mesh.get(), walls->mesh.get())
                                                  : std::pair(other.mesh.get(), others->mesh.get());
                EXPECT_LE(distance_to({whole}, random_place(*coarse, chance)),
                          wall.error + rounding)
                    << "of the same kind; seed " << seed << ", level " << i;
                EXPECT_LE(
                    distance_to({wall.mesh.get(), other.mesh.get()}, random_place(*whole, chance)),
                    wall.error + rounding)
                    << "of either; seed " << seed << ", level " << i;
            }
        }
    }
    EXPECT_GT(levels, 8U);
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
