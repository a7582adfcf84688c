#include "engine/material/sky_picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace reljef::material {
namespace {

// Degrees, clockwise from north, and above the horizon.
glm::dvec3 direction(double azimuth, double altitude) {
    const double level = std::cos(glm::radians(altitude));
    return {std::sin(glm::radians(azimuth)) * level, std::cos(glm::radians(azimuth)) * level,
            std::sin(glm::radians(altitude))};
}

class Directions {
public:
    glm::dvec3 next() {
        std::normal_distribution<double> axis;
        return {axis(random_), axis(random_), axis(random_)};
    }

private:
    std::mt19937 random_{1};
};

// Smooth, and different along each axis.
glm::vec3 smooth_color(glm::dvec3 towards) {
    return glm::vec3(0.5 + 0.4 * glm::normalize(towards));
}

float difference(glm::vec3 a, glm::vec3 b) {
    const glm::vec3 apart = glm::abs(a - b);
    return std::max({apart.r, apart.g, apart.b});
}

constexpr float rounding = 0.005F; // of bytes, linear

TEST(SkyPicture, ShowsItsSourceInAllDirections) {
    const SkyPicture sky(64, smooth_color);
    Directions directions;
    for (int i = 0; i < 3000; ++i) {
        const glm::dvec3 to = directions.next();
        ASSERT_LE(difference(sky.color(to), smooth_color(to)), rounding);
        ASSERT_LE(difference(sky.color(7.0 * to, 2), smooth_color(to)), 3.0F * rounding)
            << "of 16 texels";
    }
}

// Both faces at an edge, and all three at a corner, meet in one colour.
TEST(SkyPicture, FacesHaveNoSeams) {
    const SkyPicture sky(32, [](glm::dvec3 to) {
        const glm::dvec3 waves = glm::sin(9.0 * glm::normalize(to));
        return glm::vec3(0.5 + 0.5 * waves);
    });
    Directions directions;
    for (int i = 0; i < 2000; ++i) {
        glm::dvec3 to = directions.next();
        const int across = i % 3;
        const int along = (across + 1) % 3;
        to[along] = std::copysign(to[across], to[along]); // on the edge
        glm::dvec3 beside = to;
        to[along] *= 1.0 + 1e-9;
        beside[along] *= 1.0 - 1e-9;
        ASSERT_LE(difference(sky.color(to), sky.color(beside)), 0.02F) << i;
    }
}

// A panorama of four colours: north, east, south and west.
Image quarters(int rows) {
    Image picture(4 * 16, rows);
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < picture.cols(); ++col) {
            const int quarter = (col + 8) / 16 % 4; // south first
            picture(col, row) = quarter == 0   ? Rgba8{0, 0, 255}
                                : quarter == 1 ? Rgba8{255, 255, 0}
                                : quarter == 2 ? Rgba8{255, 0, 0}
                                               : Rgba8{0, 255, 0};
        }
    }
    return picture;
}

TEST(SkyPicture, TheMiddleOfAPanoramaIsNorthAndItsRightEast) {
    const SkyPicture sky = sky_from_panorama(quarters(32), {});
    EXPECT_LE(difference(sky.color(direction(0.0, 10.0)), {1, 0, 0}), rounding);
    EXPECT_LE(difference(sky.color(direction(90.0, -10.0)), {0, 1, 0}), rounding);
    EXPECT_LE(difference(sky.color(direction(180.0, 20.0)), {0, 0, 1}), rounding);
    EXPECT_LE(difference(sky.color(direction(270.0, 0.0)), {1, 1, 0}), rounding);
    const SkyPicture turned = sky_from_panorama(quarters(32), {90.0, false});
    EXPECT_LE(difference(turned.color(direction(90.0, 10.0)), {1, 0, 0}), rounding) << "clockwise";
}

// Lines that are narrower than the texels of the largest faces, and those that meet at the zenith.
TEST(SkyPicture, FineLinesOfAPanoramaBecomeTheirMean) {
    Image picture(16384, 64);
    for (int row = 0; row < picture.rows(); ++row) {
        for (int col = 0; col < picture.cols(); ++col) {
            const auto grey = static_cast<std::uint8_t>(col % 2 == 0 ? 0 : 255);
            picture(col, row) = {grey, grey, grey};
        }
    }
    const SkyPicture fine = sky_from_panorama(picture, {});
    EXPECT_NEAR(fine.color(direction(10.0, 3.0)).r, 0.5F, 0.02F);
    Image meridians(720, 360);
    for (int row = 0; row < meridians.rows(); ++row) {
        for (int col = 0; col < meridians.cols(); ++col) {
            const auto grey = static_cast<std::uint8_t>(col / 2 % 2 == 0 ? 0 : 255);
            meridians(col, row) = {grey, grey, grey};
        }
    }
    const SkyPicture zenith = sky_from_panorama(meridians, {});
    for (const double azimuth : {0.0, 77.0, 215.0}) {
        EXPECT_NEAR(zenith.color(direction(azimuth, 89.0)).r, 0.5F, 0.1F) << azimuth;
    }
}

TEST(SkyPicture, ADomeEndsAtTheHorizon) {
    Image picture(64, 16);
    for (int row = 0; row < picture.rows(); ++row) {
        const auto grey = static_cast<std::uint8_t>(255 - 16 * row);
        std::ranges::fill(picture.row(row), Rgba8{grey, grey, grey});
    }
    const SkyPicture sky = sky_from_panorama(picture, {0.0, true});
    EXPECT_NEAR(sky.color({0, 0, 1}).r, 1.0F, 0.1F);
    const float low = linear_from_rgba8(picture(0, 15)).r;
    EXPECT_NEAR(sky.color(direction(30.0, 0.0)).r, low, 0.02F);
    EXPECT_NEAR(sky.color(direction(200.0, -50.0)).r, low, rounding) << "goes on below";
    EXPECT_NEAR(sky.horizon().r, low, 0.03F);
}

TEST(SkyPicture, FacesLookWhereTheirNamesSay) {
    SkyFaces faces;
    for (std::size_t i = 0; i < faces.pictures.size(); ++i) {
        Image& picture = faces.pictures[i];
        picture = Image(8, 8);
        for (int row = 0; row < 8; ++row) { // the lower half is darker, the right half reddish
            for (int col = 0; col < 8; ++col) {
                const auto base = static_cast<std::uint8_t>(40 * (i + 1));
                picture(col, row) = {static_cast<std::uint8_t>(col < 4 ? 0 : 255), base,
                                     static_cast<std::uint8_t>(row < 4 ? 255 : 0)};
            }
        }
    }
    const SkyPicture sky = sky_from_faces(faces, 0.0);
    const auto green_of = [&](SkyFaces::Face face) {
        return linear_from_rgba8(faces.pictures[face](0, 0)).g;
    };
    const auto expect = [&](glm::dvec3 to, SkyFaces::Face face, bool is_right, bool is_low) {
        const glm::vec3 color = sky.color(to);
        EXPECT_NEAR(color.g, green_of(face), rounding);
        EXPECT_NEAR(color.r, is_right ? 1.0F : 0.0F, rounding);
        EXPECT_NEAR(color.b, is_low ? 0.0F : 1.0F, rounding);
    };
    expect(direction(20.0, 20.0), SkyFaces::front, true, false);
    expect(direction(70.0, -20.0), SkyFaces::right, false, true);
    expect(direction(160.0, 20.0), SkyFaces::back, false, false);
    expect(direction(290.0, 20.0), SkyFaces::left, true, false);
    expect({0.4, 0.4, 1.0}, SkyFaces::up, true, true);       // the front is below
    expect({-0.4, 0.4, -1.0}, SkyFaces::down, false, false); // the front is above
    EXPECT_NEAR(sky_from_faces(faces, 90.0).color(direction(90.0, 20.0)).g,
                green_of(SkyFaces::front), rounding);
}

TEST(SkyPicture, LevelsFitThePixels) {
    const SkyPicture sky(64, smooth_color);
    ASSERT_EQ(sky.levels().size(), 7U);
    EXPECT_EQ(sky.levels().back().side, 1);
    EXPECT_EQ(sky.level_for(0.0), 0U);
    EXPECT_EQ(sky.level_for(2.0 / 64.0), 0U);
    EXPECT_EQ(sky.level_for(2.0 / 16.0), 2U);
    EXPECT_EQ(sky.level_for(1e9), 6U);
    const SkyPicture odd(5, smooth_color);
    EXPECT_LE(difference(odd.color({1, 0, 0}, odd.levels().size() - 1), smooth_color({1, 0, 0})),
              0.2F);
}

} // namespace
} // namespace reljef::material
