#include "engine/view/picture/label_picture.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "engine/view/picture/label_strokes.h"

namespace reljef::view {
namespace {

constexpr Rgba8 meadow{90, 120, 60, 255};

TEST(LabelStrokes, CharactersStandSideBySide) {
    const TextStrokes text = text_strokes("-1234567890.5");
    ASSERT_EQ(text.characters.size(), 13U);
    double end = -1.0;
    for (const CharacterStrokes& character : text.characters) {
        EXPECT_GT(character.begin, end);
        EXPECT_GT(character.end, character.begin);
        end = character.end;
        for (const auto& line : character.lines) {
            EXPECT_GE(line.size(), 2U);
            for (const glm::dvec2 point : line) {
                EXPECT_GE(point.x, character.begin - 1e-9);
                EXPECT_LE(point.x, character.end + 1e-9);
                EXPECT_LE(std::abs(point.y), 0.5 + 1e-9);
            }
        }
    }
    EXPECT_EQ(text.width, end);
    EXPECT_EQ(text_strokes("").width, 0.0);
    EXPECT_EQ(text_strokes("x?").characters.size(), 0U);
}

TEST(LabelStrokes, LettersAreNoHigherThanDigits) {
    const TextStrokes text = text_strokes("20 km at N");
    ASSERT_EQ(text.characters.size(), 10U);
    for (const CharacterStrokes& character : text.characters) {
        for (const auto& line : character.lines) {
            for (const glm::dvec2 point : line) {
                EXPECT_GE(point.x, character.begin - 1e-9);
                EXPECT_LE(point.x, character.end + 1e-9);
                EXPECT_LE(std::abs(point.y), 0.5 + 1e-9);
            }
        }
    }
}

// A digit upside down is another one, or itself.
TEST(LabelStrokes, NineIsSixUpsideDown) {
    const auto six = text_strokes("6").characters.front().lines;
    const auto nine = text_strokes("9").characters.front().lines;
    ASSERT_EQ(six.size(), nine.size());
    for (std::size_t i = 0; i < six.front().size(); ++i) {
        EXPECT_NEAR(six.front()[i].x + nine.front()[i].x, 0.56, 1e-12);
        EXPECT_NEAR(six.front()[i].y, -nine.front()[i].y, 1e-12);
    }
}

// Labels change pixels of their area only, wherever they lie and however they turn.
TEST(LabelPicture, StaysInItsArea) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-40.0, 140.0);
    std::uniform_real_distribution<double> angle(-1.57, 1.57);
    constexpr glm::ivec2 size(100, 90);
    for (int i = 0; i < 200; ++i) {
        const double turn = angle(random);
        const ContourLabel label{
            "1250", {place(random), place(random)}, {std::cos(turn), std::sin(turn)}};
        constexpr double digits = 12.0;
        const scene::PicturePart area = label_area(label, digits, size);
        Image whole(size.x, size.y, meadow);
        draw_label(label, digits, whole.view(), {0, 0});
        Image parts(size.x, size.y, meadow);
        if (area.size.x > 0 && area.size.y > 0) {
            draw_label(label, digits,
                       parts.view().window(area.first.x, area.first.y, area.size.x, area.size.y),
                       area.first);
        }
        ASSERT_EQ(whole, parts) << i;
    }
}

TEST(LabelPicture, HasDarkInkWithAPaleBorder) {
    Image picture(60, 30, meadow);
    const ContourLabel label{"1", {30.0, 15.0}};
    draw_label(label, 16.0, picture.view(), {0, 0});
    int dark = 0;
    int pale = 0;
    for (const Rgba8 color : picture.samples()) {
        dark += color.g < 60 ? 1 : 0;
        pale += color.g > 200 ? 1 : 0;
    }
    EXPECT_GT(dark, 12);
    EXPECT_GT(pale, 2 * dark);
    EXPECT_EQ(picture(0, 0), meadow);
}

TEST(LabelPicture, FaintLabelsChangeThePictureLess) {
    const auto change = [](double opacity) {
        Image picture(60, 30, meadow);
        draw_label({"8", {30.0, 15.0}, {1.0, 0.0}, opacity}, 16.0, picture.view(), {0, 0});
        int sum = 0;
        for (const Rgba8 color : picture.samples()) {
            sum += std::abs(color.g - meadow.g);
        }
        return sum;
    };
    EXPECT_EQ(change(0.0), 0);
    EXPECT_LT(change(0.25), change(0.5));
    EXPECT_LT(change(0.5), change(1.0));
}

} // namespace
} // namespace reljef::view
