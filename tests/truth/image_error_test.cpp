#include "engine/truth/image_error.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/truth/made_picture.h"

namespace reljef::truth {
namespace {

using test::disturbed;
using test::plain_picture;
using test::random_picture;

Rgba8 gray(int level) {
    const auto byte = static_cast<std::uint8_t>(level);
    return {byte, byte, byte, 255};
}

double luma(Rgba8 color) {
    return 0.299 * color.r + 0.587 * color.g + 0.114 * color.b;
}

// SSIM of one window as the paper has it, with weights and sums in two dimensions.
double similarity_of_window(const Image& a, const Image& b, int left, int top) {
    double total = 0.0;
    double mean_a = 0.0;
    double mean_b = 0.0;
    const auto each = [&](const auto& visit) {
        for (int y = 0; y < 11; ++y) {
            for (int x = 0; x < 11; ++x) {
                const double d = (x - 5) * (x - 5) + (y - 5) * (y - 5);
                visit(std::exp(-d / (2.0 * 1.5 * 1.5)), luma(a(left + x, top + y)),
                      luma(b(left + x, top + y)));
            }
        }
    };
    each([&](double weight, double la, double lb) {
        total += weight;
        mean_a += weight * la;
        mean_b += weight * lb;
    });
    mean_a /= total;
    mean_b /= total;
    double variance_a = 0.0;
    double variance_b = 0.0;
    double covariance = 0.0;
    each([&](double weight, double la, double lb) {
        variance_a += weight / total * (la - mean_a) * (la - mean_a);
        variance_b += weight / total * (lb - mean_b) * (lb - mean_b);
        covariance += weight / total * (la - mean_a) * (lb - mean_b);
    });
    const double c1 = std::pow(0.01 * 255.0, 2.0);
    const double c2 = std::pow(0.03 * 255.0, 2.0);
    return (2.0 * mean_a * mean_b + c1) * (2.0 * covariance + c2) /
           ((mean_a * mean_a + mean_b * mean_b + c1) * (variance_a + variance_b + c2));
}

double similarity_by_definition(const Image& a, const Image& b) {
    double sum = 0.0;
    int count = 0;
    for (int top = 0; top + 11 <= a.rows(); ++top) {
        for (int left = 0; left + 11 <= a.cols(); ++left) {
            sum += similarity_of_window(a, b, left, top);
            ++count;
        }
    }
    return sum / count;
}

TEST(ImageErrors, OfIdenticalPicturesAreNone) {
    std::mt19937 random(1);
    for (int round = 0; round < 20; ++round) {
        const Image picture = random_picture(40, 30, random);
        const auto errors = image_errors(picture, picture);
        ASSERT_TRUE(errors);
        EXPECT_EQ(errors->rmse, 0.0);
        EXPECT_EQ(errors->psnr, std::numeric_limits<double>::infinity());
        EXPECT_EQ(errors->ssim, 1.0);
        EXPECT_EQ(errors->flip.mean, 0.0);
        EXPECT_EQ(errors->flip.map, Grid<float>(40, 30, 0.0F));
    }
}

TEST(ImageErrors, OneWrongByteIsSeenByAllOfThem) {
    std::mt19937 random(2);
    for (int round = 0; round < 50; ++round) {
        const Image truth = random_picture(32, 24, random);
        Image shown = truth;
        auto& byte = shown(std::uniform_int_distribution<int>(5, 26)(random),
                           std::uniform_int_distribution<int>(5, 18)(random))
                         .g;
        byte = static_cast<std::uint8_t>(byte ^ 0x80U);
        const auto errors = image_errors(shown, truth);
        ASSERT_TRUE(errors);
        EXPECT_NEAR(errors->rmse, 128.0 / 255.0 / std::sqrt(3.0 * 32.0 * 24.0), 1e-15);
        EXPECT_LT(errors->psnr, 50.0);
        EXPECT_LT(errors->ssim.value(), 0.99999);
        EXPECT_GT(errors->flip.mean, 1e-4);
    }
}

TEST(ImageErrors, DoNotLookAtAlpha) {
    std::mt19937 random(3);
    const Image truth = random_picture(20, 20, random);
    Image shown = truth;
    for (Rgba8& color : shown.samples()) {
        color.a = static_cast<std::uint8_t>(~color.a);
    }
    const auto errors = image_errors(shown, truth);
    ASSERT_TRUE(errors);
    EXPECT_EQ(errors->rmse, 0.0);
    EXPECT_EQ(errors->ssim, 1.0);
    EXPECT_EQ(errors->flip.mean, 0.0);
}

TEST(ImageErrors, PicturesSmallerThanTheWindowHaveAllButSsim) {
    const auto errors =
        image_errors(plain_picture(10, 30, gray(10)), plain_picture(10, 30, gray(61)));
    ASSERT_TRUE(errors);
    EXPECT_FALSE(errors->ssim);
    EXPECT_NEAR(errors->rmse, 0.2, 1e-15);
    EXPECT_GT(errors->flip.mean, 0.0);
}

TEST(ImageErrors, PicturesOfDifferentSizeOrWithoutPixelsAreAnError) {
    const Image small(20, 30);
    const Image large(30, 20);
    for (const auto& message : {image_errors(small, large).error().message,
                                root_mean_square_error(small, large).error().message,
                                structural_similarity(small, large).error().message,
                                flip(small, large).error().message}) {
        EXPECT_EQ(message, "a picture of 20x30 pixels: 30x20 as the true one was expected");
    }
    EXPECT_EQ(image_errors(Image(), Image()).error().message,
              "a picture of 0x0 pixels: one pixel at least was expected");
}

TEST(RootMeanSquareError, OfAUniformDifferenceIsThatDifference) {
    for (int base = 0; base <= 255; base += 15) {
        for (int step = 1; base + step <= 255; step += 7) {
            const auto rmse = root_mean_square_error(plain_picture(17, 5, gray(base + step)),
                                                     plain_picture(17, 5, gray(base)));
            ASSERT_TRUE(rmse);
            ASSERT_NEAR(*rmse, step / 255.0, 1e-15);
            ASSERT_NEAR(peak_signal_to_noise(*rmse), 20.0 * std::log10(255.0 / step), 1e-12);
        }
    }
}

TEST(RootMeanSquareError, WeighsTheChannelsEqually) {
    const Image black = plain_picture(3, 3, gray(0));
    for (const Rgba8 color : {Rgba8{255, 0, 0}, Rgba8{0, 255, 0}, Rgba8{0, 0, 255}}) {
        EXPECT_NEAR(root_mean_square_error(plain_picture(3, 3, color), black).value(),
                    std::sqrt(1.0 / 3.0), 1e-15);
    }
    EXPECT_NEAR(peak_signal_to_noise(0.1), 20.0, 1e-12);
}

TEST(StructuralSimilarity, OfConstantPicturesIsTheLuminanceTerm) {
    constexpr double c1 = 6.5025;
    for (int a = 0; a <= 255; a += 5) {
        for (int b = 0; b <= 255; b += 5) {
            const auto ssim = structural_similarity(plain_picture(16, 13, gray(a)),
                                                    plain_picture(16, 13, gray(b)), 1);
            ASSERT_TRUE(ssim);
            ASSERT_NEAR(*ssim, (2.0 * a * b + c1) / (a * a + b * b + c1), 1e-9);
        }
    }
}

TEST(StructuralSimilarity, IsTheDefinitionWindowByWindow) {
    std::mt19937 random(4);
    for (int round = 0; round < 30; ++round) {
        const Image truth = random_picture(11 + round % 7, 11 + round % 4, random);
        const Image shown = disturbed(truth, 1 + 8 * round, random);
        const auto ssim = structural_similarity(shown, truth);
        ASSERT_TRUE(ssim);
        ASSERT_NEAR(*ssim, similarity_by_definition(shown, truth), 1e-11);
    }
}

TEST(StructuralSimilarity, IsNegativeForANegative) {
    std::mt19937 random(5);
    const Image truth = random_picture(64, 64, random);
    Image negative = truth;
    for (Rgba8& color : negative.samples()) {
        color = {static_cast<std::uint8_t>(255 - color.r), static_cast<std::uint8_t>(255 - color.g),
                 static_cast<std::uint8_t>(255 - color.b)};
    }
    EXPECT_LT(structural_similarity(negative, truth).value(), -0.9);
}

TEST(StructuralSimilarity, IsSymmetricAndFallsAsNoiseGrows) {
    std::mt19937 random(6);
    const Image truth = random_picture(64, 48, random);
    double last = 1.0;
    for (const int noise : {4, 16, 64, 255}) {
        const Image shown = disturbed(truth, noise, random);
        const double ssim = structural_similarity(shown, truth).value();
        EXPECT_LT(ssim, last);
        EXPECT_NEAR(ssim, structural_similarity(truth, shown).value(), 1e-12);
        last = ssim;
    }
}

TEST(StructuralSimilarity, NeedsAPictureAsLargeAsItsWindow) {
    EXPECT_TRUE(structural_similarity(Image(11, 11), Image(11, 11)));
    const auto ssim = structural_similarity(Image(40, 10), Image(40, 10));
    ASSERT_FALSE(ssim);
    EXPECT_EQ(ssim.error().message,
              "SSIM of pictures of 40x10 pixels: 11x11 at least were expected");
}

} // namespace
} // namespace reljef::truth
