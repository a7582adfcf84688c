#include "engine/terrain/mesh/skirt.h"

#include <map>

#include <gtest/gtest.h>

#include "tests/terrain/chance.h"
#include "tests/terrain/made_bisection.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

constexpr Tile tile{128, 0, 72, 90, {}};

// The number of quads on each side: north, east, south, west.
std::array<int, 4> quads_of(std::span<const Triangulation> walls) {
    std::array<int, 4> quads{};
    const Steps first = steps_of({tile.col, tile.row});
    const Steps last = steps_of({tile.col + tile.cols, tile.row + tile.rows});
    for (const Triangulation& part : walls) {
        for (std::size_t i = 0; i < part.vertices.size(); i += 4) {
            const Steps a = part.vertices[i];
            const Steps b = part.vertices[i + 2];
            quads[0] += a.y == first.y && b.y == first.y ? 1 : 0;
            quads[1] += a.x == last.x && b.x == last.x ? 1 : 0;
            quads[2] += a.y == last.y && b.y == last.y ? 1 : 0;
            quads[3] += a.x == first.x && b.x == first.x ? 1 : 0;
        }
    }
    return quads;
}

class SkirtTest : public ::testing::Test {
protected:
    Heightfield heightfield_ = test::plane_heightfield(test::rough_hills(201, 91, 3), {3.0, 4.0});
    Placement placement_ = Placement::create(heightfield_, PlacementKind::plane, 2.0).value();
};

TEST_F(SkirtTest, HangsFromEachSampleOfTheNamedSides) {
    const auto walls =
        skirt_below_samples(tile, heightfield_, placement_, {.depth = 6.0, .east = false});
    EXPECT_EQ(quads_of(walls), (std::array{72, 0, 72, 90}));
}

TEST_F(SkirtTest, FacesOutwardsAndFallsByItsDepth) {
    for (const Triangulation& part :
         skirt_below_samples(tile, heightfield_, placement_, {.depth = 6.0})) {
        const auto place = [&](std::size_t vertex) {
            const glm::dvec2 sample = samples_of(part.vertices[vertex]);
            const double height = bilinear_height(heightfield_.heights.view(), sample);
            return placement_.world_from_sample({sample, height}) + part.moves[vertex].offset;
        };
        const glm::dvec3 middle = placement_.world_from_sample({164.0, 45.0, 0.0});
        for (std::size_t i = 0; i < part.indices.size(); i += 3) {
            const glm::dvec3 a = place(part.indices[i]);
            const glm::dvec3 normal =
                glm::cross(place(part.indices[i + 1]) - a, place(part.indices[i + 2]) - a);
            ASSERT_GT(glm::dot(glm::dvec2(normal), glm::dvec2(a - middle)), 0.0);
        }
        for (std::size_t i = 0; i < part.vertices.size(); i += 2) {
            ASSERT_EQ(part.vertices[i], part.vertices[i + 1]);
            ASSERT_EQ(part.moves[i], VertexMove{});
            ASSERT_NEAR(part.moves[i + 1].offset.z, -6.0, 1e-9);
            ASSERT_NEAR(part.moves[i + 1].height, -3.0, 1e-9);
        }
    }
}

TEST_F(SkirtTest, HasTheBorderEdgesOfTheTrianglesAndNoOthers) {
    const Bisection bisection(heightfield_, placement_);
    ErrorView view;
    view.perspective = false;
    view.max_error = 5.0;
    const auto parts = triangulate(bisection, tile, view).parts;
    std::map<std::pair<std::int64_t, std::int64_t>, int> ends; // of upper edges
    for (const Triangulation& part :
         skirt_below(parts, tile, heightfield_, placement_, {.depth = 1.0})) {
        for (std::size_t i = 0; i < part.vertices.size(); i += 4) {
            ++ends[{part.vertices[i].x, part.vertices[i].y}];
            --ends[{part.vertices[i + 2].x, part.vertices[i + 2].y}];
        }
    }
    EXPECT_GT(ends.size(), 8U);
    for (const auto& [place, count] : ends) {
        EXPECT_EQ(count, 0) << "the border is not closed at " << place.first << ' ' << place.second;
    }
}

} // namespace
} // namespace reljef::terrain
