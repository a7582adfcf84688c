#include "engine/truth/separable_filter.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace reljef::truth {
namespace {

std::vector<double> random_kernel(int radius, std::mt19937& random) {
    std::uniform_real_distribution<double> weight(-1.0, 1.0);
    std::vector<double> kernel(2 * static_cast<std::size_t>(radius) + 1);
    for (double& value : kernel) {
        value = weight(random);
    }
    return kernel;
}

Plane random_plane(int cols, int rows, std::mt19937& random) {
    std::uniform_real_distribution<double> value(-10.0, 10.0);
    Plane plane(cols, rows);
    for (double& sample : plane.samples()) {
        sample = value(random);
    }
    return plane;
}

// The definition, weight by weight.
double correlation_at(const Plane& plane, const std::vector<double>& along_cols,
                      const std::vector<double>& along_rows, int col, int row) {
    const int left = col - static_cast<int>(along_cols.size()) / 2;
    const int top = row - static_cast<int>(along_rows.size()) / 2;
    double sum = 0.0;
    for (std::size_t j = 0; j < along_rows.size(); ++j) {
        for (std::size_t i = 0; i < along_cols.size(); ++i) {
            sum += along_cols[i] * along_rows[j] *
                   plane.clamped(left + static_cast<int>(i), top + static_cast<int>(j));
        }
    }
    return sum;
}

TEST(SeparableFilter, IsTheDefinitionAlsoWherePlanesAreSmallerThanKernels) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> sides(1, 14);
    std::uniform_int_distribution<int> radii(0, 9);
    for (int round = 0; round < 300; ++round) {
        const Plane plane = random_plane(sides(random), sides(random), random);
        const auto along_cols = random_kernel(radii(random), random);
        const auto along_rows = random_kernel(radii(random), random);
        const Plane result = filtered(plane, along_cols, along_rows);
        for (int row = 0; row < plane.rows(); ++row) {
            for (int col = 0; col < plane.cols(); ++col) {
                ASSERT_NEAR(result(col, row),
                            correlation_at(plane, along_cols, along_rows, col, row), 1e-11);
            }
        }
    }
}

TEST(SeparableFilter, LooksAheadWithTheLastWeights) {
    Plane spike(5, 5);
    spike(2, 2) = 1.0;
    const std::vector<double> ahead{0.0, 0.0, 1.0};
    const std::vector<double> none{1.0};
    EXPECT_EQ(filtered(spike, ahead, none)(1, 2), 1.0);
    EXPECT_EQ(filtered(spike, none, ahead)(2, 1), 1.0);
}

TEST(SeparableFilter, DoesNotDependOnThreads) {
    std::mt19937 random(2);
    const Plane plane = random_plane(50, 40, random);
    const auto kernel = random_kernel(5, random);
    EXPECT_EQ(filtered(plane, kernel, kernel, 1), filtered(plane, kernel, kernel, 7));
}

TEST(Gaussian, HasItsDeviation) {
    for (const double deviation : {0.8, 1.5, 3.25, 10.0}) {
        std::vector<double> kernel = gaussian(deviation, static_cast<int>(8.0 * deviation) + 1);
        normalize(kernel);
        const int radius = static_cast<int>(kernel.size()) / 2;
        double variance = 0.0;
        double sum = 0.0;
        for (std::size_t k = 0; k < kernel.size(); ++k) {
            const double x = static_cast<double>(k) - radius;
            variance += x * x * kernel[k];
            sum += kernel[k];
        }
        EXPECT_NEAR(sum, 1.0, 1e-14);
        EXPECT_NEAR(std::sqrt(variance), deviation, 1e-4 * deviation);
    }
}

TEST(SeparableFilterDeathTest, KernelsHaveAMiddle) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    const std::vector<double> even{0.5, 0.5};
    const std::vector<double> odd{1.0};
    EXPECT_DEATH(static_cast<void>(filtered(Plane(3, 3), even, odd)), "middle");
    EXPECT_DEATH(static_cast<void>(filtered(Plane(3, 3), odd, even)), "middle");
}

} // namespace
} // namespace reljef::truth
