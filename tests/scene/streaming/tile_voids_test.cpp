#include "engine/scene/streaming/tile_voids.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include "engine/terrain/field/heightfield.h"

namespace reljef::scene {
namespace {

constexpr int tile_side = 67; // 64 cells, and one step around
constexpr float no_height = std::numeric_limits<float>::quiet_NaN();

float height_on_slope(int col, int row) {
    return 900.0F + 12.0F * static_cast<float>(col) - 7.0F * static_cast<float>(row);
}

// From a sample of the raster on; the overview is 150 m too low.
Grid<float> slope_from(int first_col, float below = 0.0F) {
    Grid<float> heights(tile_side, tile_side);
    for (int row = 0; row < tile_side; ++row) {
        for (int col = 0; col < tile_side; ++col) {
            heights(col, row) = height_on_slope(first_col + col, row) - below;
        }
    }
    return heights;
}

void open_void(Grid<float>& heights, int first_col, int from, int to) {
    for (int row = 20; row < 50; ++row) {
        for (int col = 0; col < tile_side; ++col) {
            if (first_col + col >= from && first_col + col < to) {
                heights(col, row) = no_height;
            }
        }
    }
}

// The overview is an average: voids that took its heights had cliffs around them.
TEST(TileVoids, HaveNoStepsAtTheHeightsAroundThem) {
    Grid<float> heights = slope_from(0);
    open_void(heights, 0, 15, 45);
    const FilledHeights filled = fill_tile_voids(std::move(heights), slope_from(0, 150.0F), 4.0);
    for (int row = 0; row < tile_side; ++row) {
        for (int col = 0; col < tile_side; ++col) {
            ASSERT_NEAR(filled.heights(col, row), height_on_slope(col, row), 1.0)
                << col << ' ' << row;
        }
    }
    EXPECT_EQ(filled.was_void(15, 20), 1);
    EXPECT_EQ(filled.was_void(14, 20), 0);
}

TEST(TileVoids, NeighboursAgreeOnTheBorderBetweenThem) {
    Grid<float> west = slope_from(0);
    Grid<float> east = slope_from(64);
    open_void(west, 0, 40, 90);
    open_void(east, 64, 40, 90);
    const Grid<float> of_west = fill_tile_voids(west, slope_from(0, 150.0F), 4.0).heights;
    const Grid<float> of_east = fill_tile_voids(east, slope_from(64, 150.0F), 4.0).heights;
    for (int row = 1; row + 1 < tile_side; ++row) {
        ASSERT_EQ(of_west(65, row), of_east(1, row)) << row;
    }
}

TEST(TileVoids, StayBetweenKnownAndCoarseHeights) {
    Grid<float> heights(tile_side, tile_side, 500.0F);
    open_void(heights, 0, 10, 60);
    heights(5, 30) = 900.0F;
    Grid<float> coarse(tile_side, tile_side, 400.0F);
    coarse(30, 30) = 880.0F;
    const FilledHeights filled = fill_tile_voids(std::move(heights), coarse, 4.0);
    for (const float height : filled.heights.samples()) {
        ASSERT_GE(height, 400.0F);
        ASSERT_LE(height, 900.0F);
    }
}

TEST(TileVoids, ATileWithoutAnyHeightIsTheOverview) {
    const Grid<float> coarse = slope_from(0);
    EXPECT_EQ(fill_tile_voids(Grid<float>(tile_side, tile_side, no_height), coarse, 4.0).heights,
              coarse);
}

// Four tiles around a void, over an overview of 8 samples to one, beside the same in memory.
struct CornerVoid {
    static constexpr int side = 131; // two tiles of 64 cells, and one step around
    static constexpr int reduction = 8;

    Grid<float> known{side, side, 0.0F};
    Grid<std::uint8_t> voids{side, side};
    Grid<float> in_memory;
    Grid<float> coarse{side, side, 0.0F};

    CornerVoid() {
        for (int row = 0; row < side; ++row) {
            for (int col = 0; col < side; ++col) {
                known(col, row) = rough(col, row);
                voids(col, row) = std::hypot(col - 65, row - 65) < 24.0 ? 1 : 0;
            }
        }
        in_memory = known;
        terrain::fill_voids(in_memory, voids);
        fill_coarse();
    }
    // Waves of 3 to 40 samples.
    static float rough(double col, double row) {
        double height = 800.0 + 2.0 * col + row;
        for (int i = 0; i < 40; ++i) {
            const double turn = 2.4 * i;
            const double wave = 3.0 * std::pow(13.0, i / 39.0);
            height += 0.6 * wave *
                      std::sin((std::cos(turn) * col + std::sin(turn) * row) * 6.2832 / wave + i);
        }
        return static_cast<float>(height);
    }
    // The mean of a block without voids.
    [[nodiscard]] std::optional<float> mean_of(glm::ivec2 block) const {
        float sum = 0.0F;
        int count = 0;
        for (int i = 0; i < reduction * reduction; ++i) {
            const glm::ivec2 at = block * reduction + glm::ivec2(i % reduction, i / reduction);
            const bool is_known = at.x < side && at.y < side && voids(at.x, at.y) == 0;
            sum += is_known ? known(at.x, at.y) : 0.0F;
            count += is_known ? 1 : 0;
        }
        return count > 0 ? std::optional(sum / static_cast<float>(count)) : std::nullopt;
    }
    void fill_coarse() {
        constexpr int blocks = (side + reduction - 1) / reduction;
        Grid<float> overview(blocks, blocks, 0.0F);
        Grid<std::uint8_t> unknown(blocks, blocks);
        for (int row = 0; row < blocks; ++row) {
            for (int col = 0; col < blocks; ++col) {
                const auto mean = mean_of({col, row});
                unknown(col, row) = mean ? 0 : 1;
                overview(col, row) = mean.value_or(0.0F);
            }
        }
        terrain::fill_voids(overview, unknown);
        for (int row = 0; row < side; ++row) {
            for (int col = 0; col < side; ++col) {
                const glm::dvec2 at = (glm::dvec2(col, row) - 3.5) / double{reduction};
                coarse(col, row) =
                    static_cast<float>(terrain::bilinear_height(overview.view(), at));
            }
        }
    }
    // Root mean square of the differences from the heights in memory, metres.
    [[nodiscard]] double difference() const {
        double sum = 0.0;
        int count = 0;
        for (const glm::ivec2 first :
             {glm::ivec2(0, 0), glm::ivec2(64, 0), glm::ivec2(0, 64), glm::ivec2(64, 64)}) {
            Grid<float> heights(tile_side, tile_side);
            Grid<float> below(tile_side, tile_side);
            for (int row = 0; row < tile_side; ++row) {
                for (int col = 0; col < tile_side; ++col) {
                    const glm::ivec2 at = first + glm::ivec2(col, row);
                    heights(col, row) = voids(at.x, at.y) != 0 ? no_height : known(at.x, at.y);
                    below(col, row) = coarse(at.x, at.y);
                }
            }
            const FilledHeights filled = fill_tile_voids(std::move(heights), below, reduction);
            for (int row = 1; row + 1 < tile_side; ++row) {
                for (int col = 1; col + 1 < tile_side; ++col) {
                    const glm::ivec2 at = first + glm::ivec2(col, row);
                    const double off = filled.heights(col, row) - in_memory(at.x, at.y);
                    sum += off * off;
                    count += voids(at.x, at.y);
                }
            }
        }
        return std::sqrt(sum / count);
    }
};

TEST(TileVoids, AtACornerOfTilesLookAsInMemory) {
    const CornerVoid made;
    EXPECT_LT(made.difference(), 10.0); // of hills of 60 m; the overview alone is 17 m off
}

} // namespace
} // namespace reljef::scene
