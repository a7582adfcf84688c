#include "engine/render/residency/mesh_warp.h"

#include <cmath>
#include <memory>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/chance.h"

namespace reljef::render {
namespace {

// Smooth, and it fits together at its borders.
scene::SurfaceDetail waves(float offset) {
    constexpr int side = 48;
    material::ReliefMaterial set;
    set.heights = Grid<float>(side, side);
    const double step = 2.0 * std::acos(-1.0) / side;
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            set.heights(col, row) =
                static_cast<float>(0.5 + 0.3 * std::sin(step * col) + 0.2 * std::cos(step * row));
        }
    }
    scene::SurfaceDetail detail;
    detail.set = std::make_shared<const material::ReliefMaterial>(std::move(set));
    detail.repeats = {2.0F, 3.0F};
    detail.offset = offset;
    return detail;
}

// Local metres of what a sample shows.
glm::dvec3 shown_point(const scene::TexturePlane& plane, const scene::SurfaceDetail& detail,
                       double lift, const glm::vec4& shown) {
    const glm::dvec2 coordinate = glm::dvec2(shown) / glm::dvec2(detail.repeats);
    return plane.origin + coordinate.x * plane.along_u + coordinate.y * plane.along_v +
           (static_cast<double>(shown.z) + detail.offset) * lift * plane.normal;
}

// Each place shows the point of the relief that the eye sees there: forward, the ray from the eye
// to that point meets the mesh within a sample of the place.
TEST(MeshWarp, IsTheForwardProjectionOfTheDisplacedTexels) {
    const scene::Mesh mesh = scene::plane_mesh({4.0F, 6.0F});
    const auto plane = scene::texture_plane(mesh);
    ASSERT_TRUE(plane);
    test::Chance chance(51);
    for (int i = 0; i < 12; ++i) {
        const scene::SurfaceDetail detail = waves(static_cast<float>(chance.between(-1.0, 0.0)));
        constexpr double lift = 0.15;
        const bool is_near = chance.one_in(2);
        const glm::dvec4 eye(chance.between(-4.0, 4.0), chance.between(-4.0, 4.0),
                             chance.between(2.0, 6.0), is_near ? 1.0 : 0.0);
        const Grid<glm::vec4> shown = warped_tile(*plane, detail, lift, eye);
        int seen = 0;
        for (int row = 0; row < shown.rows(); ++row) {
            for (int col = 0; col < shown.cols(); ++col) {
                if (shown(col, row).w == 0.0F) {
                    continue;
                }
                ++seen;
                const glm::dvec3 point = shown_point(*plane, detail, lift, shown(col, row));
                const glm::dvec3 way = is_near ? glm::dvec3(eye) - point : glm::dvec3(eye);
                const glm::dvec3 met = point - way * (point.z / way.z);
                const glm::dvec3 place(4.0 * ((col + 0.5) / shown.cols() - 0.5),
                                       6.0 * (0.5 - (row + 0.5) / shown.rows()), 0.0);
                const double sample = std::max(4.0 / shown.cols(), 6.0 / shown.rows());
                ASSERT_LT(glm::distance(met, place), sample) << i << ' ' << col << ' ' << row;
            }
        }
        EXPECT_GT(seen, static_cast<int>(shown.size() / 2));
    }
}

TEST(MeshWarp, OfALevelTileAtTheMeshIsTheTileItself) {
    scene::SurfaceDetail detail = waves(-1.0F);
    material::ReliefMaterial level = *detail.set;
    level.heights = Grid<float>(16, 16, 1.0F);
    detail.set = std::make_shared<const material::ReliefMaterial>(std::move(level));
    const auto plane = scene::texture_plane(scene::plane_mesh({4.0F, 6.0F}));
    const Grid<glm::vec4> shown = warped_tile(*plane, detail, 0.2, {1.0, 2.0, 3.0, 1.0});
    ASSERT_EQ(shown.cols(), 32);
    ASSERT_EQ(shown.rows(), 48);
    for (int row = 0; row < shown.rows(); ++row) {
        for (int col = 0; col < shown.cols(); ++col) {
            ASSERT_NEAR(shown(col, row).x, (col + 0.5) / 16.0, 1e-5);
            ASSERT_NEAR(shown(col, row).y, (row + 0.5) / 16.0, 1e-5);
            ASSERT_EQ(shown(col, row).w, 1.0F);
        }
    }
}

TEST(MeshWarp, FromBehindNothingIsSeen) {
    const auto plane = scene::texture_plane(scene::plane_mesh({4.0F, 6.0F}));
    const Grid<glm::vec4> shown = warped_tile(*plane, waves(-0.5F), 0.2, {1.0, 2.0, -3.0, 1.0});
    for (const glm::vec4& at : shown.samples()) {
        ASSERT_EQ(at.w, 0.0F);
    }
}

} // namespace
} // namespace reljef::render
