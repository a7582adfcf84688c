#include "engine/scene/graph/surface_detail.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/chance.h"

namespace reljef::scene {
namespace {

TEST(SurfaceDetail, ATileIsAsWideAsThePlaneOverItsRepeats) {
    EXPECT_NEAR(tile_width(plane_mesh({6.0F, 6.0F}), {3.0F, 3.0F}), 2.0, 1e-6);
    // Not square: as wide as the square of its area.
    EXPECT_NEAR(tile_width(plane_mesh({8.0F, 2.0F}), {1.0F, 1.0F}), 4.0, 1e-6);
    EXPECT_NEAR(tile_width(plane_mesh({8.0F, 2.0F}), {4.0F, 1.0F}), 2.0, 1e-6);
}

TEST(SurfaceDetail, OfASphereIsItsAreaOverItsTiles) {
    // 4 pi r^2 of a finely cut sphere.
    EXPECT_NEAR(tile_width(sphere_mesh(2.0F, 200), {4.0F, 2.0F}), 2.5066, 1e-2);
}

TEST(SurfaceDetail, LiftsByItsScaleOfATile) {
    SurfaceDetail detail;
    detail.repeats = {3.0F, 3.0F};
    detail.scale = 0.1F;
    EXPECT_NEAR(relief_height(plane_mesh({6.0F, 6.0F}), detail), 0.2, 1e-6);
}

TEST(SurfaceDetail, WithoutTextureCoordinatesLiftsNothing) {
    Mesh mesh = plane_mesh({6.0F, 6.0F});
    for (glm::vec2& coordinate : mesh.texture_coordinates) {
        coordinate = glm::vec2(0.5F);
    }
    EXPECT_EQ(tile_width(mesh, {1.0F, 1.0F}), 0.0);
    EXPECT_EQ(tile_width({}, {1.0F, 1.0F}), 0.0);
}

SurfaceDetail noise_detail(float offset) {
    test::Chance chance(41);
    material::ReliefMaterial set;
    set.color = Image(4, 4);
    set.heights = Grid<float>(13, 11);
    for (float& height : set.heights.samples()) {
        height = static_cast<float>(chance.between(0.0, 1.0));
    }
    SurfaceDetail detail;
    detail.set = std::make_shared<const material::ReliefMaterial>(std::move(set));
    detail.repeats = {2.3F, 1.7F}; // neither whole: no two faces agree at their edge
    detail.scale = 0.3F;
    detail.offset = offset;
    return detail;
}

// Each edge of a closed surface is passed as often one way as the other.
bool is_closed(const Mesh& mesh) {
    using Place = std::tuple<float, float, float>;
    std::map<std::pair<Place, Place>, int> balance;
    const auto place = [&](std::uint32_t index) {
        const glm::vec3 p = mesh.positions[index] + 0.0F;
        return Place{p.x, p.y, p.z};
    };
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Place from = place(mesh.indices[i + k]);
            const Place to = place(mesh.indices[i + (k + 1) % 3]);
            ++balance[{from, to}];
            --balance[{to, from}];
        }
    }
    return std::all_of(balance.begin(), balance.end(), [](const auto& edge) {
        return edge.second == 0 || edge.first.first == edge.first.second;
    });
}

TEST(Displacement, HasNoCracksWhereNormalsOrCoordinatesPart) {
    for (const float offset : {-1.0F, -0.4F, 0.0F}) {
        const SurfaceDetail detail = noise_detail(offset);
        for (const Mesh& shape : {box_mesh({1.0F, 2.0F, 1.5F}), cylinder_mesh(1.0F, 2.0F, 12),
                                  sphere_mesh(1.0F, 12), torus_mesh(1.0F, 0.3F, 12)}) {
            Mesh fine = tessellated(shape, 5);
            ASSERT_TRUE(is_closed(fine));
            fine.positions = displaced_positions(fine, detail);
            EXPECT_TRUE(is_closed(fine)) << offset;
        }
    }
}

// A level lift moves a box's faces outwards as they are: its edges stay edges.
TEST(Displacement, LiftsABoxIntoALargerBox) {
    SurfaceDetail detail = noise_detail(0.0F);
    material::ReliefMaterial level = *detail.set;
    level.heights = Grid<float>(4, 4, 0.5F);
    detail.set = std::make_shared<const material::ReliefMaterial>(std::move(level));
    Mesh fine = tessellated(box_mesh({2.0F, 2.0F, 2.0F}), 4);
    const auto lift = static_cast<float>(0.5 * relief_height(fine, detail));
    fine.positions = displaced_positions(fine, detail);
    for (const glm::vec3& position : fine.positions) {
        const glm::vec3 off = glm::abs(position);
        ASSERT_NEAR(std::max({off.x, off.y, off.z}), 1.0F + lift, 1e-5F);
    }
    EXPECT_NEAR(bounds_of(fine).high.x, 1.0F + lift, 1e-5F);
}

TEST(Displacement, OfASmoothMeshIsAlongItsNormals) {
    const SurfaceDetail detail = noise_detail(-0.5F);
    const Mesh plane = tessellated(plane_mesh({3.0F, 3.0F}), 7);
    const auto positions = displaced_positions(plane, detail);
    const double lift = relief_height(plane, detail);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const glm::dvec2 coordinate =
            glm::dvec2(plane.texture_coordinates[i]) * glm::dvec2(detail.repeats);
        const double height = tile_height(*detail.set, coordinate, detail.border);
        ASSERT_NEAR(positions[i].z, (height - 0.5) * lift, 1e-6);
    }
}

} // namespace
} // namespace reljef::scene
