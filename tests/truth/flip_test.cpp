#include "engine/truth/flip.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "tests/support/release_only.h"
#include "tests/truth/made_picture.h"

namespace reljef::truth {
namespace {

using test::disturbed;
using test::plain_picture;
using test::random_picture;

// --- the paper's formulas, written out a second time and as they stand there ---

double linear(std::uint8_t byte) {
    const double encoded = byte / 255.0;
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

glm::dvec3 linear_of(Rgba8 color) {
    return {linear(color.r), linear(color.g), linear(color.b)};
}

glm::dmat3 xyz_from_linear() {
    return {{10135552.0 / 24577794.0, 2613072.0 / 12288897.0, 1425312.0 / 73733382.0},
            {8788810.0 / 24577794.0, 8788810.0 / 12288897.0, 8788810.0 / 73733382.0},
            {4435075.0 / 24577794.0, 887015.0 / 12288897.0, 70074185.0 / 73733382.0}};
}

glm::dvec3 white() {
    return xyz_from_linear() * glm::dvec3(1.0);
}

glm::dvec3 ycxcz(glm::dvec3 rgb) {
    const glm::dvec3 xyz = xyz_from_linear() * rgb / white();
    return {116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z)};
}

glm::dvec3 linear_from_ycxcz(glm::dvec3 opponent) {
    const double y = (opponent.x + 16.0) / 116.0;
    const glm::dvec3 xyz(y + opponent.y / 500.0, y, y - opponent.z / 200.0);
    return glm::inverse(xyz_from_linear()) * (xyz * white());
}

double lab_curve(double t) {
    constexpr double delta = 6.0 / 29.0;
    return t > std::pow(delta, 3.0) ? std::cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
}

glm::dvec3 hunt_lab(glm::dvec3 rgb) {
    const glm::dvec3 xyz = xyz_from_linear() * rgb / white();
    const glm::dvec3 f(lab_curve(xyz.x), lab_curve(xyz.y), lab_curve(xyz.z));
    const double lightness = 116.0 * f.y - 16.0;
    return {lightness, 0.01 * lightness * 500.0 * (f.x - f.y),
            0.01 * lightness * 200.0 * (f.y - f.z)};
}

double hyab(glm::dvec3 a, glm::dvec3 b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// The colour error of two linear colours as they are after filtering.
double color_error(glm::dvec3 a, glm::dvec3 b) {
    const double most = std::pow(hyab(hunt_lab({0.0, 1.0, 0.0}), hunt_lab({0.0, 0.0, 1.0})), 0.7);
    const double difference = std::pow(hyab(hunt_lab(a), hunt_lab(b)), 0.7);
    return difference < 0.4 * most
               ? 0.95 / (0.4 * most) * difference
               : 0.95 + (difference - 0.4 * most) / (most - 0.4 * most) * (1.0 - 0.95);
}

// A filter in two dimensions: weight(dx, dy) in pixels, over [−radius, radius]².
template <class Weight> Grid<double> kernel_of(int radius, const Weight& weight) {
    Grid<double> kernel(2 * radius + 1, 2 * radius + 1);
    for (int y = -radius; y <= radius; ++y) {
        for (int x = -radius; x <= radius; ++x) {
            kernel(x + radius, y + radius) = weight(x, y);
        }
    }
    return kernel;
}

// Positive weights to a sum of 1 and negative ones to −1.
Grid<double> balanced(Grid<double> kernel) {
    double positive = 0.0;
    double negative = 0.0;
    for (const double weight : kernel.samples()) {
        positive += std::max(weight, 0.0);
        negative -= std::min(weight, 0.0);
    }
    for (double& weight : kernel.samples()) {
        weight /= weight > 0.0 ? positive : negative;
    }
    return kernel;
}

template <class Value>
auto filtered_at(const Grid<double>& kernel, int col, int row, const Value& value) {
    const int radius = kernel.cols() / 2;
    decltype(value(0, 0)) sum{};
    for (int y = -radius; y <= radius; ++y) {
        for (int x = -radius; x <= radius; ++x) {
            sum += kernel(x + radius, y + radius) * value(col + x, row + y);
        }
    }
    return sum;
}

Grid<double> sensitivity_kernel(double a1, double b1, double a2, double b2, double ppd) {
    constexpr double pi = std::numbers::pi;
    const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * pi * pi)) * ppd));
    return balanced(kernel_of(radius, [&](int x, int y) {
        const double z = (x * x + y * y) / (ppd * ppd);
        return a1 * std::sqrt(pi / b1) * std::exp(-pi * pi * z / b1) +
               a2 * std::sqrt(pi / b2) * std::exp(-pi * pi * z / b2);
    }));
}

struct Kernels {
    std::array<Grid<double>, 3> sensitivity;
    std::array<Grid<double>, 2> edge; // along x, along y
    std::array<Grid<double>, 2> point;
};

Kernels kernels_for(double ppd) {
    const double sd = 0.5 * 0.082 * ppd;
    const int radius = static_cast<int>(std::ceil(3.0 * sd));
    const auto edge = [&](double along, double across) {
        return -along * std::exp(-(along * along + across * across) / (2.0 * sd * sd));
    };
    const auto point = [&](double along, double across) {
        return (along * along / (sd * sd) - 1.0) *
               std::exp(-(along * along + across * across) / (2.0 * sd * sd));
    };
    const auto both = [&](const auto& weight) {
        return std::array{balanced(kernel_of(radius, [&](int x, int y) { return weight(x, y); })),
                          balanced(kernel_of(radius, [&](int x, int y) { return weight(y, x); }))};
    };
    return {{sensitivity_kernel(1.0, 0.0047, 0.0, 1e-5, ppd),
             sensitivity_kernel(1.0, 0.0053, 0.0, 1e-5, ppd),
             sensitivity_kernel(34.1, 0.04, 13.5, 0.025, ppd)},
            both(edge),
            both(point)};
}

glm::dvec3 sensed_at(const Kernels& kernels, const Image& picture, int col, int row) {
    glm::dvec3 sensed(0.0);
    for (int channel = 0; channel < 3; ++channel) {
        sensed[channel] = filtered_at(
            kernels.sensitivity[static_cast<std::size_t>(channel)], col, row,
            [&](int x, int y) { return ycxcz(linear_of(picture.clamped(x, y)))[channel]; });
    }
    return glm::clamp(linear_from_ycxcz(sensed), glm::dvec3(0.0), glm::dvec3(1.0));
}

double feature_at(const std::array<Grid<double>, 2>& kernels, const Image& picture, int col,
                  int row) {
    const auto luminance = [&](int x, int y) {
        return (ycxcz(linear_of(picture.clamped(x, y))).x + 16.0) / 116.0;
    };
    return std::hypot(filtered_at(kernels[0], col, row, luminance),
                      filtered_at(kernels[1], col, row, luminance));
}

double flip_at(const Kernels& kernels, const Image& a, const Image& b, int col, int row) {
    const double color =
        color_error(sensed_at(kernels, a, col, row), sensed_at(kernels, b, col, row));
    const double edges =
        std::abs(feature_at(kernels.edge, a, col, row) - feature_at(kernels.edge, b, col, row));
    const double points =
        std::abs(feature_at(kernels.point, a, col, row) - feature_at(kernels.point, b, col, row));
    const double feature = std::sqrt(std::max(edges, points) / std::sqrt(2.0));
    return std::pow(color, 1.0 - feature);
}

// --- tests ---

double mean_flip(const Image& a, const Image& b, const FlipOptions& options = {}) {
    return flip(a, b, options).value().mean;
}

TEST(Flip, OfBlackAndWhiteIsTheClosedForm) {
    const Image black = plain_picture(40, 30, {0, 0, 0});
    const Image white = plain_picture(40, 30, {255, 255, 255});
    const auto result = flip(black, white);
    ASSERT_TRUE(result);
    // HyAB 100 between them, 203.3 between green and blue after Hunt's adjustment.
    EXPECT_NEAR(result->mean, 0.967, 1e-3);
    const double expected = color_error(glm::dvec3(0.0), glm::dvec3(1.0));
    for (const float error : result->map.samples()) {
        ASSERT_NEAR(error, expected, 1e-6);
    }
}

TEST(Flip, OfGreenAndBlueIsOne) {
    EXPECT_NEAR(mean_flip(plain_picture(30, 30, {0, 255, 0}), plain_picture(30, 30, {0, 0, 255})),
                1.0, 1e-6);
}

TEST(Flip, OfConstantPicturesIsTheClosedForm) {
    std::mt19937 random(1);
    for (int round = 0; round < 2000; ++round) {
        const Image a = plain_picture(4, 3, random_picture(1, 1, random)(0, 0));
        const Image b = round % 2 == 0 ? plain_picture(4, 3, random_picture(1, 1, random)(0, 0))
                                       : plain_picture(4, 3, disturbed(a, 2, random)(0, 0));
        const double expected = color_error(linear_of(a(0, 0)), linear_of(b(0, 0)));
        const Flip result = flip(a, b, {.threads = 1}).value();
        for (const float error : result.map.samples()) {
            ASSERT_NEAR(error, expected, 1e-6);
        }
    }
}

// Separable passes against the paper's filters in two dimensions, weight by weight.
TEST(Flip, IsTheDefinitionPixelByPixel) {
    std::mt19937 random(2);
    for (const double ppd : {5.0, 20.0, FlipOptions().pixels_per_degree}) {
        const Kernels kernels = kernels_for(ppd);
        const Image truth = random_picture(13, 9, random);
        for (const Image& shown : {random_picture(13, 9, random), disturbed(truth, 30, random)}) {
            const auto result = flip(shown, truth, {.pixels_per_degree = ppd});
            ASSERT_TRUE(result);
            for (int row = 0; row < truth.rows(); ++row) {
                for (int col = 0; col < truth.cols(); ++col) {
                    ASSERT_NEAR(result->map(col, row), flip_at(kernels, shown, truth, col, row),
                                1e-6);
                }
            }
        }
    }
}

TEST(Flip, OfIdenticalPicturesIsZero) {
    std::mt19937 random(3);
    const Image picture = random_picture(33, 21, random);
    EXPECT_EQ(flip(picture, picture).value().map, Grid<float>(33, 21, 0.0F));
}

TEST(Flip, IsSymmetricAndInTheUnitRange) {
    std::mt19937 random(4);
    for (int round = 0; round < 60; ++round) {
        const Image a = random_picture(25, 19, random);
        const Image b =
            round % 2 == 0 ? random_picture(25, 19, random) : disturbed(a, 1 + round, random);
        const Flip forth = flip(a, b).value();
        const Flip back = flip(b, a).value();
        ASSERT_EQ(forth.map, back.map);
        ASSERT_EQ(forth.mean, back.mean);
        for (const float error : forth.map.samples()) {
            ASSERT_GE(error, 0.0F);
            ASSERT_LE(error, 1.0F);
        }
    }
}

// Black on white: a hard edge, a line, a dot of one pixel, a disc.
bool is_dark(int pattern, int col, int row) {
    switch (pattern) {
    case 0:
        return col < 20;
    case 1:
        return col == 20;
    case 2:
        return col == 20 && row == 20;
    default:
        return std::hypot(col - 20, row - 20) < 4.0;
    }
}

Image pattern_picture(int pattern) {
    Image picture = plain_picture(41, 41, {255, 255, 255});
    for (int row = 0; row < 41; ++row) {
        for (int col = 0; col < 41; ++col) {
            picture(col, row) = is_dark(pattern, col, row) ? Rgba8{0, 0, 0} : picture(col, row);
        }
    }
    return picture;
}

TEST(Flip, StaysInTheUnitRangeWhereFeaturesAreLargest) {
    const Image white = plain_picture(41, 41, {255, 255, 255});
    for (int pattern = 0; pattern < 4; ++pattern) {
        const Flip result = flip(pattern_picture(pattern), white).value();
        for (const float error : result.map.samples()) {
            ASSERT_GE(error, 0.0F);
            ASSERT_LE(error, 1.0F);
        }
        EXPECT_GT(result.map(20, 20), pattern == 2 ? 0.05F : 0.3F) << pattern;
    }
}

TEST(Flip, GrowsWithTheDifference) {
    RELJEF_RELEASE_ONLY("many pictures by the same few lines");
    const Image black = plain_picture(8, 8, {0, 0, 0});
    double last = 0.0;
    for (int level = 1; level <= 255; ++level) {
        const auto byte = static_cast<std::uint8_t>(level);
        const double mean = mean_flip(plain_picture(8, 8, {byte, byte, byte}), black);
        ASSERT_GT(mean, last);
        last = mean;
    }
    std::mt19937 random(5);
    const Image truth = random_picture(60, 40, random);
    last = 0.0;
    for (const int noise : {2, 8, 32, 128}) {
        const double mean = mean_flip(disturbed(truth, noise, random), truth);
        EXPECT_GT(mean, last);
        last = mean;
    }
}

// What the colours alone say is raised where an edge is there in one of the pictures only.
TEST(Flip, AnEdgeIsWorseThanItsColors) {
    Image edge = plain_picture(61, 61, {100, 100, 100});
    for (int row = 0; row < 61; ++row) {
        for (int col = 30; col < 61; ++col) {
            edge(col, row) = {120, 120, 120};
        }
    }
    const Image plain = plain_picture(61, 61, {120, 120, 120});
    const Flip result = flip(edge, plain).value();
    const float at_edge = result.map(29, 30);
    const float far_from_edge = result.map(5, 30);
    EXPECT_GT(at_edge, far_from_edge);
    EXPECT_EQ(result.map(60, 30), 0.0F);
}

// The viewer sees less of a fine pattern from farther away.
TEST(Flip, OfAFinePatternFallsWithDistance) {
    Image pattern = plain_picture(64, 64, {128, 128, 128});
    for (int row = 0; row < 64; ++row) {
        for (int col = 0; col < 64; ++col) {
            const auto level = static_cast<std::uint8_t>((col + row) % 2 == 0 ? 148 : 108);
            pattern(col, row) = {level, level, level};
        }
    }
    const Image plain = plain_picture(64, 64, {128, 128, 128});
    const double near = mean_flip(pattern, plain, {.pixels_per_degree = 10.0});
    const double far = mean_flip(pattern, plain, {.pixels_per_degree = 67.0});
    EXPECT_GT(near, 2.0 * far);
}

TEST(Flip, DoesNotDependOnThreads) {
    std::mt19937 random(6);
    const Image a = random_picture(70, 50, random);
    const Image b = random_picture(70, 50, random);
    const Flip one = flip(a, b, {.threads = 1}).value();
    const Flip many = flip(a, b, {.threads = 5}).value();
    EXPECT_EQ(one.map, many.map);
    EXPECT_EQ(one.mean, many.mean);
}

TEST(Flip, IsSeenFromWhereThePaperDoes) {
    EXPECT_NEAR(FlipOptions().pixels_per_degree, 67.02, 0.005);
}

TEST(FlipDeathTest, NeedsAPixelPerDegree) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_DEATH(static_cast<void>(flip(Image(2, 2), Image(2, 2), {.pixels_per_degree = 0.5})),
                 "per degree");
}

} // namespace
} // namespace reljef::truth
