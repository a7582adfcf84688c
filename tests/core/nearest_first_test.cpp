#include "engine/core/nearest_first.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace reljef {
namespace {

struct Item {
    double distance = 0.0;
    int index = 0;

    friend bool operator==(const Item&, const Item&) = default;
};

std::vector<Item> items_at(const std::vector<double>& distances) {
    std::vector<Item> items(distances.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
        items[i] = {distances[i], static_cast<int>(i)};
    }
    return items;
}

std::vector<Item> stable_order(std::vector<Item> items) {
    std::stable_sort(items.begin(), items.end(),
                     [](const Item& a, const Item& b) { return a.distance < b.distance; });
    return items;
}

TEST(NearestFirst, IsAStableSort) {
    std::mt19937 random(1);
    for (int round = 0; round < 2000; ++round) {
        const double reach = std::exp2(std::uniform_real_distribution(-140.0, 120.0)(random));
        std::vector<double> distances(random() % 100);
        for (double& distance : distances) {
            // Many are equal, and many differ by less than a float tells.
            const double coarse = static_cast<double>(random() % 8) / 8.0;
            distance = reach * (coarse + static_cast<double>(random() % 2) * 1e-12 *
                                             static_cast<double>(random() % 4));
        }
        ASSERT_EQ(nearest_first(items_at(distances)), stable_order(items_at(distances)))
            << "round " << round;
    }
}

TEST(NearestFirst, KeepsTheOrderOfZeroAndInfinity) {
    const double all = std::numeric_limits<double>::infinity();
    const std::vector<double> distances{all, 0.0, 1e300, 5e-324, 0.0, 2e300};
    EXPECT_EQ(nearest_first(items_at(distances)), stable_order(items_at(distances)));
    EXPECT_TRUE(nearest_first(std::vector<Item>()).empty());
}

} // namespace
} // namespace reljef
