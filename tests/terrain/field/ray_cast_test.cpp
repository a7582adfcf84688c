#include "engine/terrain/field/surface_caster.h"

#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/release_only.h"
#include "tests/terrain/brute_force.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::optional<SurfaceHit> cast(const Grid<float>& heights, const Ray& ray,
                               Interval range = {0.0, 1e6}) {
    return first_hit(heights.view(), MinMaxPyramid(heights.view()), ray, range);
}

void expect_as_brute_force(const Grid<float>& heights, const MinMaxPyramid& pyramid, const Ray& ray,
                           Interval range = {0.0, 1e6}) {
    const auto hit = first_hit(heights.view(), pyramid, ray, range);
    const auto expected = test::brute_force(heights, ray, range);
    ASSERT_EQ(hit.has_value(), expected.has_value())
        << "from " << ray.origin.x << ' ' << ray.origin.y << ' ' << ray.origin.z << " along "
        << ray.direction.x << ' ' << ray.direction.y << ' ' << ray.direction.z << " hit "
        << (hit ? hit->t : -1.0) << " expected " << expected.value_or(-1.0);
    if (hit) {
        const double width = heights.cols() + heights.rows();
        const double distance = std::abs(hit->t - *expected) * glm::length(ray.direction);
        ASSERT_LE(distance, 1e-9 * width);
        ASSERT_NEAR(hit->sample.z, bilinear_height(heights.view(), glm::dvec2(hit->sample)),
                    1e-9 * width);
    }
}

TEST(RayCast, MeetsAPlaneWhereGeometrySays) {
    const Grid<float> heights = test::made_heights(33, 17, [](int, int) { return 7.0; });
    const auto hit = cast(heights, {{1.25, 2.5, 17.0}, {2.0, 1.0, -1.0}});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, 10.0, 1e-13);
    EXPECT_NEAR(glm::distance(hit->sample, glm::dvec3(21.25, 12.5, 7.0)), 0.0, 1e-13);
}

TEST(RayCast, MeetsARampWhereGeometrySays) {
    test::Chance chance(1);
    const Grid<float> heights =
        test::made_heights(65, 40, [](int col, int row) { return 0.5 * col - 0.25 * row + 3.0; });
    const MinMaxPyramid pyramid(heights.view());
    const glm::dvec3 normal(-0.5, 0.25, 1.0);
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec2 target = chance.place(heights, 0.0);
        const glm::dvec3 on_ramp(target, 0.5 * target.x - 0.25 * target.y + 3.0);
        const glm::dvec3 direction(chance.between(-3.0, 3.0), chance.between(-3.0, 3.0), -5.0);
        const double t = chance.between(0.1, 30.0);
        const bool inside = target.x > 0.0 && target.y > 0.0 && target.x < 64.0 && target.y < 39.0;
        if (glm::dot(direction, normal) < 0.0 && inside) {
            const auto hit = first_hit(heights.view(), pyramid,
                                       {on_ramp - t * direction, direction}, {0.0, 1e6});
            ASSERT_TRUE(hit);
            ASSERT_NEAR(hit->t, t, 1e-11);
        }
    }
}

// On a grid the paraboloid x²+y² becomes, in each cell, the bilinear patch of its corners; at
// vertices both agree.
TEST(RayCast, MeetsASampledParaboloidAtItsVertices) {
    const Grid<float> heights = test::made_heights(41, 41, [](int col, int row) {
        return 0.5 * ((col - 20) * (col - 20) + (row - 20) * (row - 20));
    });
    const MinMaxPyramid pyramid(heights.view());
    for (int row = 1; row < 40; ++row) {
        for (int col = 1; col < 40; ++col) {
            const glm::dvec3 target(col, row, heights(col, row));
            const glm::dvec3 eye(20.0, 20.0, 2000.0);
            const auto hit = first_hit(heights.view(), pyramid, {eye, target - eye}, {0.0, 2.0});
            ASSERT_TRUE(hit) << col << ' ' << row;
            ASSERT_LE(glm::distance(hit->sample, target), 1e-9 * 41);
        }
    }
}

TEST(RayCast, MeetsATwistedPatchWhereTheQuadraticSays) {
    Grid<float> heights(2, 2, 0.0F);
    heights(1, 1) = 1.0F; // z = u·v
    // Along the diagonal u = v = t, falling from 1 by t: t² = 1 − t.
    const auto hit = cast(heights, {{0.0, 0.0, 1.0}, {1.0, 1.0, -1.0}});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, 0.5 * (std::sqrt(5.0) - 1.0), 1e-15);
}

TEST(RayCast, AgreesWithBruteForceOnRandomFields) {
    test::Chance chance(2);
    for (unsigned field = 0; field < 12; ++field) {
        const Grid<float> heights =
            test::random_heights(chance.whole(2, 40), chance.whole(2, 40), -3.0F, 3.0F, field);
        const MinMaxPyramid pyramid(heights.view());
        for (int i = 0; i < 1500; ++i) {
            const glm::dvec3 from(chance.place(heights, 6.0), chance.between(-4.0, 6.0));
            const glm::dvec3 to(chance.place(heights, 6.0), chance.between(-6.0, 4.0));
            expect_as_brute_force(heights, pyramid, {from, to - from},
                                  {0.0, chance.between(0.5, 3.0)});
            if (HasFatalFailure()) {
                return;
            }
        }
    }
}

TEST(RayCast, AgreesWithBruteForceAlongTheAxes) {
    test::Chance chance(3);
    const Grid<float> heights = test::random_heights(31, 23, -2.0F, 2.0F, 11);
    const MinMaxPyramid pyramid(heights.view());
    for (int i = 0; i < 6000; ++i) {
        glm::dvec3 from(chance.place(heights, 3.0), chance.between(-3.0, 3.0));
        glm::dvec3 direction(0.0, 0.0, chance.one_in(2) ? 0.0 : chance.between(-0.3, 0.3));
        direction[chance.whole(0, 1)] = chance.one_in(2) ? 1.0 : -1.0;
        expect_as_brute_force(heights, pyramid, {from, direction});
        if (HasFatalFailure()) {
            return;
        }
    }
}

// Along the diagonal through vertices, and along the lines between cells.
TEST(RayCast, AgreesWithBruteForceThroughVerticesAndAlongCellBorders) {
    test::Chance chance(4);
    const Grid<float> heights = test::random_heights(24, 33, -2.0F, 2.0F, 12);
    const MinMaxPyramid pyramid(heights.view());
    for (int i = 0; i < 8000; ++i) {
        const glm::dvec3 from(chance.whole(-2, 25), chance.whole(-2, 34), chance.between(0.0, 3.0));
        const glm::dvec3 direction(chance.whole(-2, 2), chance.whole(-2, 2),
                                   chance.between(-0.5, 0.1));
        expect_as_brute_force(heights, pyramid, {from, direction});
        if (HasFatalFailure()) {
            return;
        }
    }
}

TEST(RayCast, AVerticalRayMeetsTheBilinearHeight) {
    test::Chance chance(5);
    const Grid<float> heights = test::random_heights(20, 30, -2.0F, 2.0F, 13);
    const MinMaxPyramid pyramid(heights.view());
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec2 at = chance.place(heights, 1.0);
        const bool inside = at.x >= 0.0 && at.y >= 0.0 && at.x <= 19.0 && at.y <= 29.0;
        const auto hit =
            first_hit(heights.view(), pyramid, {{at, 5.0}, {0.0, 0.0, -2.0}}, {0.0, 100.0});
        ASSERT_EQ(hit.has_value(), inside) << at.x << ' ' << at.y;
        if (hit) {
            ASSERT_NEAR(hit->sample.z, bilinear_height(heights.view(), at), 1e-13);
        }
        const auto upward =
            first_hit(heights.view(), pyramid, {{at, -5.0}, {0.0, 0.0, 2.0}}, {0.0, 100.0});
        ASSERT_FALSE(upward) << "a back face is no hit";
    }
}

TEST(RayCast, ARayWithoutLengthMeetsNothing) {
    const Grid<float> heights = test::random_heights(9, 9, 0.0F, 1.0F, 14);
    for (const double z : {-1.0, 0.5, 2.0}) {
        EXPECT_FALSE(cast(heights, {{4.0, 4.0, z}, {0.0, 0.0, 0.0}}));
        EXPECT_FALSE(cast(heights, {{4.3, 4.7, z}, {1.0, 1.0, -1.0}}, {0.0, 0.0}));
        EXPECT_FALSE(cast(heights, {{4.3, 4.7, z}, {1.0, 1.0, -1.0}}, {1.0, 0.0}));
    }
}

TEST(RayCast, GoesOnToTheNextFrontFaceWhenItStartsBelow) {
    // A ridge along col 4 and one along col 8, each 10 high.
    const Grid<float> heights =
        test::made_heights(13, 5, [](int col, int) { return col == 4 || col == 8 ? 10.0 : 0.0; });
    const auto inside = cast(heights, {{3.75, 2.0, 5.0}, {1.0, 0.0, 0.0}});
    ASSERT_TRUE(inside);
    EXPECT_NEAR(inside->sample.x, 7.5, 1e-12);
    const auto under_the_border = cast(heights, {{-5.0, 2.0, -1.0}, {1.0, 0.0, 1.0 / 12.0}});
    EXPECT_FALSE(under_the_border) << "it leaves the ground and meets no front face";
    const auto through_the_border = cast(heights, {{-5.0, 2.0, -1.0}, {1.0, 0.0, 1.0 / 7.0}});
    ASSERT_TRUE(through_the_border) << "out of the ground at col 2, into the ridge after";
    EXPECT_GT(through_the_border->sample.x, 3.0);
    EXPECT_LT(through_the_border->sample.x, 4.0);
}

TEST(RayCast, AGrazingRayOverAFlatFieldMeetsIt) {
    const Grid<float> heights(1025, 3, 0.0F);
    const MinMaxPyramid pyramid(heights.view());
    for (const double slope : {1e-2, 1e-4, 1e-6, 1e-9}) {
        const double height = 1000.5 * slope;
        const auto hit = first_hit(heights.view(), pyramid,
                                   {{0.0, 1.5, height}, {1.0, 0.0, -slope}}, {0.0, 2000.0});
        ASSERT_TRUE(hit) << slope;
        EXPECT_NEAR(hit->t, 1000.5, 1e-6) << slope;
    }
    EXPECT_FALSE(
        first_hit(heights.view(), pyramid, {{0.0, 1.5, 0.0}, {1.0, 0.0, 0.0}}, {0.0, 2000.0}))
        << "along the surface is not through it";
}

TEST(RayCast, TouchingASummitIsNoHit) {
    const Grid<float> heights =
        test::made_heights(9, 9, [](int col, int row) { return col == 4 && row == 4 ? 1.0 : 0.0; });
    EXPECT_FALSE(cast(heights, {{0.0, 4.0, 1.0}, {1.0, 0.0, 0.0}}));
    EXPECT_TRUE(cast(heights, {{0.0, 4.0, 1.0 - 1e-12}, {1.0, 0.0, 0.0}}));
}

TEST(RayCast, IsWatertight) {
    test::Chance chance(6);
    for (const float offset : {0.0F, 8000.0F}) {
        const Grid<float> heights = test::random_heights(37, 53, offset - 2.0F, offset + 2.0F, 15);
        const MinMaxPyramid pyramid(heights.view());
        for (int i = 0; i < 100000; ++i) {
            const glm::dvec3 from(chance.place(heights, 0.0), offset + chance.between(2.0, 9.0));
            const glm::dvec3 to(chance.place(heights, 0.0), offset - chance.between(2.0, 9.0));
            const auto hit = first_hit(heights.view(), pyramid, {from, to - from}, {0.0, 1.0});
            ASSERT_TRUE(hit) << "ray " << i << " from " << from.x << ' ' << from.y << ' ' << from.z
                             << " to " << to.x << ' ' << to.y << ' ' << to.z;
            ASSERT_NEAR(hit->sample.z, bilinear_height(heights.view(), glm::dvec2(hit->sample)),
                        1e-9 * 53);
        }
    }
}

// Vertical walls of 10 km between samples a metre apart: nothing slips through between two cells.
TEST(RayCast, IsWatertightOnACheckerboardOfCliffs) {
    test::Chance chance(7);
    const Grid<float> heights = test::made_heights(
        30, 30, [](int col, int row) { return (col + row) % 2 == 0 ? 1e4 : 0.0; });
    const MinMaxPyramid pyramid(heights.view());
    for (int i = 0; i < 100000; ++i) {
        const glm::dvec3 from(chance.place(heights, 0.0), 1.5e4);
        const glm::dvec3 to(chance.place(heights, 0.0), -10.0);
        ASSERT_TRUE(first_hit(heights.view(), pyramid, {from, to - from}, {0.0, 1.0})) << i;
    }
}

TEST(RayCast, IsTheSameInMirrorAndTransposed) {
    test::Chance chance(8);
    const Grid<float> heights = test::random_heights(19, 27, -2.0F, 2.0F, 16);
    const Grid<float> mirrored =
        test::made_heights(19, 27, [&](int col, int row) { return heights(18 - col, row); });
    const Grid<float> transposed =
        test::made_heights(27, 19, [&](int col, int row) { return heights(row, col); });
    const auto agree = [](const auto& a, const auto& b) {
        ASSERT_EQ(a.has_value(), b.has_value());
        if (a) {
            ASSERT_NEAR(a->t, b->t, 1e-11);
        }
    };
    for (int i = 0; i < 10000; ++i) {
        const glm::dvec3 o(chance.place(heights, 4.0), chance.between(-1.0, 5.0));
        const glm::dvec3 d = glm::dvec3(chance.place(heights, 4.0), chance.between(-4.0, 1.0)) - o;
        const auto hit = cast(heights, {o, d}, {0.0, 2.0});
        agree(hit, cast(mirrored, {{18.0 - o.x, o.y, o.z}, {-d.x, d.y, d.z}}, {0.0, 2.0}));
        agree(hit, cast(transposed, {{o.y, o.x, o.z}, {d.y, d.x, d.z}}, {0.0, 2.0}));
        if (HasFatalFailure()) {
            return;
        }
    }
}

TEST(RayCast, NeitherHangsNorHitsWithRaysThatAreNoNumbers) {
    const Grid<float> heights = test::random_heights(9, 9, 0.0F, 1.0F, 17);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(cast(heights, {{nan, nan, nan}, {1.0, 1.0, -1.0}}));
    EXPECT_FALSE(cast(heights, {{1.0, 1.0, 5.0}, {nan, 1.0, -1.0}}));
    EXPECT_FALSE(cast(heights, {{1.0, 1.0, 5.0}, {infinity, 1.0, -1.0}}));
}

TEST(Pick, OnAPlaneIsTheRayInSampleCoordinates) {
    test::Chance chance(9);
    const Heightfield heightfield =
        test::plane_heightfield(test::random_heights(31, 41, -20.0F, 20.0F, 18), {3.0, 5.0});
    const Placement placement = test::placed(heightfield, 2.0);
    const MinMaxPyramid pyramid(heightfield.heights.view());
    int hits = 0;
    for (int i = 0; i < 3000; ++i) {
        const glm::dvec3 from(chance.between(-70.0, 70.0), chance.between(-120.0, 120.0),
                              chance.between(0.0, 200.0));
        const glm::dvec3 to(chance.between(-45.0, 45.0), chance.between(-100.0, 100.0),
                            chance.between(-100.0, 20.0));
        const Ray ray{from, to - from};
        const auto hit = pick(heightfield.heights.view(), pyramid, placement, ray);
        const Ray sample_ray{*placement.sample_from_world(from),
                             *placement.sample_from_world(to) - *placement.sample_from_world(from)};
        const auto expected = test::brute_force(heightfield.heights, sample_ray, {0.0, 1e4});
        ASSERT_EQ(hit.has_value(), expected.has_value());
        if (hit) {
            ++hits;
            ASSERT_NEAR(hit->t, *expected, 1e-9);
            ASSERT_LE(glm::distance(placement.world_from_sample(hit->sample), ray.at(hit->t)),
                      1e-8);
        }
    }
    EXPECT_GT(hits, 500);
}

// Clearance of a world ray over the placed surface, metres of height; nothing outside.
std::optional<double> placed_clearance(const Heightfield& heightfield, const Placement& placement,
                                       const Ray& ray, double t) {
    const auto sample = placement.sample_from_world(ray.at(t));
    const Grid<float>& heights = heightfield.heights;
    if (!sample || sample->x < 0.0 || sample->y < 0.0 || sample->x > heights.cols() - 1 ||
        sample->y > heights.rows() - 1) {
        return std::nullopt;
    }
    return sample->z - bilinear_height(heights.view(), glm::dvec2(*sample));
}

TEST(Pick, OnAnEllipsoidAgreesWithFineSteps) {
    test::Chance chance(10);
    // 80 km of hills 1,500 m high, 0.01° a sample.
    const Heightfield heightfield =
        test::geographic_heightfield(test::made_heights(101, 81,
                                                        [](int col, int row) {
                                                            return 1500.0 * std::sin(0.3 * col) *
                                                                   std::sin(0.2 * row + 0.1 * col);
                                                        }),
                                     46.0, 7.0, 0.01);
    const Placement placement = test::placed(heightfield);
    const MinMaxPyramid pyramid(heightfield.heights.view());
    int hits = 0;
    for (int i = 0; i < 120; ++i) {
        const glm::dvec3 from(chance.between(-6e4, 6e4), chance.between(-6e4, 6e4),
                              chance.between(1500.0, 9000.0));
        const glm::dvec3 to(chance.between(-3e4, 3e4), chance.between(-3e4, 3e4),
                            chance.between(-3000.0, 0.0));
        const Ray ray{from, glm::normalize(to - from)};
        const auto hit = pick(heightfield.heights.view(), pyramid, placement, ray);
        // The first stretch of 50 m that begins above and ends below.
        double before = -1.0;
        double expected = infinity;
        for (double t = 0.0; t < 2e5 && expected == infinity; t += 50.0) {
            const double at = placed_clearance(heightfield, placement, ray, t).value_or(-1.0);
            expected = before > 0.0 && at < 0.0 &&
                               placed_clearance(heightfield, placement, ray, t).has_value()
                           ? t
                           : expected;
            before = at;
        }
        ASSERT_EQ(hit.has_value(), expected < infinity) << i;
        if (hit) {
            ++hits;
            ASSERT_LT(hit->t, expected + 0.1);
            ASSERT_GT(hit->t, expected - 50.1);
            ASSERT_NEAR(placed_clearance(heightfield, placement, ray, hit->t).value_or(infinity),
                        0.0, 0.01);
        }
    }
    EXPECT_GT(hits, 60);
}

// Pieces of a bent ray meet: what crosses the surface at such a joint is seen too.
TEST(Pick, IsWatertightOnAnEllipsoid) {
    test::Chance chance(11);
    const Heightfield heightfield = test::geographic_heightfield(
        test::random_heights(65, 65, 0.0F, 500.0F, 19), 60.0, 20.0, 0.01);
    const Placement placement = test::placed(heightfield);
    const MinMaxPyramid pyramid(heightfield.heights.view());
    const SurfaceCaster caster(heightfield.heights.view(), pyramid, placement);
    for (int i = 0; i < test::rounds(3000, 500); ++i) {
        const glm::dvec3 from = placement.world_from_sample(
            {chance.between(1.0, 63.0), chance.between(1.0, 63.0), chance.between(501.0, 4000.0)});
        const glm::dvec3 to = placement.world_from_sample(
            {chance.between(1.0, 63.0), chance.between(1.0, 63.0), chance.between(-2000.0, -1.0)});
        ASSERT_TRUE(caster.first_hit({from, to - from})) << i;
    }
}

// The middle of a symmetric ray is where its first two pieces meet.
TEST(Pick, SeesACrossingAtTheJointOfTwoPieces) {
    const Heightfield heightfield =
        test::geographic_heightfield(Grid<float>(129, 129, 100.0F), 46.5, 7.0, 0.01);
    const Placement placement = test::placed(heightfield);
    const MinMaxPyramid pyramid(heightfield.heights.view());
    const SurfaceCaster caster(heightfield.heights.view(), pyramid, placement);
    test::Chance chance(12);
    for (int i = 0; i < test::rounds(3000, 500); ++i) {
        // Steep short rays; whatever the joints' places, the ground is in between.
        const glm::dvec3 ground = placement.world_from_sample(
            {chance.between(10.0, 118.0), chance.between(10.0, 118.0), 100.0});
        const glm::dvec3 up = placement.up(ground);
        const glm::dvec3 lean(chance.between(-1.0, 1.0), chance.between(-1.0, 1.0), 0.0);
        const Ray ray{ground + 900.0 * (up + lean), -(up + lean)};
        const auto hit = caster.first_hit(ray);
        ASSERT_TRUE(hit) << i;
        ASSERT_NEAR(hit->t, 900.0, 0.05);
    }
}

// A globe and its rays, turned by half of a turn: rays over the middle then pass the seam.
TEST(Pick, SeesTheSameGroundAcrossTheSeamOfAGlobe) {
    const Heightfield globe = test::closed_globe(60, 0.5, 0.5, 23);
    const int around = test::cells_of(globe).x;
    const int half = around / 2;
    Heightfield turned = globe;
    turned.heights = test::made_heights(around + 1, globe.heights.rows(), [&](int col, int row) {
        return static_cast<double>(globe.heights((col + half) % around, row));
    });
    const MinMaxPyramid pyramid(globe.heights.view());
    const MinMaxPyramid turned_pyramid(turned.heights.view());
    const Placement placement = test::placed(globe);
    const SurfaceCaster caster(globe.heights.view(), pyramid, placement);
    const SurfaceCaster across_seam(turned.heights.view(), turned_pyramid, placement);
    // A tile of the turned globe that ends at its seam.
    const geo::WrappedRows rows = globe.georeference->geodetic.rows();
    const TileLattice lattice{{around - 40, 10}, {around, 50}, 1.0, {40, 40}, rows};
    const GridView<const float> tile_heights =
        turned.heights.view().window(around - 40, 10, 41, 41);
    const MinMaxPyramid tile_pyramid(tile_heights);
    const Placement of_tile = placement.of_tile({1, rows, rows}, lattice);
    const SurfaceCaster beside_seam(tile_heights, tile_pyramid, of_tile);
    test::Chance chance(29);
    const auto place = [&](double low, double high) {
        return glm::dvec3(half + chance.between(-4.0, 4.0), chance.between(5.0, 55.0),
                          chance.between(low, high));
    };
    const auto other_side = [&](glm::dvec3 sample) {
        sample.x += sample.x < half ? half : -half;
        return sample;
    };
    int hits = 0;
    for (int i = 0; i < test::rounds(3000, 500); ++i) {
        const glm::dvec3 from = place(9001.0, 40e3);
        glm::dvec3 to = place(-9000.0, 9000.0);
        to.y = from.y + chance.between(-3.0, 3.0);
        const auto hit_between = [&](const SurfaceCaster& surface, glm::dvec3 a, glm::dvec3 b) {
            const glm::dvec3 eye = placement.world_from_sample(a);
            return surface.first_hit({eye, glm::normalize(placement.world_from_sample(b) - eye)});
        };
        const auto expected = hit_between(caster, from, to);
        const auto hit = hit_between(across_seam, other_side(from), other_side(to));
        ASSERT_EQ(hit.has_value(), expected.has_value()) << i;
        if (hit) {
            ++hits;
            ASSERT_NEAR(hit->t, expected->t, 1.0) << i;
            ASSERT_NEAR(hit->sample.y, expected->sample.y, 1e-3) << i;
            const auto hit_of_tile = hit_between(beside_seam, other_side(from), other_side(to));
            const glm::dvec2 in_tile = glm::dvec2(hit->sample) - lattice.first;
            const bool is_on_tile = in_tile.x > 0.0 && in_tile.y > 0.0 && in_tile.y < 40.0;
            ASSERT_TRUE(hit_of_tile || !is_on_tile) << i;
            ASSERT_GT(hit_of_tile ? hit_of_tile->t : hit->t, hit->t - 1.0) << i;
        }
    }
    EXPECT_GT(hits, test::rounds(3000, 500) / 2);
}

TEST(Pick, EndsWhereverTheRayComesFrom) {
    test::Chance chance(13);
    std::vector<Heightfield> fields;
    fields.push_back(test::geographic_heightfield(Grid<float>(101, 81, 0.0F), 46.0, 7.0, 0.01));
    fields.push_back(test::geographic_heightfield(Grid<float>(361, 161, 0.0F), 80.0, -180.0, 1.0));
    fields.push_back(test::geographic_heightfield(Grid<float>(41, 41, 0.0F), 89.5, 0.0, 0.5));
    for (const Heightfield& heightfield : fields) {
        const Placement placement = test::placed(heightfield);
        const MinMaxPyramid pyramid(heightfield.heights.view());
        for (int i = 0; i < 30; ++i) {
            const glm::dvec3 from(chance.between(-1e7, 1e7), chance.between(-1e7, 1e7),
                                  chance.between(-1.3e7, 1e7));
            const glm::dvec3 to(chance.between(-1e6, 1e6), chance.between(-1e6, 1e6),
                                chance.between(-1e6, 1e6));
            const auto hit =
                pick(heightfield.heights.view(), pyramid, placement, {from, to - from});
            ASSERT_TRUE(!hit || std::isfinite(hit->t));
        }
    }
}

} // namespace
} // namespace reljef::terrain
