#include "engine/terrain/light/sun_visibility.h"

#include <cmath>
#include <random>

#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

glm::dvec3 sun_at(double azimuth, double altitude) {
    const double a = glm::radians(azimuth);
    const double h = glm::radians(altitude);
    return {std::sin(a) * std::cos(h), std::cos(a) * std::cos(h), std::sin(h)};
}

int darkest(const Grid<std::uint8_t>& visibility) {
    return *std::min_element(visibility.samples().begin(), visibility.samples().end());
}

TEST(SunVisibility, LevelGroundIsFullyLit) {
    const Grid<float> heights(40, 50, 123.0F);
    for (double azimuth = 0.0; azimuth < 360.0; azimuth += 15.0) {
        for (const double altitude : {0.6, 1.0, 5.0, 45.0, 89.0, 90.0}) {
            EXPECT_EQ(darkest(sun_visibility(heights.view(), {10.0, 7.0}, 1.0,
                                             sun_at(azimuth, altitude))),
                      255)
                << azimuth << ' ' << altitude;
        }
    }
}

TEST(SunVisibility, NothingIsLitWithTheSunDown) {
    const Grid<float> heights(5, 5, 0.0F);
    for (const glm::dvec3 sun : {sun_at(90.0, 0.0), sun_at(10.0, -5.0), glm::dvec3(0.0, 0.0, -1.0),
                                 glm::dvec3(0.0), glm::dvec3(std::nan(""))}) {
        const auto visible =
            sun_visibility(heights.view(), {1.0, 1.0}, 1.0, {sun.x, sun.y, std::min(sun.z, 0.0)});
        for (const std::uint8_t share : visible.samples()) {
            EXPECT_EQ(share, 0);
        }
    }
}

TEST(SunVisibility, TheZenithThrowsNoShadow) {
    const Grid<float> heights = test::random_heights(30, 30, 0.0F, 1000.0F, 1);
    EXPECT_EQ(darkest(sun_visibility(heights.view(), {1.0, 1.0}, 1.0, {0.0, 0.0, 1.0})), 255);
}

// A wall from border to border; samples in shadow behind it, along the line across its middle.
int shadowed_samples(bool wall_along_row, glm::dvec2 spacing, double azimuth, double altitude,
                     double exaggeration) {
    constexpr int side = 241;
    constexpr int wall = 120;
    constexpr double height = 20.0;
    const Grid<float> heights = test::made_heights(side, side, [&](int col, int row) {
        return (wall_along_row ? row : col) == wall ? height : 0.0;
    });
    const auto visible =
        sun_visibility(heights.view(), spacing, exaggeration, sun_at(azimuth, altitude));
    int count = 0;
    for (int i = 0; i < side; ++i) {
        count += (wall_along_row ? visible(side / 2, i) : visible(i, side / 2)) < 128 ? 1 : 0;
    }
    return count;
}

TEST(SunVisibility, AWallsShadowIsAsLongAsGeometrySays) {
    for (const double altitude : {10.0, 25.0, 45.0, 60.0}) {
        const double length = 2.0 * 20.0 / std::tan(glm::radians(altitude)); // exaggeration 2
        for (const double azimuth : {0.0, 20.0, 45.0, 60.0, 135.0, 180.0, 200.0, 330.0}) {
            const double across = length * std::abs(std::cos(glm::radians(azimuth))) / 3.0;
            EXPECT_NEAR(shadowed_samples(true, {2.0, 3.0}, azimuth, altitude, 2.0), across, 2.0)
                << "along a row, sun at " << azimuth << ", " << altitude;
        }
        for (const double azimuth : {90.0, 70.0, 45.0, 30.0, 120.0, 270.0, 250.0, 300.0}) {
            const double across = length * std::abs(std::sin(glm::radians(azimuth))) / 2.0;
            EXPECT_NEAR(shadowed_samples(false, {2.0, 3.0}, azimuth, altitude, 2.0), across, 2.0)
                << "along a column, sun at " << azimuth << ", " << altitude;
        }
    }
}

// With the sun along the axis the outermost column lies in the shadow like any other.
TEST(SunVisibility, TheShadowReachesTheBorder) {
    const Grid<float> along_row =
        test::made_heights(20, 60, [](int, int row) { return row == 20 ? 10.0 : 0.0; });
    const Grid<float> along_col =
        test::made_heights(60, 20, [](int col, int) { return col == 20 ? 10.0 : 0.0; });
    for (int i = 0; i < 20; ++i) {
        EXPECT_LT(sun_visibility(along_row.view(), {1.0, 1.0}, 1.0, {0.0, 1.0, 1.0})(i, 25), 10)
            << i;
        EXPECT_LT(sun_visibility(along_row.view(), {1.0, 1.0}, 1.0, {0.0, -1.0, 1.0})(i, 15), 10)
            << i;
        EXPECT_LT(sun_visibility(along_col.view(), {1.0, 1.0}, 1.0, {-1.0, 0.0, 1.0})(25, i), 10)
            << i;
        EXPECT_LT(sun_visibility(along_col.view(), {1.0, 1.0}, 1.0, {1.0, 0.0, 1.0})(15, i), 10)
            << i;
    }
}

// Behind a wall 100 m high the sun's disc, 0.53° wide, fades in over as many metres of the shadow's
// height as its distance times that angle.
TEST(SunVisibility, ThePenumbraGrowsWithTheDistance) {
    const Grid<float> heights =
        test::made_heights(3, 4000, [](int, int row) { return row == 10 ? 100.0 : 0.0; });
    const auto partly_lit = [&](double altitude) {
        const auto visible = sun_visibility(heights.view(), {1.0, 1.0}, 1.0, sun_at(0.0, altitude));
        int count = 0;
        for (int row = 20; row < heights.rows(); ++row) {
            count += visible(1, row) > 0 && visible(1, row) < 255 ? 1 : 0;
        }
        return count;
    };
    for (const double altitude : {3.0, 5.0, 10.0, 20.0}) {
        const double near_edge = 100.0 / std::tan(glm::radians(altitude + 0.265));
        const double far_edge = 100.0 / std::tan(glm::radians(altitude - 0.265));
        EXPECT_NEAR(partly_lit(altitude), far_edge - near_edge, 3.0 + 0.25 * (far_edge - near_edge))
            << altitude;
    }
}

TEST(SunVisibility, IsTheSameInTheMirror) {
    const Grid<float> heights = test::random_heights(37, 29, 0.0F, 10.0F, 2);
    const Grid<float> west_east =
        test::made_heights(37, 29, [&](int col, int row) { return heights(36 - col, row); });
    const Grid<float> north_south =
        test::made_heights(37, 29, [&](int col, int row) { return heights(col, 28 - row); });
    const Grid<float> transposed =
        test::made_heights(29, 37, [&](int col, int row) { return heights(row, col); });
    for (double azimuth = 0.0; azimuth < 360.0; azimuth += 22.5) {
        const glm::dvec3 sun = sun_at(azimuth, 30.0);
        const auto visible = sun_visibility(heights.view(), {2.0, 3.0}, 1.0, sun);
        const auto mirrored =
            sun_visibility(west_east.view(), {2.0, 3.0}, 1.0, {-sun.x, sun.y, sun.z});
        const auto flipped =
            sun_visibility(north_south.view(), {2.0, 3.0}, 1.0, {sun.x, -sun.y, sun.z});
        const auto turned =
            sun_visibility(transposed.view(), {3.0, 2.0}, 1.0, {-sun.y, -sun.x, sun.z});
        for (int row = 0; row < 29; ++row) {
            for (int col = 0; col < 37; ++col) {
                ASSERT_NEAR(visible(col, row), mirrored(36 - col, row), 1);
                ASSERT_NEAR(visible(col, row), flipped(col, 28 - row), 1);
                ASSERT_NEAR(visible(col, row), turned(row, col), 1);
            }
        }
    }
}

TEST(SunVisibility, WorksOnTheLeastGrids) {
    for (const auto& [cols, rows] : {std::pair{1, 1}, {2, 2}, {1, 9}, {9, 1}}) {
        const Grid<float> heights(cols, rows, 3.0F);
        EXPECT_EQ(darkest(sun_visibility(heights.view(), {1.0, 1.0}, 1.0, sun_at(33.0, 20.0))),
                  255);
    }
}

TEST(SunVisibility, ShadowsFallAcrossWhereTheFirstColumnComesAgain) {
    constexpr int turn = 40;
    const auto hills = test::random_heights(turn, 30, 0.0F, 40.0F, 7);
    const auto turned = [&](int by) {
        Grid<float> heights(turn + 1, hills.rows());
        for (int row = 0; row < hills.rows(); ++row) {
            for (int col = 0; col <= turn; ++col) {
                heights(col, row) = hills((col + by) % turn, row);
            }
        }
        return heights;
    };
    for (const double azimuth : {90.0, 250.0, 200.0, 10.0}) {
        const auto shares = [&](int by) {
            return sun_visibility(turned(by).view(), {10.0, 10.0}, 1.0, sun_at(azimuth, 30.0),
                                  true);
        };
        const auto here = shares(0);
        const auto there = shares(17);
        EXPECT_LT(darkest(here), 100);
        for (int row = 0; row < here.rows(); ++row) {
            ASSERT_EQ(here(0, row), here(turn, row));
            for (int col = 0; col <= turn; ++col) {
                ASSERT_NEAR(here((col + 17) % turn, row), there(col, row), 1) << azimuth;
            }
        }
    }
}

// Where half of the sun or more is seen, the ground is above the shadow.
TEST(ShadowHeights, AgreeWithTheVisibleShareOfTheSun) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> part(0.0, 1.0);
        const Grid<float> heights = test::random_heights(40, 33, -20.0F, 50.0F, seed);
        const double exaggeration = 0.2 + 3.0 * part(random);
        const glm::dvec3 sun = sun_at(360.0 * part(random), 89.0 * part(random) + 0.5);
        const glm::dvec2 spacing(0.5 + part(random), 0.5 + part(random));
        const auto shares = sun_visibility(heights.view(), spacing, exaggeration, sun);
        const auto edges = shadow_heights(heights.view(), spacing, exaggeration, sun);
        for (std::size_t i = 0; i < heights.samples().size(); ++i) {
            const float above = heights.samples()[i] - edges.samples()[i];
            if (shares.samples()[i] > 128) {
                ASSERT_GT(above, 0.0F) << seed;
            } else if (shares.samples()[i] == 0) {
                ASSERT_LT(above, 0.0F) << seed;
            }
        }
    }
}

TEST(ShadowHeights, OfOneWallFallWithTheDistance) {
    const Grid<float> heights =
        test::made_heights(90, 7, [](int col, int /*row*/) { return col == 20 ? 30.0 : 0.0; });
    const auto edges = shadow_heights(heights.view(), {2.0, 2.0}, 1.0, sun_at(270.0, 30.0));
    for (int col = 21; col < 90; ++col) {
        const double metres = 2.0 * (col - 20);
        const double edge = 30.0 - metres * std::tan(glm::radians(30.0));
        EXPECT_NEAR(edges(col, 3), std::max(edge, -2.0 * std::tan(glm::radians(30.0))), 1e-3);
    }
    EXPECT_GT(shadow_heights(heights.view(), {2.0, 2.0}, 1.0, sun_at(270.0, -1.0))(3, 3), 1e30F);
    EXPECT_LT(shadow_heights(heights.view(), {2.0, 2.0}, 1.0, {0.0, 0.0, 1.0})(3, 3), -1e30F);
}

} // namespace
} // namespace reljef::terrain
