#include "terrains/natural/erosion.h"

#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace reljef::terrains {
namespace {

constexpr int cols = 61;
constexpr int rows = 47;
constexpr std::size_t cells = std::size_t{cols} * std::size_t{rows};

std::size_t at(std::int32_t cell) {
    return static_cast<std::size_t>(cell);
}

std::vector<float> random_heights(unsigned seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<float> height(0.0F, 100.0F);
    std::vector<float> heights(cells);
    std::generate(heights.begin(), heights.end(), [&] { return height(engine); });
    return heights;
}

std::vector<std::uint8_t> outlets_in(std::initializer_list<std::size_t> places) {
    std::vector<std::uint8_t> outlets(cells, 0);
    for (const std::size_t place : places) {
        outlets[place] = 1;
    }
    return outlets;
}

TEST(FlowRouter, VisitsEveryCellOnceAfterItsReceiver) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        FlowRouter router(cols, rows, seed, 0.45F);
        router.route(random_heights(seed), outlets_in({0, 30, cells - 7}), 2);
        std::vector<int> place(cells, -1);
        ASSERT_EQ(router.drainage().order.size(), cells);
        for (std::size_t i = 0; i < cells; ++i) {
            ASSERT_EQ(place[at(router.drainage().order[i])], -1);
            place[at(router.drainage().order[i])] = static_cast<int>(i);
        }
        for (std::size_t cell = 0; cell < cells; ++cell) {
            ASSERT_LE(place[at(router.drainage().receiver[cell])], place[cell]);
        }
    }
}

TEST(FlowRouter, ReceiversAreNeighboursAndOnlyOutletsDrainToThemselves) {
    const auto outlets = outlets_in({5, cells / 2});
    FlowRouter router(cols, rows, 3, 0.45F);
    router.route(random_heights(3), outlets, 2);
    for (std::int32_t cell = 0; cell < std::int32_t{cells}; ++cell) {
        const std::int32_t receiver = router.drainage().receiver[at(cell)];
        ASSERT_LE(std::abs(receiver % cols - cell % cols), 1);
        ASSERT_LE(std::abs(receiver / cols - cell / cols), 1);
        ASSERT_EQ(receiver == cell, outlets[at(cell)] != 0);
    }
}

TEST(FlowRouter, AllWaterLeavesThroughTheOutlets) {
    FlowRouter router(cols, rows, 4, 0.2F);
    router.route(random_heights(4), outlets_in({0, cells - 1}), 2);
    EXPECT_EQ(router.drainage().area[0] + router.drainage().area[cells - 1],
              static_cast<float>(cells));
}

TEST(FlowRouter, FollowsTheSteepestSlopeOfAPlane) {
    std::vector<float> heights(cells);
    for (std::size_t cell = 0; cell < cells; ++cell) {
        heights[cell] = static_cast<float>(cell % cols);
    }
    std::vector<std::uint8_t> outlets(cells, 0);
    for (std::size_t row = 0; row < rows; ++row) {
        outlets[row * cols] = 1;
    }
    FlowRouter router(cols, rows, 1, 0.0F);
    router.route(heights, outlets, 2);
    for (std::size_t cell = 0; cell < cells; ++cell) {
        if (cell % cols != 0) {
            ASSERT_EQ(router.drainage().receiver[cell], static_cast<std::int32_t>(cell) - 1);
            ASSERT_EQ(router.drainage().distance[cell], 1.0F);
        }
    }
}

TEST(FlowRouter, DepressionDrainsOverItsLowestRim) {
    constexpr int width = 7;
    std::vector<float> heights(width, 0.0F); // one row: outlet, rim, pit, high rim
    heights = {0.0F, 5.0F, 1.0F, 2.0F, 9.0F, 3.0F, 4.0F};
    const std::vector<std::uint8_t> outlets{1, 0, 0, 0, 0, 0, 0};
    FlowRouter router(width, 1, 1, 0.0F);
    router.route(heights, outlets, 2);
    EXPECT_EQ(router.drainage().receiver, (std::vector<std::int32_t>{0, 0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(router.drainage().area, (std::vector<float>{7, 6, 5, 4, 3, 2, 1}));
}

TEST(FlowRouter, SecondRouteForgetsTheFirst) {
    FlowRouter used(cols, rows, 9, 0.3F);
    used.route(random_heights(1), outlets_in({0}), 2);
    used.route(random_heights(2), outlets_in({50}), 2);
    FlowRouter fresh(cols, rows, 9, 0.3F);
    fresh.route(random_heights(2), outlets_in({50}), 2);
    EXPECT_EQ(used.drainage().order, fresh.drainage().order);
    EXPECT_EQ(used.drainage().area, fresh.drainage().area);
}

TEST(Erode, LeavesNoPitAndNoSlopeAboveTheTalus) {
    std::vector<float> heights = random_heights(6);
    FlowRouter router(cols, rows, 6, 0.4F);
    router.route(heights, outlets_in({0}), 2);
    const std::vector<float> uplift(cells, 3.0F);
    const std::vector<float> erodibility(cells, 0.01F);
    const std::vector<float> talus(cells, 0.8F);
    erode(heights, router.drainage(), {uplift, erodibility, talus, 10.0F});
    for (std::size_t cell = 1; cell < cells; ++cell) {
        const float drop = heights[cell] - heights[at(router.drainage().receiver[cell])];
        ASSERT_GT(drop, 0.0F);
        ASSERT_LE(drop, 0.8F * 10.0F * router.drainage().distance[cell] * 1.001F);
    }
}

TEST(Erode, RiverSettlesAtTheSlopeThatBalancesTheUplift) {
    constexpr int length = 200;
    constexpr float spacing = 50.0F;
    std::vector<float> heights(length);
    std::iota(heights.begin(), heights.end(), 0.0F);
    std::vector<std::uint8_t> outlets(length, 0);
    outlets[0] = 1;
    const std::vector<float> uplift(length, 2.0F);
    const std::vector<float> erodibility(length, 0.3F);
    const std::vector<float> talus(length, 100.0F);
    FlowRouter router(length, 1, 1, 0.0F);
    for (int step = 0; step < 500; ++step) {
        router.route(heights, outlets, 2);
        erode(heights, router.drainage(), {uplift, erodibility, talus, spacing});
    }
    for (std::size_t cell = 1; cell < length; ++cell) {
        const float area = static_cast<float>(length) - static_cast<float>(cell);
        const float drop = heights[cell] - heights[cell - 1];
        ASSERT_NEAR(drop, 2.0F / (0.3F * std::sqrt(area)), 0.02F * drop) << "cell " << cell;
    }
}

TEST(Slide, LowersOnlySteepSlopesAndIsTheSameOnAnyNumberOfThreads) {
    Grid<float> heights(40, 30, 100.0F);
    heights(20, 15) = 150.0F;
    heights(5, 5) = 104.0F; // stable under a talus of 0.5 at 10 m
    const std::vector<float> talus(heights.size(), 0.5F);
    Grid<float> two = heights;
    slide(heights, talus, 10.0F, 20, 1);
    slide(two, talus, 10.0F, 20, 2);
    EXPECT_EQ(heights, two);
    EXPECT_EQ(heights(5, 5), 104.0F);
    EXPECT_NEAR(heights(20, 15), 105.0F, 0.1F);
}

} // namespace
} // namespace reljef::terrains
