#include "engine/material/cone_map.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/core/bilinear.h"
#include "tests/terrain/brute_force.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

using test::Chance;

// Heights in [0,1] are good to 2^-24, and the reckoning here adds a few such errors.
constexpr double height_rounding = 0x1p-20;

struct Surface {
    std::string name;
    Grid<float> heights;
};

float hill_at(int col, int row) {
    return static_cast<float>(0.5 + 0.3 * std::sin(0.5 * col + 0.4) * std::cos(0.4 * row) +
                              0.2 * std::sin(0.2 * col - 0.3 * row));
}

float houses_at(int col, int row) {
    return static_cast<float>((col / 4 + row / 5) % 3) * 0.5F;
}

std::vector<Surface> random_surfaces(unsigned seed) {
    Chance chance(seed);
    const int cols = chance.whole(2, 24);
    const int rows = chance.whole(2, 24);
    const auto made = [&](const auto& height) { return test::made_heights(cols, rows, height); };
    return {{"noise", test::random_heights(cols, rows, 0.0F, 1.0F, seed)},
            {"hills",
             made([&](int col, int row) { return hill_at(col + static_cast<int>(seed), row); })},
            {"blocks", made([&](int col, int row) { return houses_at(col, row); })},
            {"rough blocks", made([&](int col, int row) {
                 return 0.97 * houses_at(col, row) + chance.between(0.0, 0.03);
             })},
            {"few spikes",
             made([&](int, int) { return chance.one_in(40) ? chance.between(0.0, 1.0) : 0.0; })}};
}

// A point of the surface, now and then on a line between cells; and its cell.
struct Tip {
    glm::dvec3 place;
    glm::ivec2 cell;
};

Tip random_tip(Chance& chance, const Grid<float>& heights) {
    const glm::dvec2 at = chance.place(heights, 0.0);
    const glm::ivec2 last(heights.cols() - 2, heights.rows() - 2);
    // A place on a line belongs to both cells beside it.
    const glm::ivec2 cell = glm::clamp(
        glm::ivec2(glm::floor(at)) - glm::ivec2(at.x == std::floor(at.x) ? chance.whole(0, 1) : 0,
                                                at.y == std::floor(at.y) ? chance.whole(0, 1) : 0),
        glm::ivec2(0), last);
    return {glm::dvec3(at, bilinear_height(heights.view(), at)), cell};
}

// Now and then along an axis.
glm::dvec2 random_direction(Chance& chance) {
    if (chance.one_in(5)) {
        const int way = chance.whole(0, 3);
        return {way == 0 ? 1.0 : way == 1 ? -1.0 : 0.0, way == 2 ? 1.0 : way == 3 ? -1.0 : 0.0};
    }
    const double angle = chance.between(0.0, 2.0 * std::numbers::pi);
    return {std::cos(angle), std::sin(angle)};
}

// How deep the surface reaches into the cone along one of its sides.
double depth_inside(const Grid<float>& heights, const Tip& tip, glm::dvec2 direction,
                    double ratio) {
    const Ray side{tip.place, {direction, 1.0 / ratio}};
    const Interval range = test::over_grid(heights, side, {0.0, 1e3});
    double depth = 0.0;
    if (range.begin < range.end) {
        for (const double t : test::monotone_breaks(heights, side, range)) {
            depth = std::max(depth, -test::clearance(heights, side, t));
        }
    }
    return depth;
}

TEST(ConeMap, EveryPlainConeIsEmpty) {
    Chance chance(1);
    for (unsigned seed = 0; seed < 60; ++seed) {
        for (const Surface& surface : random_surfaces(seed)) {
            const auto cones =
                material::cone_map(surface.heights.view(), material::ConeKind::plain).value();
            for (int i = 0; i < 60; ++i) {
                const Tip tip = random_tip(chance, surface.heights);
                const double ratio = cones(tip.cell.x, tip.cell.y);
                ASSERT_GT(ratio, 0.0F);
                ASSERT_LE(depth_inside(surface.heights, tip, random_direction(chance), ratio),
                          height_rounding)
                    << surface.name << ' ' << seed;
            }
        }
    }
}

// How far a ray comes out again of the surface inside the cone.
double height_of_return(const Grid<float>& heights, const Tip& tip, glm::dvec2 direction,
                        double start, double fall, double ratio) {
    const Ray ray{{glm::dvec2(tip.place), start}, {direction, -fall}};
    const double leaves = ratio * (start - tip.place.z) / (1.0 + ratio * fall);
    const Interval range = test::over_grid(heights, ray, {0.0, leaves});
    bool under = false;
    double height = 0.0;
    if (range.begin < range.end) {
        for (const double t : test::monotone_breaks(heights, ray, range)) {
            const double above = test::clearance(heights, ray, t);
            under = under || above < -height_rounding;
            height = std::max(height, under ? above : 0.0);
        }
    }
    return height;
}

// Level rays through the surface's own heights are those that come out first.
double random_start(Chance& chance, const Grid<float>& heights, double tip) {
    if (chance.one_in(2)) {
        const double other =
            heights(chance.whole(0, heights.cols() - 1), chance.whole(0, heights.rows() - 1));
        return other - 1e-4 > tip ? other - 1e-4 : tip + 1e-4;
    }
    return tip + chance.between(0.0, 1.0 - tip);
}

TEST(ConeMap, InARelaxedConeARayThatDoesNotRiseMeetsTheSurfaceAtMostOnce) {
    Chance chance(2);
    for (unsigned seed = 0; seed < 60; ++seed) {
        for (const Surface& surface : random_surfaces(seed)) {
            const auto cones =
                material::cone_map(surface.heights.view(), material::ConeKind::relaxed).value();
            for (int i = 0; i < 60; ++i) {
                const Tip tip = random_tip(chance, surface.heights);
                const double ratio = cones(tip.cell.x, tip.cell.y);
                const double start = random_start(chance, surface.heights, tip.place.z);
                const double fall = chance.one_in(2) ? 0.0 : chance.between(0.0, 0.3);
                ASSERT_LE(height_of_return(surface.heights, tip, random_direction(chance), start,
                                           fall, ratio),
                          height_rounding)
                    << surface.name << ' ' << seed;
            }
        }
    }
}

TEST(ConeMap, ARelaxedConeIsNeverTheNarrowerOne) {
    for (unsigned seed = 0; seed < 30; ++seed) {
        for (const Surface& surface : random_surfaces(seed)) {
            const material::ConeMaps maps = material::cone_maps(surface.heights.view()).value();
            for (std::size_t i = 0; i < maps.plain.size(); ++i) {
                ASSERT_GE(maps.relaxed.samples()[i] * (1.0F + 0x1p-20F), maps.plain.samples()[i])
                    << surface.name;
            }
        }
    }
}

TEST(ConeMap, OverAPlaneItIsAsWideAsThePlaneLets) {
    const auto level = material::cone_maps(Grid<float>(9, 7, 0.3F).view()).value();
    EXPECT_NEAR(level.plain(4, 3), material::max_cone_ratio, 0.01);
    EXPECT_NEAR(level.relaxed(4, 3), material::max_cone_ratio, 0.01);
    const auto slope = test::made_heights(
        40, 40, [](int col, int row) { return (3.0 * col + 4.0 * row) / 512.0; });
    const auto cones = material::cone_maps(slope.view()).value();
    for (int i = 0; i < 39; ++i) {
        EXPECT_LE(cones.plain(i, 38 - i), 512.0F / 5.0F);
        EXPECT_GE(cones.plain(i, 38 - i), 0.75F * 512.0F / 5.0F); // both cells' extents
        EXPECT_GE(cones.relaxed(i, 38 - i), 3.5F * 512.0F / 5.0F);
    }
}

TEST(ConeMap, BesideAHouseThePlainConeEndsAtItsWallAndTheRelaxedOneBehindIt) {
    // Walls from column 20 to 21 and from 30 to 31.
    const auto heights =
        test::made_heights(60, 60, [](int col, int) { return col > 20 && col <= 30 ? 0.5 : 0.0; });
    const auto cones = material::cone_maps(heights.view()).value();
    for (int col = 2; col < 19; ++col) {
        const auto wall = static_cast<float>(20 - col);
        EXPECT_GE(cones.plain(col, 30), 0.99F * (wall - 1.0F) / 0.5F);
        EXPECT_LE(cones.plain(col, 30), (wall + 1.0F) / 0.5F);
        EXPECT_GE(cones.relaxed(col, 30), 0.99F * (wall + 9.0F) / 0.5F);
        EXPECT_LE(cones.relaxed(col, 30), (wall + 11.0F) / 0.5F);
    }
}

TEST(ConeMap, InterpolatedAndCodedItIsNowhereWider) {
    Chance chance(3);
    for (unsigned seed = 0; seed < 40; ++seed) {
        for (const Surface& surface : random_surfaces(seed)) {
            const auto cells =
                material::cone_map(surface.heights.view(), material::ConeKind::plain).value();
            const Grid<float> samples = material::cones_at_samples(cells);
            ASSERT_EQ(samples.cols(), surface.heights.cols());
            for (const int highest : {255, 65535}) {
                const auto codes = material::cone_codes(samples, material::max_cone_ratio, highest);
                for (int i = 0; i < 50; ++i) {
                    const Tip tip = random_tip(chance, surface.heights);
                    const float cell = cells(tip.cell.x, tip.cell.y) * (1.0F + 0x1p-20F);
                    const auto value = [](auto v) { return static_cast<float>(v); };
                    const glm::dvec2 place(tip.place);
                    ASSERT_LE(bilinear(samples, place, value), cell);
                    const float code = bilinear(codes, place, value);
                    ASSERT_LE(material::cone_of_code(code, material::max_cone_ratio, highest),
                              cell);
                }
            }
        }
    }
}

TEST(ConeMap, ACodeIsTheNextOneBelow) {
    Chance chance(4);
    Grid<float> ratio(1, 1);
    for (int i = 0; i < 2000; ++i) {
        ratio(0, 0) = static_cast<float>(std::pow(10.0, chance.between(-3.0, 3.0)));
        for (const int highest : {255, 65535}) {
            const int code = material::cone_codes(ratio, material::max_cone_ratio, highest)(0, 0);
            EXPECT_LE(
                material::cone_of_code(static_cast<float>(code), material::max_cone_ratio, highest),
                ratio(0, 0));
            EXPECT_GE(material::cone_of_code(static_cast<float>(code + 1), material::max_cone_ratio,
                                             highest),
                      ratio(0, 0) * (1.0F - 0x1p-20F));
        }
    }
}

// A march as the shader's: to where the ray leaves the cone it is in, as long as it is above.
struct March {
    double above = 0.0;  // the last place on the way that is above the surface
    double end = 0.0;    // the next, or the last
    double height = 0.0; // of that over the surface
};

March marched(const Grid<float>& heights, const Grid<float>& cones, const Ray& ray,
              Interval range) {
    const double run = glm::length(glm::dvec2(ray.direction));
    const glm::ivec2 last(cones.cols() - 1, cones.rows() - 1);
    March march{range.begin, range.begin, test::clearance(heights, ray, range.begin)};
    for (int i = 0; i < 400 && march.height > 1e-9 && march.end < range.end; ++i) {
        const glm::dvec3 at = ray.at(march.end);
        const glm::ivec2 cell = glm::clamp(glm::ivec2(at), glm::ivec2(0), last);
        const double ratio = cones(cell.x, cell.y);
        const double opens = run - ratio * ray.direction.z;
        const double step = opens > 0.0 ? ratio * march.height / opens : range.end - range.begin;
        march.above = march.end;
        march.end = std::min(march.end + step, range.end);
        march.height = test::clearance(heights, ray, march.end);
    }
    return march;
}

Ray random_ray(Chance& chance, const Grid<float>& heights) {
    const glm::dvec2 from = chance.place(heights, 0.0);
    const double height = bilinear_height(heights.view(), from) + 0.001 + chance.between(0.0, 1.0);
    return {{from, height}, {random_direction(chance), chance.between(-0.4, 0.1)}};
}

// Whether a relaxed march ended below the surface; then the first hit lies before its end.
bool expect_right_marches(const Grid<float>& heights, const material::ConeMaps& maps,
                          const Ray& ray) {
    const Interval range = test::over_grid(heights, ray, {0.0, 100.0});
    if (!(range.begin < range.end)) {
        return false;
    }
    const auto hit = test::brute_force(heights, ray, range);
    const double last = hit.value_or(range.end) + 1e-3; // a graze may end a little behind it
    const March plain = marched(heights, maps.plain, ray, range);
    EXPECT_GE(plain.height, -height_rounding);
    EXPECT_LE(plain.end, last);
    const bool falls = ray.direction.z <= 0.0;
    const March relaxed = marched(heights, falls ? maps.relaxed : maps.plain, ray, range);
    EXPECT_LE(relaxed.above, last);
    const bool below = hit && relaxed.height < -height_rounding;
    EXPECT_TRUE(!below || relaxed.end >= *hit);
    return below;
}

TEST(ConeMap, APlainMarchNeverGoesBelowTheSurfaceAndARelaxedOneOnlyBehindTheFirstHit) {
    Chance chance(5);
    int hits = 0;
    for (unsigned seed = 0; seed < 40; ++seed) {
        for (const Surface& surface : random_surfaces(seed)) {
            SCOPED_TRACE(surface.name);
            const material::ConeMaps maps = material::cone_maps(surface.heights.view()).value();
            for (int i = 0; i < 60; ++i) {
                const Ray ray = random_ray(chance, surface.heights);
                hits += expect_right_marches(surface.heights, maps, ray) ? 1 : 0;
            }
        }
    }
    EXPECT_GT(hits, 100);
}

TEST(ConeMap, TellsHowFarItIsAndStops) {
    const Grid<float> heights = test::random_heights(64, 64, 0.0F, 1.0F, 1);
    std::vector<double> told;
    ParallelOptions options;
    options.progress = [&](double fraction) { told.push_back(fraction); };
    ASSERT_TRUE(material::cone_maps(heights.view(), options));
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_EQ(told.back(), 1.0);
    std::stop_source source;
    options.stop = source.get_token();
    options.progress = [&](double) { source.request_stop(); };
    EXPECT_FALSE(material::cone_maps(heights.view(), options));
}

// The last rows may be incomplete then, and no later row notices the stop.
TEST(ConeMap, AStopDuringTheLastRowsGivesNoMap) {
    const Grid<float> heights = test::random_heights(17, 9, 0.0F, 1.0F, 1);
    std::stop_source source;
    const ParallelOptions options{1, source.get_token(), [&](double) { source.request_stop(); }};
    EXPECT_FALSE(material::cone_map(heights.view(), material::ConeKind::relaxed, options));
}

TEST(ConeMapDeathTest, NeedsACell) {
    EXPECT_DEATH(
        static_cast<void>(material::cone_map(Grid<float>(1, 5).view(), material::ConeKind::plain)),
        "at least 2x2");
}

} // namespace
} // namespace reljef::terrain
