#include "app/viewer/panels/toolkit/panel_rasterizer.h"

#include <array>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace reljef::app {
namespace {

constexpr Rgba8 ground{10, 20, 30, 255};
constexpr int side = 64;

// What a list of ImGui has, with an atlas whose first texel is opaque.
class RasterizerTest : public testing::Test {
protected:
    void add_triangle(const std::array<ImVec2, 3>& places, ImU32 color) {
        for (const ImVec2& place : places) {
            indices_.push_back(static_cast<ImDrawIdx>(vertices_.size()));
            vertices_.push_back({place, {0.0F, 0.0F}, color});
        }
    }
    // As ImGui makes areas and letters: two triangles of four corners.
    void add_rectangle(ImVec2 low, ImVec2 high, ImU32 color, ImVec2 uv_low = {0.0F, 0.0F},
                       ImVec2 uv_high = {0.0F, 0.0F}) {
        const auto first = static_cast<ImDrawIdx>(vertices_.size());
        vertices_.push_back({low, uv_low, color});
        vertices_.push_back({{high.x, low.y}, {uv_high.x, uv_low.y}, color});
        vertices_.push_back({high, uv_high, color});
        vertices_.push_back({{low.x, high.y}, {uv_low.x, uv_high.y}, color});
        for (const int corner : {0, 1, 2, 0, 2, 3}) {
            indices_.push_back(static_cast<ImDrawIdx>(first + corner));
        }
    }

    [[nodiscard]] Image drawn(const PixelArea& area = {{0, 0}, {side, side}}) {
        ImDrawCmd command;
        command.ClipRect = clip_;
        command.ElemCount = static_cast<unsigned int>(indices_.size());
        ImDrawList list(nullptr);
        list.CmdBuffer.push_back(command);
        for (const ImDrawVert& vertex : vertices_) {
            list.VtxBuffer.push_back(vertex);
        }
        for (const ImDrawIdx index : indices_) {
            list.IdxBuffer.push_back(index);
        }
        std::array<ImDrawList*, 1> lists{&list};
        ImDrawData data;
        data.CmdLists = lists.data();
        data.CmdListsCount = 1;
        Image picture(side, side, ground);
        rasterize(data, {letters_.data(), 4, 4, 4}, area, picture);
        return picture;
    }

    std::vector<ImDrawVert> vertices_;
    std::vector<ImDrawIdx> indices_;
    ImVec4 clip_{0.0F, 0.0F, side, side};
    std::array<std::uint8_t, 16> letters_{255, 0, 51, 102, //
                                          0,   0, 0,  0,   //
                                          153, 0, 0,  0,   //
                                          0,   0, 0,  255};
};

TEST_F(RasterizerTest, ARectangleHasThePixelsWithTheirCentresInIt) {
    add_rectangle({2.5F, 3.4F}, {5.5F, 6.6F}, IM_COL32(200, 100, 50, 255));
    const Image picture = drawn();
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const bool is_inside = x >= 2 && x < 5 && y >= 3 && y < 7;
            ASSERT_EQ(picture(x, y), (is_inside ? Rgba8{200, 100, 50, 255} : ground))
                << x << ' ' << y;
        }
    }
}

// As OpenGL has it, whose first row is at the bottom.
TEST_F(RasterizerTest, CentresOnABorderBelongToWhatIsRightOfItOrAbove) {
    add_rectangle({2.5F, 3.5F}, {5.5F, 6.5F}, IM_COL32_WHITE);
    add_triangle({ImVec2{20.5F, 20.5F}, {40.5F, 20.5F}, {20.5F, 40.5F}}, IM_COL32_WHITE);
    const Image picture = drawn();
    for (int row = 0; row < 8; ++row) {
        EXPECT_EQ(picture(3, row) != ground, row >= 4 && row <= 6) << row;
        EXPECT_EQ(picture(row, 5) != ground, row >= 2 && row <= 4) << row;
    }
    EXPECT_EQ(picture(22, 20), ground);
    EXPECT_NE(picture(22, 21), ground);
    EXPECT_NE(picture(20, 25), ground);
}

// A pixel drawn twice would be darker, one left out lighter.
TEST_F(RasterizerTest, TrianglesOfACommonEdgeDrawEachPixelOnce) {
    std::mt19937 random(3);
    std::uniform_int_distribution<int> halves(1, 2 * side - 1); // also places on centres
    for (int fan = 0; fan < 200; ++fan) {
        vertices_.clear();
        indices_.clear();
        const ImVec2 middle{0.5F * static_cast<float>(halves(random)),
                            0.5F * static_cast<float>(halves(random))};
        const std::array<ImVec2, 4> corners{ImVec2{0.0F, 0.0F}, ImVec2{side, 0.0F},
                                            ImVec2{side, side}, ImVec2{0.0F, side}};
        for (std::size_t i = 0; i < corners.size(); ++i) {
            add_triangle({middle, corners.at(i), corners.at((i + 1) % 4)},
                         IM_COL32(255, 255, 255, 51));
        }
        const Image picture = drawn();
        for (const Rgba8 pixel : picture.samples()) {
            ASSERT_EQ(pixel, (Rgba8{59, 67, 75, 255})) << middle.x << ' ' << middle.y;
        }
    }
}

TEST_F(RasterizerTest, BothOrdersOfATrianglesCornersAreShown) {
    add_triangle({ImVec2{0.0F, 0.0F}, {0.0F, 20.0F}, {20.0F, 0.0F}}, IM_COL32_WHITE);
    add_triangle({ImVec2{30.0F, 30.0F}, {50.0F, 30.0F}, {30.0F, 50.0F}}, IM_COL32_WHITE);
    const Image picture = drawn();
    EXPECT_EQ(picture(5, 5), (Rgba8{255, 255, 255, 255}));
    EXPECT_EQ(picture(35, 35), (Rgba8{255, 255, 255, 255}));
    EXPECT_EQ(picture(15, 15), ground);
}

TEST_F(RasterizerTest, ColoursAreBlendedAlongATriangle) {
    add_triangle({ImVec2{0.0F, 0.0F}, {64.0F, 0.0F}, {0.0F, 64.0F}}, IM_COL32(255, 255, 255, 0));
    vertices_[1].col = IM_COL32_WHITE; // opaque at the right
    const Image picture = drawn();
    for (int x = 0; x < side - 1; ++x) {
        const double alpha = (x + 0.5) / side;
        EXPECT_NEAR(picture(x, 0).r, 255.0 * alpha + 10.0 * (1.0 - alpha), 1.0) << x;
    }
}

TEST_F(RasterizerTest, LettersHaveTheAlphaOfTheAtlas) {
    add_rectangle({8.0F, 8.0F}, {12.0F, 12.0F}, IM_COL32(255, 255, 255, 255), {0.0F, 0.0F},
                  {1.0F, 1.0F});
    const Image picture = drawn();
    EXPECT_EQ(picture(8, 8).r, 255);
    EXPECT_EQ(picture(9, 8).r, 10);
    EXPECT_EQ(picture(10, 8).r, 59);  // a fifth
    EXPECT_EQ(picture(11, 8).r, 108); // two fifths
    EXPECT_EQ(picture(8, 10).r, 157);
    EXPECT_EQ(picture(11, 11).r, 255);
    EXPECT_EQ(picture(12, 11).r, 10);
}

TEST_F(RasterizerTest, NothingIsDrawnOutsideOfTheAreaAndTheClipRectangle) {
    clip_ = {0.0F, 0.0F, 30.0F, 64.0F};
    add_rectangle({-100.0F, -100.0F}, {1000.0F, 1000.0F}, IM_COL32_WHITE);
    add_triangle({ImVec2{-1e6F, -1e6F}, {1e6F, -1e6F}, {0.0F, 1e6F}}, IM_COL32(255, 0, 0, 255));
    const Image picture = drawn({{20, 10}, {40, 5}});
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const bool is_inside = x >= 20 && x < 30 && y >= 10 && y < 15;
            ASSERT_EQ(picture(x, y), (is_inside ? Rgba8{255, 0, 0, 255} : ground)) << x << ' ' << y;
        }
    }
}

TEST_F(RasterizerTest, DegenerateTrianglesAndTextureCoordinatesBeyondTheAtlasAreHarmless) {
    add_triangle({ImVec2{5.0F, 5.0F}, {5.0F, 5.0F}, {40.0F, 5.0F}}, IM_COL32_WHITE);
    add_triangle({ImVec2{5.0F, 5.0F}, {15.0F, 15.0F}, {25.0F, 25.0F}}, IM_COL32_WHITE);
    const Image nothing = drawn();
    EXPECT_EQ(nothing, Image(side, side, ground));
    add_rectangle({0.0F, 0.0F}, {4.0F, 4.0F}, IM_COL32_WHITE, {-3.0F, -3.0F}, {9.0F, 9.0F});
    EXPECT_EQ(drawn()(3, 3).r, 255); // the last texel
}

// In floats such a triangle may have no area, or another one.
TEST_F(RasterizerTest, SliversHaveColorsBetweenThoseOfTheirCorners) {
    std::mt19937 random(7); // NOLINT(cert-msc32-c,cert-msc51-cpp): the same slivers each time
    std::uniform_real_distribution<float> place(-800.0F, 800.0F);
    std::uniform_real_distribution<float> share(0.3F, 0.7F);
    std::uniform_int_distribution<int> step(-2, 2);
    constexpr int max_red = 200;
    constexpr int max_green = 100;
    for (int round = 0; round < 5000; ++round) {
        const ImVec2 begin(place(random), place(random));
        const ImVec2 end(64.0F - begin.x, 64.0F - begin.y); // through the picture
        const float part = share(random);
        const float off = static_cast<float>(step(random)) / 256.0F;
        add_triangle(
            {begin,
             end,
             {begin.x + part * (end.x - begin.x) + off, begin.y + part * (end.y - begin.y) - off}},
            IM_COL32(max_red, 0, 0, 255));
        vertices_.back().col = IM_COL32(0, max_green, 0, 255);
        const Image picture = drawn();
        for (const Rgba8 pixel : picture.samples()) {
            if (pixel != ground) {
                ASSERT_LE(pixel.r, max_red) << round;
                ASSERT_LE(pixel.g, max_green) << round;
                ASSERT_EQ(pixel.b, 0) << round;
            }
        }
        vertices_.clear();
        indices_.clear();
    }
}

TEST_F(RasterizerTest, PlacesBeyondAllPicturesAreCut) {
    constexpr float far = 3e7F;
    add_triangle({ImVec2(-far, 10.0F), {far, 10.004F}, {far, 12.0F}}, IM_COL32_WHITE);
    add_triangle({ImVec2(-far, -far), {far, -far}, {0.0F, far}}, IM_COL32(0, 0, 0, 0));
    EXPECT_EQ(drawn()(0, 0), ground);
}

} // namespace
} // namespace reljef::app
