#include "engine/view/picture/picture_marks.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include "engine/view/picture/scale_bar.h"

namespace reljef::view {
namespace {

constexpr Rgba8 grass_color{90, 120, 60, 255};
constexpr glm::ivec2 usual(640, 480);

PictureMarks all_marks() {
    PictureMarks marks;
    marks.legend = {
        {0.0, {0, 90, 0, 255}}, {500.0, {200, 180, 90, 255}}, {1000.0, {250, 250, 255, 255}}};
    marks.scale = {12.5, false};
    marks.north = 30.0;
    return marks;
}

Image drawn(const PictureMarks& marks, glm::ivec2 size = usual) {
    Image picture(size.x, size.y, grass_color);
    draw_marks(marks, size, picture.view());
    return picture;
}

bool is_ink(Rgba8 color) {
    return color.r < 60 && color.g < 60 && color.b < 60;
}

// Of dark pixels; empty: `low` is beyond `high`.
struct InkBox {
    glm::ivec2 low{1 << 20};
    glm::ivec2 high{-1};
};

InkBox ink_of(const Image& picture, glm::ivec2 low, glm::ivec2 high) {
    InkBox box;
    for (int row = low.y; row < high.y; ++row) {
        for (int col = low.x; col < high.x; ++col) {
            if (is_ink(picture(col, row))) {
                box.low = glm::min(box.low, glm::ivec2(col, row));
                box.high = glm::max(box.high, glm::ivec2(col, row));
            }
        }
    }
    return box;
}

TEST(PictureMarks, WithoutAnyThePictureStays) {
    EXPECT_EQ(drawn({}), Image(usual.x, usual.y, grass_color));
    EXPECT_TRUE(PictureMarks().empty());
    EXPECT_FALSE(all_marks().empty());
}

// The ticks at the ends of the bar are as far apart as the length at the scale.
TEST(PictureMarks, TheBarIsAsLongAsItSays) {
    for (const double metres_per_pixel : {0.031, 1.0, 7.7, 123.0, 9000.0}) {
        PictureMarks marks;
        marks.scale = {metres_per_pixel, true};
        const Image picture = drawn(marks);
        const ScaleBar bar = scale_bar(metres_per_pixel, max_scale_bar(usual));
        const glm::dvec2 begin = begin_of_scale_bar(usual);
        const int row = static_cast<int>(begin.y); // along the bar
        const InkBox ink = ink_of(picture, {0, row}, {usual.x, row + 1});
        const double length = ink.high.x - ink.low.x; // between the middles of both ticks
        EXPECT_NEAR(length, bar.pixels, 1.0) << metres_per_pixel;
        EXPECT_NEAR(0.5 * (ink.low.x + ink.high.x + 1), begin.x + 0.5 * bar.pixels, 1.0);
    }
}

// But for the mark in the middle.
TEST(PictureMarks, LieOnPalePlates) {
    for (const glm::ivec2 size : {usual, min_marked_picture, glm::ivec2(1920, 400)}) {
        PictureMarks marks = all_marks();
        marks.scale->is_everywhere = true;
        const Image picture = drawn(marks, size);
        const auto plates = mark_plates(marks, size);
        ASSERT_EQ(plates.size(), 3U);
        Grid<int> plates_at(size.x, size.y, 0);
        for (const scene::PicturePart& plate : plates) {
            for (int row = plate.first.y; row < plate.first.y + plate.size.y; ++row) {
                for (int col = plate.first.x; col < plate.first.x + plate.size.x; ++col) {
                    ++plates_at(col, row);
                }
            }
            const glm::ivec2 corner = plate.first + plate.size - 1;
            EXPECT_GT(picture(corner.x, corner.y).r, grass_color.r + 40) << "pale";
            EXPECT_LT(picture(corner.x, corner.y).r, 240) << "half-transparent";
        }
        for (int row = 0; row < size.y; ++row) {
            for (int col = 0; col < size.x; ++col) {
                ASSERT_TRUE(plates_at(col, row) <= 1 || size == min_marked_picture);
                ASSERT_EQ(picture(col, row) == grass_color, plates_at(col, row) == 0)
                    << col << ", " << row;
            }
        }
    }
}

TEST(PictureMarks, WhereTheScaleHoldsInTheMiddleOnlyTheMiddleIsMarked) {
    PictureMarks marks;
    marks.scale = {3.0, true};
    const glm::ivec2 around = usual / 2 - 20;
    EXPECT_LT(ink_of(drawn(marks), around, around + 40).high.x, 0);
    marks.scale->is_everywhere = false;
    const InkBox ink = ink_of(drawn(marks), around, around + 40);
    EXPECT_NEAR(0.5 * (ink.low.x + ink.high.x + 1), 0.5 * usual.x, 1.0);
    EXPECT_NEAR(0.5 * (ink.low.y + ink.high.y + 1), 0.5 * usual.y, 1.0);
}

// The longest run of rows whose colours are those of the stops, from low to high.
TEST(PictureMarks, TheLegendGoesUpThroughAllColours) {
    PictureMarks marks;
    marks.legend = all_marks().legend;
    const Image picture = drawn(marks);
    std::vector<int> found;
    for (const LegendStop& stop : marks.legend) {
        int first = -1;
        for (int row = usual.y - 1; row >= 0 && first < 0; --row) {
            for (int col = usual.x / 2; col < usual.x && first < 0; ++col) {
                const Rgba8 color = picture(col, row);
                const bool is_stop = std::abs(color.r - stop.color.r) <= 3 &&
                                     std::abs(color.g - stop.color.g) <= 3 &&
                                     std::abs(color.b - stop.color.b) <= 3;
                first = is_stop ? row : first;
            }
        }
        ASSERT_GE(first, 0) << stop.height;
        found.push_back(first);
    }
    EXPECT_GT(found[0], found[1]);
    EXPECT_GT(found[1], found[2]);
    EXPECT_NEAR(found[1], 0.5 * (found[0] + found[2]), 3.0);
}

TEST(PictureMarks, LegendsOfAnyRangeHaveLabels) {
    for (const auto& [low, high] :
         {std::pair(-11000.0, 8848.0), std::pair(1.0, 1.001), std::pair(-3.0, -1.0),
          std::pair(8000.0, 8300.0), std::pair(0.0, 1e6)}) {
        PictureMarks marks;
        marks.legend = {{low, {200, 0, 0, 255}}, {high, {0, 0, 200, 255}}};
        const Image picture = drawn(marks);
        const InkBox ink = ink_of(picture, {usual.x - 60, 0}, usual);
        EXPECT_GE(ink.high.x, 0) << low;
        EXPECT_LT(ink.high.x, usual.x - 4);
    }
}

TEST(PictureMarks, TheArrowPointsNorth) {
    const glm::ivec2 corner(usual.x - 130, 0);
    const glm::ivec2 end(usual.x, 130);
    PictureMarks marks;
    marks.north = 0.0;
    const InkBox up = ink_of(drawn(marks), corner, end);
    EXPECT_GT(up.high.y - up.low.y, 1.5 * (up.high.x - up.low.x));
    marks.north = 90.0;
    const InkBox right = ink_of(drawn(marks), corner, end);
    EXPECT_GT(right.high.x - right.low.x, 1.5 * (right.high.y - right.low.y));
    EXPECT_GT(right.high.x, up.high.x); // with the letter beyond the tip
}

// Parts of any sizes are those of the whole, bit for bit.
TEST(PictureMarks, PartsContinueEachOther) {
    const PictureMarks marks = all_marks();
    const Image whole = drawn(marks);
    Image parts(usual.x, usual.y, grass_color);
    for (int row = 0; row < usual.y; row += 37) {
        for (int col = 0; col < usual.x; col += 101) {
            const glm::ivec2 size = glm::min(usual - glm::ivec2(col, row), glm::ivec2(101, 37));
            draw_marks(marks, usual, parts.view().window(col, row, size.x, size.y), {col, row});
        }
    }
    EXPECT_EQ(parts, whole);
}

// Marks fit the smallest picture and any shape, and do not touch its border.
TEST(PictureMarks, LieWithinPicturesOfAnyShape) {
    for (const glm::ivec2 size : {min_marked_picture, glm::ivec2(160, 900), glm::ivec2(1600, 120),
                                  glm::ivec2(3000, 2000)}) {
        PictureMarks marks = all_marks();
        marks.north = 225.0;
        const Image picture = drawn(marks, size);
        for (int col = 0; col < size.x; ++col) {
            EXPECT_EQ(picture(col, 0), grass_color);
            EXPECT_EQ(picture(col, size.y - 1), grass_color);
        }
        for (int row = 0; row < size.y; ++row) {
            EXPECT_EQ(picture(0, row), grass_color);
            EXPECT_EQ(picture(size.x - 1, row), grass_color);
        }
    }
}

TEST(ScaleBar, TextsAreRound) {
    EXPECT_EQ(bar_text(500.0), "500 m");
    EXPECT_EQ(bar_text(1000.0), "1 km");
    EXPECT_EQ(bar_text(2e5), "200 km");
    EXPECT_EQ(bar_text(0.05), "0.05 m");
    EXPECT_EQ(bar_text(scale_bar(3.7, 100.0).metres), "200 m");
    EXPECT_EQ(text_of_multiple(-0.1 * 2.0 + 0.2, 0.1), "0.0");
    EXPECT_EQ(text_of_multiple(1500.0, 500.0), "1500");
}

TEST(ScaleBar, StepsAreRoundAndNotSmaller) {
    for (double min = 1e-4; min < 1e5; min *= 1.31) {
        const double step = round_step(min);
        EXPECT_GE(step, min * (1.0 - 1e-8));
        EXPECT_LT(step, 2.5 * min * (1.0 + 1e-8));
    }
    EXPECT_EQ(round_step(200.0), 200.0);
}

} // namespace
} // namespace reljef::view
