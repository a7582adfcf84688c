#include "engine/building/building_faces.h"

#include <cmath>
#include <map>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/building/made_outline.h"

namespace reljef::building {
namespace {

// Of a closed surface by the divergence theorem; the floor at z = foot is missing.
double volume_above(const std::vector<Face>& faces, double foot) {
    double volume = 0.0;
    for (const Face& face : faces) {
        const glm::dvec3 a = face.corners[0] - glm::dvec3(0.0, 0.0, foot);
        for (std::size_t i = 1; i + 1 < face.corners.size(); ++i) {
            const glm::dvec3 b = face.corners[i] - glm::dvec3(0.0, 0.0, foot);
            const glm::dvec3 c = face.corners[i + 1] - glm::dvec3(0.0, 0.0, foot);
            volume += glm::dot(a, glm::cross(b, c)) / 6.0;
        }
    }
    return volume;
}

// Each edge above the foot is there once in each direction.
bool is_closed_above(const std::vector<Face>& faces, double foot) {
    using Corner = std::tuple<double, double, double>;
    std::map<std::pair<Corner, Corner>, int> edges;
    const auto corner = [](glm::dvec3 at) { return Corner(at.x, at.y, at.z); };
    for (const Face& face : faces) {
        for (std::size_t i = 0; i < face.corners.size(); ++i) {
            const glm::dvec3 a = face.corners[i];
            const glm::dvec3 b = face.corners[(i + 1) % face.corners.size()];
            if (a != b && (a.z > foot || b.z > foot)) {
                ++edges[{corner(a), corner(b)}];
                --edges[{corner(b), corner(a)}];
            }
        }
    }
    return std::all_of(edges.begin(), edges.end(),
                       [](const auto& edge) { return edge.second == 0; });
}

Footprint courtyard() {
    Footprint shape;
    shape.rings = {test::rectangle_ring({0.0, 0.0}, {20.0, 20.0}),
                   {{5.0, 5.0}, {5.0, 15.0}, {15.0, 15.0}, {15.0, 5.0}}};
    shape.triangles = {{0, 1, 7}, {0, 7, 4}, {1, 2, 6}, {1, 6, 7},
                       {2, 3, 5}, {2, 5, 6}, {3, 0, 4}, {3, 4, 5}};
    return shape;
}

Footprint triangle(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return {{{a, b, c}}, {{0U, 1U, 2U}}};
}

Footprint convex(unsigned seed) {
    Footprint shape;
    shape.rings = {test::random_convex(seed)};
    for (unsigned i = 1; i + 1 < shape.rings[0].size(); ++i) {
        shape.triangles.emplace_back(0U, i, i + 1);
    }
    return shape;
}

TEST(BuildingFaces, OfACourtyardKeepItOpen) {
    const auto faces = flat_building(courtyard(), {-1.0, 0.0, 9.0});
    EXPECT_NEAR(volume_above(faces, -1.0), (400.0 - 100.0) * 10.0, 1e-9);
    EXPECT_TRUE(is_closed_above(faces, -1.0));
}

TEST(BuildingFaces, AreClosedAndFaceOutwards) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        const Footprint shape = convex(seed);
        const double area = signed_area(shape.rings[0]);
        const auto flat = building_of(shape, RoofKind::flat, -1.0, 7.0);
        EXPECT_TRUE(is_closed_above(flat, -1.0)) << seed;
        EXPECT_NEAR(volume_above(flat, -1.0), area * 8.0, 1e-6 * area);
        const auto hipped = building_of(shape, RoofKind::hipped, -1.0, 7.0);
        const double volume = volume_above(hipped, -1.0);
        EXPECT_LT(volume, area * 8.0) << seed;
        EXPECT_GT(volume, area * 4.5) << "at most half of the height is roof";
        double highest = 0.0;
        for (const Face& face : hipped) {
            for (const glm::dvec3 corner : face.corners) {
                highest = std::max(highest, corner.z);
            }
        }
        EXPECT_NEAR(highest, 7.0, 1e-5) << seed;
    }
}

TEST(BuildingFaces, OfHippedRoofsMeetInTheSameCorners) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        const auto hipped = building_of(convex(seed), RoofKind::hipped, -1.0, 7.0);
        std::map<std::pair<double, double>, int> ridges;
        for (const Face& face : hipped) {
            for (const glm::dvec3 corner : face.corners) {
                if (face.facade.empty() && corner.z > 6.0) {
                    ++ridges[{corner.x, corner.y}];
                }
            }
        }
        for (const auto& [at, count] : ridges) {
            EXPECT_GE(count, 2) << seed << ": " << at.first << ", " << at.second;
        }
    }
}

TEST(BuildingFaces, AreFlatWhereNoHippedRoofIsPossible) {
    Footprint corner;
    corner.rings = {{{0.0, 0.0}, {20.0, 0.0}, {20.0, 8.0}, {8.0, 8.0}, {8.0, 20.0}, {0.0, 20.0}}};
    corner.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    for (const Face& face : building_of(corner, RoofKind::hipped, 0.0, 6.0)) {
        if (face.facade.empty()) {
            EXPECT_EQ(face.corners[0].z, 6.0);
        }
    }
}

TEST(BuildingFaces, WallsHaveWholeWindowsAndStoreys) {
    const auto faces = flat_building(courtyard(), {-1.0, 0.0, 9.2});
    const Face& wall = faces.front();
    ASSERT_EQ(wall.facade.size(), 4U);
    EXPECT_DOUBLE_EQ(wall.facade[1].x, 6.0) << "20 m";
    EXPECT_DOUBLE_EQ(wall.facade[2].y, 0.0) << "at the eaves";
    EXPECT_NEAR(wall.facade[0].y, 3.0 * 10.2 / 9.2, 1e-12) << "three storeys, and the foot";
}

TEST(BuildingFaces, OfABoxAreItsSidesAndLid) {
    const auto faces = box_faces(test::rectangle_ring({0.0, 0.0}, {2.0, 3.0}), 0.0, 4.0);
    EXPECT_EQ(faces.size(), 5U);
    EXPECT_NEAR(volume_above(faces, 0.0), 24.0, 1e-12);
}

TEST(Buildings, OutlinesOfAllSizesHaveARoof) {
    for (double size = 1e-6; size < 1e300; size *= 3.0) {
        for (const double width : {1e-9, 1e-3, 1.0}) {
            const Footprint shape =
                triangle({7.0, 45.0}, {7.0 + size, 45.0}, {7.0, 45.0 + size * width});
            const auto faces = building_of(shape, RoofKind::hipped, -1.0, 9.0);
            EXPECT_FALSE(faces.empty()) << size << " " << width;
        }
    }
    const Footprint least = triangle({0.0, 0.0}, {1e-200, 0.0}, {0.0, 9.0});
    for (const Face& face : building_of(least, RoofKind::flat, -1.0, 9.0)) {
        for (const glm::dvec2 window : face.facade) {
            EXPECT_TRUE(std::isfinite(window.x) && std::isfinite(window.y));
        }
    }
    EXPECT_FALSE(has_hips(triangle({0.0, 0.0}, {1e-4, 0.0}, {0.0, 1e-4}), RoofKind::hipped));
    EXPECT_TRUE(has_hips(triangle({0.0, 0.0}, {9.0, 0.0}, {0.0, 9.0}), RoofKind::hipped));
}

} // namespace
} // namespace reljef::building
