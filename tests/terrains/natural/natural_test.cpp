#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrains/generators.h"
#include "terrains/natural/natural_land.h"

namespace reljef::terrains {
namespace {

using testing::HasSubstr;

terrain::Terrain made(const GeneratorOptions& options) {
    Result<terrain::Terrain> terrain = generate_natural(options);
    EXPECT_TRUE(terrain.has_value());
    return std::move(terrain).value();
}

std::string refusal_of(const GeneratorOptions& options) {
    const Result<terrain::Terrain> terrain = generate_natural(options);
    return terrain ? "none" : terrain.error().message;
}

/// One land of the usual size, made once.
class NaturalLand : public testing::Test {
protected:
    static constexpr int size = 641;
    static void SetUpTestSuite() {
        land = natural::make_relief({size, 2, 0});
        natural::shape_valleys(land, {size, 2, 0});
        natural::draw_streams(land, {size, 2, 0});
        image = natural::paint_cover(land, {size, 2, 0});
    }
    static void TearDownTestSuite() {
        land = {};
        image = {};
    }
    static float slope(int col, int row) {
        const Grid<float>& heights = land.heights;
        const float x = heights(col + 1, row) - heights(col - 1, row);
        const float y = heights(col, row + 1) - heights(col, row - 1);
        return std::sqrt(x * x + y * y) / (2.0F * natural::design_spacing);
    }
    template <class Visit> static void for_inner(const Visit& visit) {
        for (int row = 8; row < size - 8; ++row) {
            for (int col = 8; col < size - 8; ++col) {
                visit(col, row);
            }
        }
    }
    static natural::Land land;
    static Image image;
};
natural::Land NaturalLand::land;
Image NaturalLand::image;

TEST(Natural, SameSeedGivesTheSameBits) {
    const terrain::Terrain one = made({.size = 129, .seed = 7});
    const terrain::Terrain two = made({.size = 129, .seed = 7});
    EXPECT_EQ(one.heightfield.heights, two.heightfield.heights);
    EXPECT_EQ(one.color, two.color);
}

TEST(Natural, OtherSeedGivesOtherLand) {
    const terrain::Terrain one = made({.size = 129, .seed = 7});
    const terrain::Terrain two = made({.size = 129, .seed = 8});
    EXPECT_NE(one.heightfield.heights, two.heightfield.heights);
    EXPECT_NE(one.color, two.color);
}

TEST(Natural, ThreadCountChangesNothing) {
    const terrain::Terrain one = made({.size = 200, .seed = 3, .threads = 1});
    for (const unsigned threads : {2U, 5U}) {
        const terrain::Terrain more = made({.size = 200, .seed = 3, .threads = threads});
        EXPECT_EQ(one.heightfield.heights, more.heightfield.heights) << threads;
        EXPECT_EQ(one.color, more.color) << threads;
    }
}

TEST(Natural, FillsTheTerrain) {
    for (const int size : {16, 17, 33, 100, 255}) {
        const terrain::Terrain terrain = made({.size = size, .seed = 2});
        const terrain::Heightfield& field = terrain.heightfield;
        EXPECT_EQ(terrain.name, "natural");
        EXPECT_EQ(field.heights.cols(), size);
        EXPECT_EQ(field.heights.rows(), size);
        EXPECT_EQ(terrain.color.cols(), size);
        EXPECT_EQ(terrain.color.rows(), size);
        EXPECT_EQ(field.spacing, glm::dvec2(20.0));
        EXPECT_TRUE(field.void_mask.empty());
        EXPECT_EQ(field.void_count, 0U);
        for (const float height : field.heights.samples()) {
            ASSERT_TRUE(std::isfinite(height));
            ASSERT_GE(static_cast<double>(height), field.range.low);
            ASSERT_LE(static_cast<double>(height), field.range.high);
            ASSERT_GT(height, 250.0F);
            ASSERT_LT(height, 4200.0F);
        }
        for (const Rgba8 color : terrain.color.samples()) {
            ASSERT_EQ(color.a, 255);
        }
    }
}

TEST(Natural, SpacingStretchesTheLandInAllDirections) {
    const terrain::Terrain wide = made({.size = 64, .seed = 2});
    const terrain::Terrain fine = made({.size = 64, .seed = 2, .spacing = 5.0});
    EXPECT_EQ(fine.heightfield.spacing, glm::dvec2(5.0));
    EXPECT_EQ(fine.color, wide.color);
    for (int i = 0; i < 64; ++i) {
        ASSERT_EQ(4.0F * fine.heightfield.heights(i, 9), wide.heightfield.heights(i, 9));
    }
}

TEST(Natural, RefusesASizeOutOfRange) {
    for (const int size :
         {-1, 0, 15, 4097, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
        EXPECT_THAT(refusal_of({.size = size}), HasSubstr(std::to_string(size)));
        EXPECT_THAT(refusal_of({.size = size}), HasSubstr("16 to 4096"));
    }
}

TEST(Natural, RefusesASpacingThatIsNone) {
    for (const double spacing :
         {-1.0, -1.0e-300, 1.0e300, std::numeric_limits<double>::infinity(),
          -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THAT(refusal_of({.size = 64, .spacing = spacing}), HasSubstr("spacing")) << spacing;
    }
}

TEST(Natural, RefusesToTile) {
    EXPECT_THAT(refusal_of({.size = 64, .tileable = true}), HasSubstr("tileable"));
}

TEST_F(NaturalLand, WaterFlowsOut) {
    int pits = 0;
    int dry = 0;
    for_inner([&](int col, int row) {
        if (land.lake(col, row) != 0) {
            return;
        }
        float lowest = std::numeric_limits<float>::max();
        for (int i = 0; i < 9; ++i) {
            if (i != 4) {
                lowest = std::min(lowest, land.heights(col + i % 3 - 1, row + i / 3 - 1));
            }
        }
        ++dry;
        pits += land.heights(col, row) < lowest ? 1 : 0;
    });
    EXPECT_LT(static_cast<double>(pits) / dry, 0.002);
}

TEST_F(NaturalLand, HasSteepRockAndGentleValleys) {
    int steep = 0;
    int gentle = 0;
    int overhanging = 0;
    int all = 0;
    for_inner([&](int col, int row) {
        ++all;
        steep += slope(col, row) > 0.8F ? 1 : 0;
        gentle += slope(col, row) < 0.12F ? 1 : 0;
        overhanging += slope(col, row) > 2.5F ? 1 : 0;
    });
    EXPECT_GT(static_cast<double>(steep) / all, 0.05);
    EXPECT_LT(static_cast<double>(steep) / all, 0.50);
    EXPECT_GT(static_cast<double>(gentle) / all, 0.03);
    EXPECT_LT(static_cast<double>(gentle) / all, 0.40);
    EXPECT_LT(static_cast<double>(overhanging) / all, 0.002);
}

TEST_F(NaturalLand, RiversLieLowerThanTheLandBesideThem) {
    int rivers = 0;
    int lower = 0;
    for_inner([&](int col, int row) {
        if (land.water(col, row) < 0.6F || land.lake(col, row) != 0) {
            return;
        }
        const float around = 0.25F * (land.heights(col - 6, row) + land.heights(col + 6, row) +
                                      land.heights(col, row - 6) + land.heights(col, row + 6));
        ++rivers;
        lower += land.heights(col, row) < around ? 1 : 0;
    });
    ASSERT_GT(rivers, 300);
    EXPECT_GT(static_cast<double>(lower) / rivers, 0.95);
}

TEST_F(NaturalLand, RiversWidenDownstream) {
    double water_small = 0.0;
    double water_large = 0.0;
    int small = 0;
    int large = 0;
    for_inner([&](int col, int row) {
        const auto cell =
            static_cast<std::size_t>(row) * std::size_t{size} + static_cast<std::size_t>(col);
        const float upstream = natural::catchment(land.drainage, cell);
        if (upstream < 2.0F || land.lake(col, row) != 0) {
            return;
        }
        double water = 0.0;
        for (int i = 0; i < 121; ++i) {
            water += static_cast<double>(land.water(std::clamp(col + i % 11 - 5, 0, size - 1),
                                                    std::clamp(row + i / 11 - 5, 0, size - 1)));
        }
        (upstream < 4.0F ? small : large) += upstream < 4.0F || upstream > 25.0F ? 1 : 0;
        (upstream < 4.0F ? water_small : water_large) +=
            upstream < 4.0F || upstream > 25.0F ? water : 0.0;
    });
    ASSERT_GT(small, 100);
    ASSERT_GT(large, 100);
    EXPECT_GT(water_large / large, 1.4 * water_small / small);
}

TEST_F(NaturalLand, LakesAreLevelAndWet) {
    int lake = 0;
    for_inner([&](int col, int row) {
        if (land.lake(col, row) != 0 && land.lake(col + 1, row) != 0) {
            ++lake;
            ASSERT_EQ(land.heights(col, row), land.heights(col + 1, row));
            ASSERT_EQ(land.water(col, row), 1.0F);
        }
    });
    EXPECT_GT(lake, 100);
}

TEST_F(NaturalLand, SnowLiesAboveTheForest) {
    double snow_height = 0.0;
    double forest_height = 0.0;
    int snow = 0;
    int forest = 0;
    for_inner([&](int col, int row) {
        const Rgba8 color = image(col, row);
        const auto height = static_cast<double>(land.heights(col, row));
        if (std::min({color.r, color.g, color.b}) > 185) {
            ++snow;
            snow_height += height;
        } else if (color.g < 75 && color.g > color.b && color.g > color.r) {
            ++forest;
            forest_height += height;
        }
    });
    ASSERT_GT(snow, 500);
    ASSERT_GT(forest, 20000);
    EXPECT_GT(snow_height / snow, forest_height / forest + 800.0);
}

TEST_F(NaturalLand, ColorsAreThoseOfAPhotograph) {
    double sum = 0.0;
    int garish = 0;
    for (const Rgba8 color : image.samples()) {
        const int high = std::max({color.r, color.g, color.b});
        const int low = std::min({color.r, color.g, color.b});
        garish += high - low > 70 ? 1 : 0;
        sum += color.r + color.g + color.b;
    }
    const double mean = sum / (3.0 * static_cast<double>(image.size()));
    EXPECT_GT(mean, 45.0);
    EXPECT_LT(mean, 130.0);
    EXPECT_EQ(garish, 0);
}

} // namespace
} // namespace reljef::terrains
