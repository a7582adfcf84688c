#include "engine/building/roof.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/building/made_outline.h"

namespace reljef::building {
namespace {

Ring level(const RoofPart& part) {
    Ring ring;
    for (const glm::dvec3 corner : part.corners) {
        ring.emplace_back(corner);
    }
    return ring;
}

double covered(const std::vector<RoofPart>& parts) {
    double area = 0.0;
    for (const RoofPart& part : parts) {
        area += part.is_upright ? 0.0 : signed_area(level(part));
    }
    return area;
}

bool holds(const Ring& ring, glm::dvec2 place) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2 edge = ring[(i + 1) % ring.size()] - ring[i];
        const glm::dvec2 to = place - ring[i];
        if (edge.x * to.y - edge.y * to.x < 0.0) {
            return false;
        }
    }
    return true;
}

// z of the plane of a part.
double height_on(const RoofPart& part, glm::dvec2 place) {
    const glm::dvec3 a = part.corners[0];
    glm::dvec3 normal(0.0);
    for (std::size_t i = 1; i + 1 < part.corners.size(); ++i) {
        normal += glm::cross(part.corners[i] - a, part.corners[i + 1] - a);
    }
    const glm::dvec2 way = place - glm::dvec2(a);
    return a.z - (normal.x * way.x + normal.y * way.y) / normal.z;
}

// A point is on the lattice of micrometres: heights err by its step times the slope at most.
constexpr double lattice = 1e-5;

SlopedRoof roof_of(unsigned seed, std::size_t edges) {
    SlopedRoof roof;
    roof.slope = 0.3 + 0.1 * (seed % 20U);
    roof.max_rise = seed % 3U == 0 ? 2.0 : std::numeric_limits<double>::infinity();
    if (seed % 2U == 1) {
        roof.sloped.assign(edges, true);
        roof.sloped[seed % edges] = false; // a gable
    }
    return roof;
}

TEST(SlopedRoof, CoversItsOutlineOnceAtTheHeightOfTheNearestEdge) {
    for (unsigned seed = 0; seed < 300; ++seed) {
        const Ring outline = test::random_convex(seed);
        const SlopedRoof roof = roof_of(seed, outline.size());
        const auto parts = sloped_roof(outline, roof);
        EXPECT_NEAR(covered(parts), signed_area(outline), 1e-3) << seed;
        std::mt19937 random(seed);
        for (int i = 0; i < 20; ++i) {
            const glm::dvec2 place = test::random_place(outline, random);
            int found = 0;
            for (const RoofPart& part : parts) {
                if (holds(level(part), place)) {
                    ++found;
                    EXPECT_NEAR(height_on(part, place), rise_at(outline, roof, place), lattice)
                        << seed;
                }
            }
            EXPECT_LE(found, 2) << seed; // two where parts meet
            EXPECT_GE(found, 1) << seed;
        }
    }
}

TEST(SlopedRoof, HasItsEavesOnAllSlopedEdgesAndGablesOnOthers) {
    const Ring outline = test::rectangle_ring({0.0, 0.0}, {12.0, 8.0});
    const SlopedRoof gable{
        0.5, std::numeric_limits<double>::infinity(), {true, false, true, false}};
    const auto parts = sloped_roof(outline, gable);
    ASSERT_EQ(parts.size(), 2U);
    for (const RoofPart& part : parts) {
        for (const glm::dvec3 corner : part.corners) {
            EXPECT_DOUBLE_EQ(corner.z, corner.y == 4.0 ? 2.0 : 0.0);
        }
    }
    EXPECT_DOUBLE_EQ(largest_run(outline, gable), 4.0);
    EXPECT_DOUBLE_EQ(largest_run(outline, {}), 4.0);
}

TEST(SlopedRoof, EachOutlineEdgeLiesBelowPartsOfItsWholeLength) {
    for (unsigned seed = 0; seed < 100; ++seed) {
        const Ring outline = test::random_convex(seed);
        std::vector<double> lengths(outline.size(), 0.0);
        for (const RoofPart& part :
             divided(sloped_roof(outline, roof_of(seed, outline.size())), 2.0)) {
            for (std::size_t i = 0; i < part.corners.size(); ++i) {
                if (const auto edge = part.outline_edges[i]) {
                    const Ring ring = level(part);
                    const double length = glm::distance(ring[i], ring[(i + 1) % ring.size()]);
                    EXPECT_LE(length, 2.0 + lattice);
                    lengths[*edge] += length;
                }
            }
        }
        for (std::size_t i = 0; i < outline.size(); ++i) {
            EXPECT_NEAR(lengths[i], glm::distance(outline[i], outline[(i + 1) % outline.size()]),
                        lattice)
                << seed;
        }
    }
}

TEST(Parapet, SurroundsADeckAtItsOwnHeight) {
    for (unsigned seed = 0; seed < 100; ++seed) {
        const Ring outline = test::random_convex(seed);
        const auto parts = roof_with_parapet(outline, 0.35, 0.9);
        EXPECT_NEAR(covered(parts), signed_area(outline), 1e-3) << seed;
        std::mt19937 random(seed);
        for (int i = 0; i < 20; ++i) {
            const glm::dvec2 place = test::random_place(outline, random);
            const double inside = rise_at(outline, {1.0, 1e9, {}}, place);
            for (const RoofPart& part : parts) {
                if (!part.is_upright && std::abs(inside - 0.35) > lattice &&
                    holds(level(part), place)) {
                    EXPECT_EQ(part.corners[0].z, inside < 0.35 ? 0.9 : 0.0);
                }
            }
        }
    }
}

TEST(RoofWithAHole, LosesItsAreaAndNothingElse) {
    const Ring outline = test::rectangle_ring({0.0, 0.0}, {40.0, 30.0});
    const Ring hole = test::rectangle_ring({10.0, 10.0}, {25.0, 20.0});
    const auto parts = without(roof_with_parapet(outline, 0.5, 1.0), hole);
    EXPECT_NEAR(covered(parts), 40.0 * 30.0 - 15.0 * 10.0, 1e-9);
    for (const RoofPart& part : parts) {
        EXPECT_FALSE(!part.is_upright && holds(level(part), {15.0, 15.0}));
    }
    // No corner lies within an edge of another part.
    for (const RoofPart& part : parts) {
        for (std::size_t i = 0; i < part.corners.size(); ++i) {
            const glm::dvec3 a = part.corners[i];
            const glm::dvec3 b = part.corners[(i + 1) % part.corners.size()];
            for (const RoofPart& other : parts) {
                for (const glm::dvec3 corner : other.corners) {
                    const bool is_end = corner == a || corner == b;
                    const double detour =
                        glm::distance(a, corner) + glm::distance(corner, b) - glm::distance(a, b);
                    EXPECT_TRUE(is_end || detour > 1e-7);
                }
            }
        }
    }
}

} // namespace
} // namespace reljef::building
