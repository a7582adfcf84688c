#include "engine/view/triangles/slivers.h"

#include <algorithm>
#include <array>
#include <numeric>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/scene/graph/scene.h"
#include "engine/view/error_view.h"
#include "engine/view/select.h"
#include "tests/render/made_scene.h"
#include "tests/support/test_data.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::view {
namespace {

using Numbers = std::vector<std::uint32_t>;

constexpr glm::ivec2 seen_size{640, 480};
constexpr double distance = 100.0; // metres from the eye to the triangles

// A level terrain of 65 by 65 samples, seen straight down.
class SliverViewTest : public testing::Test {
protected:
    SliverViewTest() {
        node_ = &test::add_terrain(scene_, test::plane_heightfield(Grid<float>(65, 65, 0.0F)));
        node_->get<scene::TerrainNode>()->material.technique =
            scene::parse_technique("polygons:error=1").value();
        camera_ = &scene_.add_camera(test::camera_at({0.0, 0.0, distance}, {0.0, 0.0, 0.0}));
        list_ = select(scene_, seen_size).list;
    }

    [[nodiscard]] double pixels_a_metre() const {
        return 0.5 * seen_size.y / std::tan(0.5 * glm::radians(scene_.camera().vertical_fov)) /
               distance;
    }

    // One triangle, at pixels from the middle of the picture, with a place a sample apart each.
    [[nodiscard]] Slivers slivers_of(std::array<glm::dvec2, 3> pixels, double place = 10.0) const {
        const std::array places{glm::dvec2(place), glm::dvec2(place + 1.0, place),
                                glm::dvec2(place, place + 1.0)};
        std::vector<GridVertex> vertices;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec2 metres = pixels[i] / pixels_a_metre();
            vertices.push_back(grid_vertex({metres, 0.0}, 0.0, places[i]));
        }
        const std::array<std::uint16_t, 3> indices{0, 1, 2};
        return SliverView(list_, list_.tiles.front(), {}).slivers({vertices, indices, nullptr});
    }
    [[nodiscard]] bool is_sliver(std::array<glm::dvec2, 3> pixels, double place = 10.0) const {
        return !slivers_of(pixels, place).all().empty();
    }

    scene::Scene scene_;
    scene::Node* node_ = nullptr;
    scene::Node* camera_ = nullptr;
    DrawList list_;
};

TEST_F(SliverViewTest, LongAndNarrowTrianglesAreSlivers) {
    for (const double length : {1.0, 30.0, 300.0}) {
        for (const double turn : {0.0, 0.7, 2.0}) {
            const glm::dvec2 along = length * glm::dvec2(std::cos(turn), std::sin(turn));
            const glm::dvec2 across = glm::dvec2(-along.y, along.x);
            EXPECT_FALSE(is_sliver({-0.5 * along, 0.5 * along, 0.5 * across}));
            EXPECT_FALSE(is_sliver({-0.5 * along, 0.5 * along, 0.2 * across}));
            EXPECT_TRUE(is_sliver({-0.5 * along, 0.5 * along, 1e-3 * across}));
            EXPECT_TRUE(is_sliver({-0.5 * along, 0.5 * along, 0.1 * along})) << "no area";
        }
    }
}

TEST_F(SliverViewTest, TheDepthOfTheNarrowestComesFromTheirCornersToo) {
    const auto narrow_of = [&](double width) { // pixels
        const Slivers found =
            slivers_of({glm::dvec2(-50.0, 0.0), glm::dvec2(50.0, 0.0), glm::dvec2(0.0, width)});
        EXPECT_EQ(found.all().size(), 1);
        return found.narrow.size();
    };
    EXPECT_EQ(narrow_of(0.5), 0);
    EXPECT_EQ(narrow_of(1e-2), 1);
}

TEST_F(SliverViewTest, TrianglesWithoutAnErrorMayBeNarrower) {
    const terrain::Bisection bisection(node_->get<scene::TerrainNode>()->surface->heightfield(),
                                       node_->get<scene::TerrainNode>()->surface->placement());
    const terrain::Triangulation part{
        {terrain::Steps(0, 0), terrain::steps_of({0, 4}), terrain::steps_of({4, 0})}, {0, 1, 2}};
    const auto is_wide = [&](double triangle_error, double width) { // pixels
        CutOptions cut;
        cut.bisection = &bisection;
        cut.triangle_error = triangle_error;
        const double metre = pixels_a_metre();
        const std::vector vertices{grid_vertex({-50.0 / metre, 0.0, 0.0}, 0.0, {10.0, 10.0}),
                                   grid_vertex({50.0 / metre, 0.0, 0.0}, 0.0, {11.0, 10.0}),
                                   grid_vertex({0.0, width / metre, 0.0}, 0.0, {10.0, 11.0})};
        const SliverView view(list_, list_.tiles.front(), cut);
        return view.slivers({vertices, part.indices, &part}).all().empty();
    };
    EXPECT_FALSE(is_wide(0.01, 0.7)) << "little is left";
    EXPECT_TRUE(is_wide(1.0, 0.7)) << "level ground";
    EXPECT_FALSE(is_wide(1.0, 1e-2)) << "its depth";
}

TEST_F(SliverViewTest, SoAreLargeOnesFarFromTheTilesFirstSample) {
    const std::array large{glm::dvec2(-200.0, -200.0), glm::dvec2(200.0, -200.0),
                           glm::dvec2(0.0, 200.0)};
    EXPECT_FALSE(is_sliver(large, 1.0));
    EXPECT_TRUE(is_sliver(large, 5000.0));
}

TEST_F(SliverViewTest, WithoutPerspectiveAsWell) {
    scene::Camera level = test::camera_at({0.0, 0.0, distance}, {0.0, 0.0, 0.0});
    level.projection = scene::ProjectionKind::orthographic;
    level.view_height = seen_size.y / pixels_a_metre();
    *camera_->get<scene::Camera>() = level;
    list_ = select(scene_, seen_size).list;
    EXPECT_FALSE(is_sliver({glm::dvec2(-50.0, 0.0), glm::dvec2(50.0, 0.0), glm::dvec2(0.0, 20.0)}));
    EXPECT_TRUE(is_sliver({glm::dvec2(-50.0, 0.0), glm::dvec2(50.0, 0.0), glm::dvec2(0.0, 0.1)}));
    EXPECT_FALSE(
        is_sliver({glm::dvec2(400.0, 0.0), glm::dvec2(500.0, 0.0), glm::dvec2(450.0, 1e-3)}));
    // No depth divides what is interpolated: nothing cuts a triangle, however near.
    const std::vector near{grid_vertex({-1.0, 0.0, 0.0}, 0.0, {0.0, 0.0}),
                           grid_vertex({1.0, 0.0, 0.0}, 0.0, {1.0, 0.0}),
                           grid_vertex({0.0, 1.0, 1.1 * distance}, 0.0, {0.0, 1.0})};
    const std::array<std::uint16_t, 3> indices{0, 1, 2};
    const SliverView view(list_, list_.tiles.front(), {});
    EXPECT_TRUE(view.slivers({near, indices, nullptr}).all().empty());
}

TEST_F(SliverViewTest, TrianglesBesideThePictureAreNone) {
    EXPECT_TRUE(is_sliver({glm::dvec2(0.0, 0.0), glm::dvec2(100.0, 0.0), glm::dvec2(50.0, 1e-3)}));
    EXPECT_FALSE(
        is_sliver({glm::dvec2(400.0, 0.0), glm::dvec2(500.0, 0.0), glm::dvec2(450.0, 1e-3)}));
}

TEST_F(SliverViewTest, TrianglesThatTheNearPlaneCutsAre) {
    const std::array<std::uint16_t, 3> indices{0, 1, 2};
    const SliverView view(list_, list_.tiles.front(), {});
    const auto triangle = [](double top) {
        return std::vector{grid_vertex({-1.0, 0.0, 0.0}, 0.0, {0.0, 0.0}),
                           grid_vertex({1.0, 0.0, 0.0}, 0.0, {1.0, 0.0}),
                           grid_vertex({0.0, 1.0, top}, top, {0.0, 1.0})};
    };
    EXPECT_TRUE(view.slivers({triangle(0.9 * distance), indices, nullptr}).all().empty());
    EXPECT_FALSE(view.slivers({triangle(1.1 * distance), indices, nullptr}).all().empty());
}

TEST(Slivers, AndTheOthersAreAllTriangles) {
    test::Chance chance(5);
    std::vector<GridVertex> vertices;
    for (int i = 0; i < 100; ++i) {
        vertices.push_back(grid_vertex({}, i, {}));
    }
    for (int i = 0; i < 2000; ++i) {
        std::vector<std::uint16_t> indices(3 * static_cast<std::size_t>(chance.whole(0, 20)));
        std::iota(indices.begin(), indices.end(), std::uint16_t{7});
        Numbers slivers;
        for (std::uint32_t t = 0; t < indices.size() / 3; ++t) {
            if (chance.one_in(3)) {
                slivers.push_back(t);
            }
        }
        const std::vector<std::uint16_t> others = without(indices, slivers);
        const std::vector<GridVertex> corners = corners_of(vertices, indices, slivers);
        EXPECT_EQ(corners.size(), 3 * slivers.size());
        std::vector<std::uint16_t> all(others);
        std::transform(
            corners.begin(), corners.end(), std::back_inserter(all),
            [](const GridVertex& vertex) { return static_cast<std::uint16_t>(vertex.height); });
        EXPECT_TRUE(std::is_sorted(others.begin(), others.end()));
        std::sort(all.begin(), all.end());
        EXPECT_EQ(all, indices);
    }
}

} // namespace
} // namespace reljef::view
