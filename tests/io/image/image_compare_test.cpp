// The project's own RMSE and PSNR against OpenImageIO's, which only this room may include.
#include <array>
#include <limits>
#include <random>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include "engine/truth/image_error.h"
#include "tests/truth/made_picture.h"

namespace reljef::io {
namespace {

OIIO::ImageBuf without_alpha(const Image& picture) {
    OIIO::ImageBuf buffer(
        OIIO::ImageSpec(picture.cols(), picture.rows(), 3, OIIO::TypeDesc::UINT8));
    for (int row = 0; row < picture.rows(); ++row) {
        for (int col = 0; col < picture.cols(); ++col) {
            const Rgba8 color = picture(col, row);
            const std::array channels{static_cast<float>(color.r) / 255.0F,
                                      static_cast<float>(color.g) / 255.0F,
                                      static_cast<float>(color.b) / 255.0F};
            buffer.setpixel(col, row, channels.data());
        }
    }
    return buffer;
}

OIIO::ImageBufAlgo::CompareResults compared(const Image& shown, const Image& truth) {
    return OIIO::ImageBufAlgo::compare(without_alpha(shown), without_alpha(truth), 0.0F, 0.0F);
}

// OpenImageIO sums differences of floats.
TEST(ImageCompare, RmseAndPsnrAreOpenImageIos) {
    std::mt19937 random(1);
    for (int round = 1; round <= 100; ++round) {
        const Image truth = test::random_picture(60 + round % 9, 40 + round % 7, random);
        const Image shown = test::disturbed(truth, round, random);
        const auto theirs = compared(shown, truth);
        const double rmse = truth::root_mean_square_error(shown, truth).value();
        ASSERT_NEAR(rmse, theirs.rms_error, 1e-6 * rmse);
        ASSERT_NEAR(truth::peak_signal_to_noise(rmse), theirs.PSNR, 1e-4);
    }
}

TEST(ImageCompare, IdenticalPicturesHaveInfinitePsnrInBoth) {
    std::mt19937 random(2);
    const Image picture = test::random_picture(30, 20, random);
    const auto theirs = compared(picture, picture);
    EXPECT_EQ(theirs.rms_error, 0.0);
    EXPECT_EQ(theirs.PSNR, std::numeric_limits<double>::infinity());
    EXPECT_EQ(truth::peak_signal_to_noise(truth::root_mean_square_error(picture, picture).value()),
              std::numeric_limits<double>::infinity());
}

} // namespace
} // namespace reljef::io
