#include "engine/terrain/field/tint.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

constexpr Rgba8 pale{173, 173, 171, 255};

Image tinted(const Heightfield& heightfield) {
    return hypsometric_tint(heightfield, *named_ramp(default_ramp));
}

bool is_blue(Rgba8 color) {
    return color.b > color.g && color.g > color.r;
}

TEST(Tint, OneOpaquePixelPerSample) {
    const Image image =
        tinted(test::plane_heightfield(test::random_heights(13, 7, 1.0F, 900.0F, 1)));
    EXPECT_EQ(image.cols(), 13);
    EXPECT_EQ(image.rows(), 7);
    for (const Rgba8& pixel : image.samples()) {
        EXPECT_EQ(pixel.a, 255);
    }
}

TEST(Tint, GoesFromGreenLowlandToLightSummits) {
    const Image image = tinted(test::plane_heightfield(
        test::made_heights(101, 3, [](int col, int) { return 10.0 + 40.0 * col; }),
        {1000.0, 1000.0}));
    const Rgba8 low = image(0, 1);
    EXPECT_GT(low.g, low.r);
    EXPECT_GT(low.g, low.b);
    const Rgba8 high = image(100, 1);
    EXPECT_GT(std::min({high.r, high.g, high.b}), 190);
}

// A jump of the tint would show as a contour line that is not there.
TEST(Tint, IsContinuousInTheHeight) {
    const Image image = tinted(test::plane_heightfield(
        test::made_heights(2001, 2, [](int col, int) { return 100.0 + 0.5 * col; })));
    for (int col = 1; col < image.cols(); ++col) {
        EXPECT_LE(std::abs(image(col, 0).r - image(col - 1, 0).r), 2) << col;
        EXPECT_LE(std::abs(image(col, 0).g - image(col - 1, 0).g), 2) << col;
        EXPECT_LE(std::abs(image(col, 0).b - image(col - 1, 0).b), 2) << col;
    }
}

TEST(Tint, OutsideTheDataItIsPaleAndDoesNotStretchTheScale) {
    Heightfield heightfield = test::plane_heightfield(
        test::made_heights(60, 60, [](int col, int) { return 100.0 + col; }));
    const Image whole = tinted(heightfield);
    heightfield.void_mask = Grid<std::uint8_t>(60, 60, 0);
    for (int row = 0; row < 60; ++row) {
        heightfield.void_mask(30, row) = 1;
        heightfield.heights(30, row) = 1e6F;
    }
    const Image holed = tinted(heightfield);
    EXPECT_EQ(holed(30, 30), pale);
    for (const int col : {5, 20, 45, 58}) {
        EXPECT_LE(std::abs(holed(col, 9).r - whole(col, 9).r), 4);
    }
}

// Grey patches with stairs showed on a summit.
TEST(Tint, VoidsInsideTheDataLookLikeTheGroundAround) {
    Heightfield heightfield = test::plane_heightfield(
        test::made_heights(60, 60, [](int col, int) { return 100.0 + col; }));
    const Image whole = tinted(heightfield);
    heightfield.void_mask = Grid<std::uint8_t>(60, 60, 0);
    for (int row = 20; row < 40; ++row) {
        for (int col = 20; col < 30; ++col) {
            heightfield.void_mask(col, row) = 1;
        }
    }
    heightfield.void_mask(0, 30) = 1; // on the border, but few
    const Image holed = tinted(heightfield);
    for (std::size_t i = 0; i < holed.samples().size(); ++i) {
        ASSERT_LE(std::abs(holed.samples()[i].r - whole.samples()[i].r), 1);
    }
}

TEST(Tint, AColorOfNoDataIsThatOfAllVoids) {
    Heightfield heightfield = test::plane_heightfield(Grid<float>(60, 60, 100.0F));
    heightfield.void_mask = Grid<std::uint8_t>(60, 60, 0);
    heightfield.void_mask(30, 30) = 1;
    ColorRamp ramp = *named_ramp(default_ramp);
    ramp.no_data = Rgba8{1, 2, 3, 255};
    EXPECT_EQ(hypsometric_tint(heightfield, ramp)(30, 30), (Rgba8{1, 2, 3, 255}));
}

// A few cells at one end of a wide void: every hundredth sample met none of them.
TEST(Tint, FewHeightsInAWideVoidAreSeenAll) {
    constexpr int cols = 6300;
    constexpr int rows = 1050;
    Heightfield heightfield = test::plane_heightfield(
        test::made_heights(cols, rows, [](int col, int) { return static_cast<double>(col); }));
    heightfield.void_mask = Grid<std::uint8_t>(cols, rows, 1);
    for (int row = 0; row < rows; ++row) {
        heightfield.void_mask(0, row) = 0;
        for (int col = 6225; col < cols; ++col) {
            heightfield.void_mask(col, row) = 0;
        }
    }
    const HeightTint tint(*named_ramp("stretched"), heightfield);
    EXPECT_NE(tint.at(0.0, {0.0F, 0.0F}), tint.at(6299.0, {0.0F, 0.0F}));
}

TEST(Tint, AllVoidIsPale) {
    Heightfield heightfield = test::plane_heightfield(Grid<float>(4, 4, 0.0F));
    heightfield.void_mask = Grid<std::uint8_t>(4, 4, 1);
    const Image image = tinted(heightfield);
    for (const Rgba8& pixel : image.samples()) {
        EXPECT_EQ(pixel, pale);
    }
}

TEST(Tint, LevelGroundAtZeroIsWaterAndItsShoreIsNot) {
    const Image image = tinted(test::plane_heightfield(test::made_heights(
        20, 20, [](int col, int) { return col < 10 ? 0.0 : 30.0 * (col - 9); })));
    EXPECT_TRUE(is_blue(image(0, 0)));
    EXPECT_TRUE(is_blue(image(8, 19)));
    EXPECT_FALSE(is_blue(image(9, 5))) << "its neighbour is not level";
    EXPECT_FALSE(is_blue(image(15, 5)));
}

TEST(Tint, AConstantHeightIsOneColor) {
    for (const float height : {-5.0F, 1234.5F}) {
        const Image image = tinted(test::plane_heightfield(Grid<float>(9, 9, height)));
        for (const Rgba8& pixel : image.samples()) {
            EXPECT_EQ(pixel, image(0, 0));
            EXPECT_NE(pixel, pale);
            EXPECT_GT(pixel.g, 60);
            EXPECT_FALSE(is_blue(pixel)) << "a plain is no lake: " << height;
        }
    }
}

// The issue of stretched colours: a low coast was white with snow.
TEST(Tint, ALowCoastHasNoSnow) {
    const Image image = tinted(test::plane_heightfield(
        test::made_heights(65, 3, [](int col, int) { return 4.0 * col; }), {90.0, 90.0}));
    for (const Rgba8& pixel : image.samples()) {
        EXPECT_LT(pixel.b, pixel.g);
    }
}

// A basin of 20 × 20 level samples in a slope, and a shelf of the same size on it.
TEST(Tint, ALevelBasinIsALakeAndAShelfIsNot) {
    const auto height = [](int col, int row) {
        const bool is_level = col >= 20 && col < 40 && row >= 20 && row < 40;
        return 500.0 + (is_level ? 0.0 : 2.0 + std::abs(col - 30) + std::abs(row - 30));
    };
    const auto shelf = [](int col, int row) {
        const bool is_level = col >= 20 && col < 40 && row >= 20 && row < 40;
        return 500.0 + (is_level ? 30.0 : col);
    };
    const Grid<std::uint8_t> lake =
        water_mask(test::plane_heightfield(test::made_heights(60, 60, height)));
    const Grid<std::uint8_t> none =
        water_mask(test::plane_heightfield(test::made_heights(60, 60, shelf)));
    EXPECT_EQ(std::count(lake.samples().begin(), lake.samples().end(), 1), 20 * 20);
    EXPECT_EQ(lake(30, 30), 1);
    EXPECT_EQ(std::count(none.samples().begin(), none.samples().end(), 1), 0);
}

// A void amid the lake is water, one across its shore is not.
TEST(Tint, AVoidInALakeIsWater) {
    Heightfield heightfield =
        test::plane_heightfield(test::made_heights(60, 60, [](int col, int row) {
            const bool is_level = col >= 20 && col < 40 && row >= 20 && row < 40;
            return 500.0 + (is_level ? 0.0 : 2.0 + std::abs(col - 30) + std::abs(row - 30));
        }));
    heightfield.void_mask = Grid<std::uint8_t>(60, 60, 0);
    for (int row = 28; row < 33; ++row) {
        for (int col = 28; col < 33; ++col) {
            heightfield.void_mask(col, row) = 1;
            heightfield.void_mask(col + 9, row) = 1;
        }
    }
    const Grid<std::uint8_t> water = water_mask(heightfield);
    EXPECT_EQ(water(30, 30), 1);
    EXPECT_EQ(water(25, 30), 1);
    EXPECT_EQ(water(39, 30), 0);
    EXPECT_EQ(std::count(water.samples().begin(), water.samples().end(), 1), 20 * 20 - 3 * 5);
}

TEST(Composite, AnEmptyPictureLeavesWhatIsBeneath) {
    const Image beneath(3, 2, Rgba8{1, 2, 3, 255});
    EXPECT_EQ(composite({}, beneath), beneath);
}

TEST(Composite, BlendsByAlphaAndIsOpaque) {
    Image color(3, 1, Rgba8{200, 100, 50, 255});
    color(1, 0).a = 0;
    color(2, 0).a = 128;
    const Image result = composite(color, Image(3, 1, Rgba8{0, 0, 0, 255}));
    EXPECT_EQ(result(0, 0), (Rgba8{200, 100, 50, 255}));
    EXPECT_EQ(result(1, 0), (Rgba8{0, 0, 0, 255}));
    EXPECT_NEAR(result(2, 0).r, 100, 1);
    EXPECT_EQ(result(2, 0).a, 255);
}

TEST(Composite, LooksUpAnotherResolutionEdgeToEdge) {
    Image beneath(2, 2, Rgba8{0, 0, 0, 255});
    beneath(1, 0) = {255, 255, 255, 255};
    const Image result = composite(Image(9, 9, Rgba8{9, 9, 9, 0}), beneath);
    EXPECT_EQ(result.cols(), 9);
    EXPECT_EQ(result(8, 0).r, 255) << "north-east stays north-east";
    EXPECT_EQ(result(0, 0).r, 0);
    EXPECT_EQ(result(8, 8).r, 0);
}

} // namespace
} // namespace reljef::terrain
