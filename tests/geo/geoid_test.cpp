#include "engine/geo/geoid.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace reljef::geo {
namespace {

/// Heights on a grid of degrees, north to south.
template <class Height>
Grid<float> heights_of(int cols, int rows, glm::dvec2 first, glm::dvec2 step,
                       const Height& height) {
    Grid<float> grid(cols, rows);
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            grid(col, row) =
                static_cast<float>(height(first.x + row * step.x, first.y + col * step.y));
        }
    }
    return grid;
}

double wave(double latitude, double longitude) {
    const double degree = std::acos(-1.0) / 180.0;
    return 30.0 * std::sin(2.0 * longitude * degree) * std::cos(3.0 * latitude * degree);
}

TEST(Geoid, IsSmoothAllAroundTheEarth) {
    for (const double west : {0.0, -180.0}) {
        for (const int cols : {1440, 1441}) {
            const glm::dvec2 first(90.0, west);
            const glm::dvec2 step(-0.25, 0.25);
            const Geoid geoid("waves", heights_of(cols, 721, first, step, wave), first, step);
            std::mt19937 random(1);
            std::uniform_real_distribution<double> latitudes(-90.0, 90.0);
            std::uniform_real_distribution<double> longitudes(-540.0, 540.0);
            for (int i = 0; i < 5000; ++i) {
                const double latitude = latitudes(random);
                const double longitude = longitudes(random);
                // Floats of 30 m resolve 2 µm; a cubic over 0.25° of these waves errs by less.
                ASSERT_NEAR(geoid.undulation(latitude, longitude), wave(latitude, longitude), 1e-5)
                    << latitude << " " << longitude;
            }
        }
    }
}

TEST(Geoid, HasTheGridsOwnHeightsAtItsPoints) {
    const glm::dvec2 first(-10.0, 170.0); // across the antimeridian, south to north
    const glm::dvec2 step(0.5, 0.5);
    const auto heights = heights_of(41, 21, first, step, wave);
    const Geoid geoid("part", heights, first, step);
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            const double longitude = first.y + col * step.y;
            ASSERT_NEAR(geoid.undulation(first.x + row * step.x,
                                         longitude > 180.0 ? longitude - 360.0 : longitude),
                        heights(col, row), 1e-9);
        }
    }
}

TEST(Geoid, IsUnknownOutsideAGridThatDoesNotGoRound) {
    const glm::dvec2 first(50.0, 0.0);
    const glm::dvec2 step(-1.0, 1.0);
    const Geoid geoid("part", heights_of(11, 11, first, step, wave), first, step);
    EXPECT_FALSE(std::isnan(geoid.undulation(50.0, 10.0)));
    EXPECT_TRUE(std::isnan(geoid.undulation(51.0, 5.0)));
    EXPECT_TRUE(std::isnan(geoid.undulation(45.0, 10.5)));
    EXPECT_TRUE(std::isnan(geoid.undulation(45.0, -0.5)));
}

TEST(Geoid, AFileThatIsNoneIsAnErrorInOneSentence) {
    const test::TemporaryFolder folder;
    const auto broken = Geoid::read_pgm(folder.write("egm96-5.pgm", "P5\n# cut"));
    ASSERT_FALSE(broken);
    EXPECT_NE(broken.error().message.find("egm96-5.pgm: cannot be read"), std::string::npos);
    EXPECT_FALSE(Geoid::read_pgm(folder.path() / "absent.pgm"));
}

TEST(Geoid, OfAnyPlaceGivesAHeightOfItsGridOrNone) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::uniform_int_distribution<int> sides(4, 40);
    const auto any = [&](double digits) {
        return std::copysign(std::pow(10.0, digits * unit(random)), unit(random));
    };
    int known = 0;
    for (int i = 0; i < 4000; ++i) {
        const double digits = i % 2 == 0 ? 300.0 : 2.5;
        const Geoid geoid("any", Grid<float>(sides(random), sides(random), 1.0F),
                          {any(digits), any(digits)}, {any(digits), any(digits)});
        for (int j = 0; j < 4; ++j) {
            const double found = geoid.undulation(90.0 * unit(random), 540.0 * unit(random));
            ASSERT_TRUE(std::isnan(found) || std::abs(found - 1.0) < 1e-9) << found;
            known += std::isnan(found) ? 0 : 1;
        }
    }
    EXPECT_GT(known, 100);
}

} // namespace
} // namespace reljef::geo
