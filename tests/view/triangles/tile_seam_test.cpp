#include "engine/view/triangles/tile_seam.h"

#include <algorithm>
#include <map>
#include <set>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/chance.h"
#include "tests/terrain/made_bisection.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::view {
namespace {

constexpr int cells = 64;
constexpr double east = 500.0; // x of the borders, metres

using Border = std::vector<BorderVertex>;
using Key = std::array<float, 6>; // the bits of a vertex

glm::dvec3 place_of(const GridVertex& vertex) {
    return glm::dvec3(vertex.position) + glm::dvec3(vertex.rest);
}

Key key_of(const GridVertex& vertex) {
    const auto& [position, height, place, rest] = vertex;
    return {position.x, position.y, position.z, rest.x, rest.y, rest.z};
}

BorderVertex vertex_at(double at, double height) {
    return {at, grid_vertex({east, 3.0 * (0.5 * cells - at), height}, height, {cells, at})};
}

// From the first to the last sample; half of the heights are those of a plane.
Border random_border(test::Chance& chance, double from, double to) {
    std::set<double> places{from, to};
    const int count = static_cast<int>(chance.between(0.0, 12.0));
    for (int i = 0; i < count; ++i) {
        places.insert(from + (to - from) * std::round(chance.between(0.0, 16.0)) / 16.0);
    }
    Border border;
    for (const double at : places) {
        border.push_back(
            vertex_at(at, chance.between(0.0, 1.0) < 0.5 ? 0.25 * at : chance.between(-50, 50)));
    }
    return border;
}

double height_on(const Border& border, double at) {
    const auto after = std::find_if(border.begin() + 1, border.end() - 1,
                                    [&](const BorderVertex& v) { return v.at >= at; });
    const auto before = after - 1;
    const double share = (at - before->at) / (after->at - before->at);
    return (1.0 - share) * place_of(before->vertex).z + share * place_of(after->vertex).z;
}

double at_of(glm::dvec3 place) {
    return 0.5 * cells - place.y / 3.0;
}

using Corners = std::array<GridVertex, 3>;

std::vector<Corners> triangles_of(const std::vector<SeamPart>& parts) {
    std::vector<Corners> triangles;
    for (const SeamPart& part : parts) {
        for (std::size_t i = 0; i < part.indices.size(); i += 3) {
            triangles.push_back({part.vertices[part.indices[i]], part.vertices[part.indices[i + 1]],
                                 part.vertices[part.indices[i + 2]]});
        }
    }
    return triangles;
}

// The length of a triangle on the vertical line at a place; negative where it faces west.
double length_at(const Corners& corners, double at) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 a = place_of(corners[i]);
        const glm::dvec3 b = place_of(corners[(i + 1) % 3]);
        if ((at_of(a) - at) * (at_of(b) - at) < 0.0) {
            const double z = a.z + (b.z - a.z) * (at - at_of(a)) / (at_of(b) - at_of(a));
            low = std::min(low, z);
            high = std::max(high, z);
        }
    }
    const glm::dvec3 a = place_of(corners[0]);
    const double faces = glm::cross(place_of(corners[1]) - a, place_of(corners[2]) - a).x;
    return low > high ? 0.0 : faces < 0.0 ? low - high : high - low;
}

// As the triangles do that hide roundings.
bool faces_both_ways(const std::vector<Corners>& triangles, const Corners& corners) {
    return std::any_of(triangles.begin(), triangles.end(), [&](const Corners& other) {
        return key_of(other[0]) == key_of(corners[1]) && key_of(other[1]) == key_of(corners[0]) &&
               key_of(other[2]) == key_of(corners[2]);
    });
}

class TileSeams : public ::testing::Test {
protected:
    // Borders are crossed by vertices; sums of roundings of floats' rests.
    static constexpr double rounding = 1e-9; // metres
    // A 64th of an edge, which rises at most 100 m.
    static constexpr double max_depth_of_flap = (3.0 * 2 * cells + 100.0) / 64.0;

    [[nodiscard]] std::vector<Corners> joined(const Border& own, const Border& other,
                                              const OpenSide& open) const {
        TileBorder all;
        TileBorder neighbour;
        all[static_cast<std::size_t>(open.side)] = own;
        neighbour[static_cast<std::size_t>(opposite(open.side))] = other;
        SeamMaker maker(surface_, all);
        maker.join(open, neighbour);
        return triangles_of(maker.take());
    }

    terrain::Heightfield heightfield_ =
        test::plane_heightfield(Grid<float>(cells + 1, cells + 1, 0.0F), {3.0, 3.0});
    terrain::Placement placement_ =
        terrain::Placement::create(heightfield_, terrain::PlacementKind::plane).value();
    TileSurface surface_{heightfield_, placement_, {{0, 0}, {cells, cells}}};
    test::Chance chance_{5};
};

TEST_F(TileSeams, ShowAllBetweenBothBordersOnceAndNothingElse) {
    for (int round = 0; round < 3000; ++round) {
        const Border own = random_border(chance_, 0.0, cells);
        // A larger neighbour's border is longer.
        const bool is_longer = round % 2 == 1;
        const Border other = random_border(chance_, is_longer ? -32.0 : 0.0, is_longer ? 96 : 64);
        const auto triangles = joined(own, other, {TileSide::east, 0.0, cells, {}});
        for (const Corners& corners : triangles) {
            const bool is_flap = faces_both_ways(triangles, corners);
            for (const GridVertex& corner : corners) {
                const glm::dvec3 place = place_of(corner);
                ASSERT_NEAR(place.x, east, rounding);
                const double at = at_of(place);
                const double a = height_on(at < 0 || at > cells ? other : own, at);
                const double b = height_on(other, at);
                ASSERT_GE(place.z, std::min(a, b) - (is_flap ? max_depth_of_flap : rounding));
                ASSERT_LE(place.z, std::max(a, b) + rounding);
                ASSERT_EQ(corner.place.x, cells);
                ASSERT_NEAR(corner.place.y, at, 1e-5); // also of a larger neighbour's vertices
            }
        }
        for (int i = 0; i < 5; ++i) {
            const double at = chance_.between(0.0, cells);
            double shown = 0.0;
            for (const Corners& corners : triangles) {
                shown += length_at(corners, at);
            }
            // The higher border is seen from where the lower one is.
            ASSERT_NEAR(shown, height_on(own, at) - height_on(other, at), 1e-6) << round;
        }
    }
}

// So a rasterizer leaves no pixel free: the edges of the seam that only one of its triangles has
// are the borders' own, to the bit.
TEST_F(TileSeams, HaveTheEdgesOfBothBorders) {
    for (int round = 0; round < 3000; ++round) {
        const Border own = random_border(chance_, 0.0, cells);
        const Border other = random_border(chance_, 0.0, cells);
        std::map<std::pair<Key, Key>, int> counts;
        const auto count = [&](const GridVertex& a, const GridVertex& b) {
            if (key_of(a) != key_of(b)) {
                ++counts[std::minmax(key_of(a), key_of(b))];
            }
        };
        std::set<std::set<Key>> seen; // flaps are there twice
        for (const Corners& corners : joined(own, other, {TileSide::east, 0.0, cells, {}})) {
            if (seen.insert({key_of(corners[0]), key_of(corners[1]), key_of(corners[2])}).second) {
                for (std::size_t i = 0; i < 3; ++i) {
                    count(corners[i], corners[(i + 1) % 3]);
                }
            }
        }
        for (const Border* const border : {&own, &other}) {
            for (std::size_t i = 0; i + 1 < border->size(); ++i) {
                count((*border)[i].vertex, (*border)[i + 1].vertex);
            }
        }
        count(own.front().vertex, other.front().vertex);
        count(own.back().vertex, other.back().vertex);
        for (const auto& [edge, number] : counts) {
            ASSERT_EQ(number % 2, 0) << round;
        }
    }
}

TEST_F(TileSeams, OfEqualBordersAreEmpty) {
    const Border border = random_border(chance_, 0.0, cells);
    EXPECT_TRUE(joined(border, border, {TileSide::east, 0.0, cells, {}}).empty());
}

TEST_F(TileSeams, FaceOutwardsOnEachSideWhereTheTileIsHigher) {
    const TileBorder border = border_of_samples(surface_);
    const std::array outwards{glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0),
                              glm::dvec3(-1, 0, 0)};
    for (int i = 0; i < 4; ++i) {
        const auto side = static_cast<TileSide>(i);
        ASSERT_EQ(border[static_cast<std::size_t>(i)].size(), cells + 1U);
        SeamMaker maker(surface_, border);
        maker.hang({side, 8.0, 40.5, {}}, {.metres = 6.0});
        double area = 0.0;
        const auto triangles = triangles_of(maker.take());
        for (const Corners& corners : triangles) {
            if (faces_both_ways(triangles, corners)) {
                continue;
            }
            const glm::dvec3 a = place_of(corners[0]);
            const glm::dvec3 normal =
                glm::cross(place_of(corners[1]) - a, place_of(corners[2]) - a);
            ASSERT_GE(glm::dot(normal, outwards[static_cast<std::size_t>(i)]), 0.0);
            area += 0.5 * glm::length(normal);
            for (const GridVertex& corner : corners) {
                const double depth = -place_of(corner).z;
                ASSERT_TRUE(depth == 0.0 || std::abs(depth - 6.0) < rounding) << depth;
            }
        }
        EXPECT_NEAR(area, 6.0 * 3.0 * 32.5, 1e-6);
    }
}

TEST_F(TileSeams, HangByTheErrorsOfTheirDistance) {
    const TileBorder border = border_of_samples(surface_);
    SeamMaker maker(surface_, border);
    const glm::dvec3 eye(0.0, -1000.0, 0.0); // south, at the height of the ground
    maker.hang({TileSide::south, 0.0, cells, {}}, {.metres = 1.0, .slope = 0.01, .eye = eye});
    int lower = 0;
    for (const Corners& corners : triangles_of(maker.take())) {
        for (const GridVertex& corner : corners) {
            glm::dvec3 place = place_of(corner);
            const double depth = -std::exchange(place.z, 0.0);
            if (depth > 1.0) {
                ++lower;
                ASSERT_NEAR(depth, 1.0 + 0.01 * glm::distance(place, eye), 1e-6);
            }
        }
    }
    EXPECT_GT(lower, cells);
}

TEST(TileBorders, AreTheVerticesOfTheTrianglesInOrder) {
    const auto heightfield = test::plane_heightfield(test::rough_hills(cells + 1, 41, 3));
    const auto placement =
        terrain::Placement::create(heightfield, terrain::PlacementKind::plane).value();
    const terrain::Bisection bisection(heightfield, placement);
    const TileSurface surface{heightfield, placement, {{0, 0}, {cells, 40}}};
    terrain::ErrorView view;
    view.perspective = false;
    const CutMesh mesh = cut_tile(view, surface, {&bisection, 0.0, 2.0, {}, nullptr}, {});
    const TileBorder border = border_of(surface, mesh);
    std::array<std::set<std::int64_t>, 4> expected;
    for (const terrain::Triangulation& part : mesh.parts) {
        for (const terrain::Steps place : part.vertices) {
            if (place.y == 0) {
                expected[0].insert(place.x);
            }
            if (place.x == terrain::steps_of({cells, 0}).x) {
                expected[1].insert(place.y);
            }
            if (place.y == terrain::steps_of({0, 40}).y) {
                expected[2].insert(place.x);
            }
            if (place.x == 0) {
                expected[3].insert(place.y);
            }
        }
    }
    for (std::size_t side = 0; side < 4; ++side) {
        std::vector<std::int64_t> found;
        for (const BorderVertex& vertex : border[side]) {
            found.push_back(static_cast<std::int64_t>(vertex.at * terrain::steps_per_sample));
        }
        EXPECT_GT(found.size(), 2U);
        EXPECT_EQ(found, std::vector(expected[side].begin(), expected[side].end()));
    }
}

} // namespace
} // namespace reljef::view
