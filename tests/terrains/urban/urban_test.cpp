#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
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

// How far the middle height of free walls lies from where the wall is, samples: the largest of 95
// %.
double unevenness(const terrain::Terrain& city, const std::vector<terrain::Facade>& walls) {
    const auto heights = city.heightfield.heights.view();
    std::vector<double> off;
    for (const terrain::Facade& wall : walls) {
        const glm::dvec2 way = wall.end - wall.begin;
        const glm::dvec2 out = glm::normalize(glm::dvec2(way.y, -way.x));
        for (const double part : {0.3, 0.4, 0.5, 0.6, 0.7}) {
            const glm::dvec2 place = wall.begin + part * way;
            const auto height = [&](double away) {
                return terrain::bilinear_height(heights, place + away * out);
            };
            const bool is_inside = glm::all(glm::greaterThan(place, glm::dvec2(4.0))) &&
                                   glm::all(glm::lessThan(place, glm::dvec2(heights.cols() - 5)));
            if (!is_inside || std::abs(height(3.0) - 0.15) > 0.2 ||
                std::abs(height(-3.0) - wall.eaves) > 0.3) {
                continue; // not free, or the roof is not flat
            }
            double away = -3.0;
            while (height(away) > 0.5 * (wall.eaves + 0.15)) {
                away += 0.01;
            }
            off.push_back(std::abs(away));
        }
    }
    EXPECT_GT(off.size(), 200U);
    std::sort(off.begin(), off.end());
    return off.empty() ? 0.0 : off[off.size() * 95 / 100];
}

TEST(Urban, WallsLookStraight) {
    for (const std::uint32_t seed : {1U, 4U}) {
        const auto straight = urban({.size = 700, .seed = seed});
        const auto& walls = straight.facades.walls;
        EXPECT_LT(unevenness(straight, walls), 0.15) << seed;
        const auto stepped =
            urban({.size = 700, .seed = seed, .walls = building::CityWalls::stepped});
        EXPECT_TRUE(stepped.facades.walls.empty());
        EXPECT_GT(unevenness(stepped, walls), 0.4) << "else this test finds nothing";
    }
}

TEST(Urban, CoarseSamplesShowNoWindows) {
    EXPECT_FALSE(urban({.size = 128, .spacing = 1.5}).facades.walls.empty());
    EXPECT_TRUE(urban({.size = 128, .spacing = 2.0}).facades.walls.empty());
}

// What is higher than a wall and its roof hides it.
TEST(Urban, NothingAboveTheirTopsKnowsWalls) {
    const auto city = urban({.size = 700, .seed = 7});
    const terrain::Facades& facades = city.facades;
    for (int row = 0; row < 700; ++row) {
        for (int col = 0; col < 700; ++col) {
            if (const std::uint32_t number = facades.wall_at(col, row); number != 0) {
                const terrain::Facade& wall = facades.walls[number - 1];
                ASSERT_LE(city.heightfield.heights(col, row),
                          wall.foot + wall.eaves + wall.rise + 1.7);
            }
        }
    }
}

TEST(Urban, SamplesNearWallsKnowThem) {
    const auto city = urban({.size = 500, .seed = 2});
    const terrain::Facades& facades = city.facades;
    ASSERT_EQ(facades.wall_at.cols(), 500);
    int near = 0;
    for (int row = 0; row < 500; ++row) {
        for (int col = 0; col < 500; ++col) {
            const std::uint32_t number = facades.wall_at(col, row);
            ASSERT_LE(number, facades.walls.size());
            if (number != 0) {
                const terrain::Facade& wall = facades.walls[number - 1];
                const glm::dvec2 way = glm::normalize(wall.end - wall.begin);
                const glm::dvec2 from = glm::dvec2(col, row) - wall.begin;
                ASSERT_LT(std::abs(way.x * from.y - way.y * from.x), 2.5);
                ++near;
            }
        }
    }
    EXPECT_GT(near, 10000);
    const auto again = urban({.size = 500, .seed = 2, .threads = 1});
    EXPECT_EQ(again.facades.wall_at, facades.wall_at);
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
