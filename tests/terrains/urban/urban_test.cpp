#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "terrains/generators.h"
#include "tests/support/release_only.h"

namespace reljef::terrains {
namespace {

terrain::Terrain urban(const GeneratorOptions& options) {
    auto city = generate_urban(options);
    EXPECT_TRUE(city);
    return std::move(*city);
}

// Mean height step between a column (or row) and the one `distance` further on.
double mean_step(const Grid<float>& heights, int from, int to, bool cols) {
    double sum = 0.0;
    const int count = cols ? heights.rows() : heights.cols();
    for (int i = 0; i < count; ++i) {
        sum += cols ? std::abs(heights(from, i) - heights(to, i))
                    : std::abs(heights(i, from) - heights(i, to));
    }
    return sum / count;
}

TEST(Urban, same_seed_same_bits_on_any_number_of_threads) {
    const auto one = urban({.size = 300, .seed = 5, .threads = 1});
    const auto two = urban({.size = 300, .seed = 5, .threads = 2});
    EXPECT_EQ(one.heightfield.heights, two.heightfield.heights);
    EXPECT_EQ(one.color, two.color);
    const auto other = urban({.size = 300, .seed = 6});
    EXPECT_NE(one.heightfield.heights, other.heightfield.heights);
}

TEST(Urban, tile_repeats_without_a_seam) {
    const auto tile = urban({.size = 512, .seed = 1, .tileable = true});
    const Grid<float>& heights = tile.heightfield.heights;
    for (const bool cols : {true, false}) {
        double inside = 0.0;
        for (int i = 0; i + 1 < 512; ++i) {
            inside = std::max(inside, mean_step(heights, i, i + 1, cols));
        }
        EXPECT_LE(mean_step(heights, 511, 0, cols), inside);
    }
}

TEST(Urban, streets_are_level_and_buildings_stand_up) {
    const auto city = urban({.size = 1024, .seed = 1});
    const auto heights = city.heightfield.heights.samples();
    const auto share = [&](auto&& holds) {
        return static_cast<double>(std::count_if(heights.begin(), heights.end(), holds)) /
               static_cast<double>(heights.size());
    };
    EXPECT_TRUE(
        std::all_of(heights.begin(), heights.end(), [](float h) { return std::isfinite(h); }));
    EXPECT_GT(share([](float h) { return h < 0.3F; }), 0.2);
    EXPECT_GT(share([](float h) { return h > 6.0F; }), 0.15);
    EXPECT_LT(city.heightfield.range.high, 150.0);
    EXPECT_EQ(city.color.cols(), 1024);
    const auto colors = city.color.samples();
    EXPECT_TRUE(std::all_of(colors.begin(), colors.end(), [](Rgba8 p) { return p.a == 255; }));
}

TEST(Urban, roofs_are_flat_and_pitched) {
    const auto city = urban({.size = 1024, .seed = 1});
    const Grid<float>& heights = city.heightfield.heights;
    int flat = 0;
    int pitched = 0;
    for (int row = 1; row < 1023; ++row) {
        for (int col = 1; col < 1023; ++col) {
            const float east = heights(col + 1, row) - heights(col, row);
            const float west = heights(col, row) - heights(col - 1, row);
            const float south = heights(col, row + 1) - heights(col, row);
            if (heights(col, row) > 6.0F && std::abs(east - west) < 0.02F) {
                const float slope = std::hypot(east, south) / 0.5F;
                flat += slope < 0.02F ? 1 : 0;
                pitched += slope > 0.3F && slope < 1.5F ? 1 : 0;
            }
        }
    }
    EXPECT_GT(flat, 5000);
    EXPECT_GT(pitched, 5000);
}

TEST(Urban, size_outside_the_range_is_refused) {
    for (const int size : {-1, 0, 15, 4097}) {
        EXPECT_FALSE(generate_urban({.size = size}));
    }
    EXPECT_FALSE(generate_urban({.size = 64, .spacing = -1.0}));
    EXPECT_FALSE(generate_urban({.size = 64, .spacing = std::nan("")}));
}

TEST(Urban, SamplesOnTheEdgeOfALotAreNoHazard) {
    RELJEF_RELEASE_ONLY("thousands of lots by the same few lines");
    EXPECT_TRUE(generate_urban({.size = 1024, .seed = 15}));
    EXPECT_TRUE(generate_urban({.size = 2048, .seed = 7}));
}

TEST(Urban, StopsWhenAsked) {
    std::stop_source source;
    GeneratorOptions options{.size = 1024};
    options.stop = source.get_token();
    options.progress = [&](double) { source.request_stop(); };
    const auto city = generate_urban(options);
    ASSERT_FALSE(city);
    EXPECT_EQ(city.error().message, "urban: generating was stopped");
}

TEST(Natural, StopsWhenAskedAndTellsItsProgress) {
    std::vector<double> parts;
    GeneratorOptions options{.size = 128};
    options.progress = [&](double part) { parts.push_back(part); };
    ASSERT_TRUE(generate_natural(options));
    EXPECT_TRUE(std::is_sorted(parts.begin(), parts.end()));
    EXPECT_EQ(parts.back(), 1.0);
    std::stop_source source;
    options.stop = source.get_token();
    options.progress = [&](double) { source.request_stop(); };
    const auto land = generate_natural(options);
    ASSERT_FALSE(land);
    EXPECT_EQ(land.error().message, "natural: generating was stopped");
}

} // namespace
} // namespace reljef::terrains
