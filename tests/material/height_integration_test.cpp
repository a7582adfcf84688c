#include "engine/material/height_integration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

using test::Chance;

// A sum of waves that a border repeats (wrap) or mirrors about its samples' outer edges (clamp): of
// such a one central differences, and the least squares, know each wave by itself.
struct Waves {
    Grid<float> heights;
    double max_lost = 0.0; // of all amplitudes: sin²(ω/2)
};

Waves random_waves(Chance& chance, material::WrapMode border) {
    const int cols = chance.whole(2, 70);
    const int rows = chance.whole(2, 70);
    Waves waves{Grid<float>(cols, rows), 0.0};
    const double turn =
        border == material::WrapMode::wrap ? 2.0 * std::numbers::pi : std::numbers::pi;
    for (int i = 0; i < 4; ++i) {
        const glm::dvec2 omega(turn * chance.whole(0, cols / 12) / cols,
                               turn * chance.whole(0, rows / 12) / rows);
        const double phase = border == material::WrapMode::wrap ? chance.between(0.0, 6.0) : 0.0;
        const double amplitude = chance.between(0.5, 2.0);
        const double half = std::sin(0.5 * std::max(omega.x, omega.y));
        waves.max_lost += amplitude * half * half;
        for (int row = 0; row < rows; ++row) {
            for (int col = 0; col < cols; ++col) {
                waves.heights(col, row) +=
                    static_cast<float>(amplitude * std::cos(omega.x * (col + 0.5) + phase) *
                                       std::cos(omega.y * (row + 0.5) + phase));
            }
        }
    }
    return waves;
}

double mean_of(const Grid<float>& heights) {
    return std::accumulate(heights.samples().begin(), heights.samples().end(), 0.0) /
           static_cast<double>(heights.size());
}

double greatest_difference(const Grid<float>& a, const Grid<float>& b) {
    const double shift = mean_of(a) - mean_of(b);
    double greatest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        greatest = std::max(greatest,
                            std::abs(static_cast<double>(a.samples()[i]) - b.samples()[i] - shift));
    }
    return greatest;
}

TEST(HeightIntegration, OfASurfacesNormalsGivesTheSurfaceLessItsShortestWaves) {
    Chance chance(1);
    for (const material::WrapMode border : {material::WrapMode::wrap, material::WrapMode::clamp}) {
        for (int i = 0; i < 150; ++i) {
            const Waves waves = random_waves(chance, border);
            const glm::dvec2 spacing{chance.between(0.5, 20.0), chance.between(0.5, 20.0)};
            const auto normals = material::normals_from_heights(
                waves.heights.view(), {.spacing = spacing, .border = border});
            const auto found = material::heights_from_normals(
                normals.view(), {.spacing = spacing, .border = border});
            EXPECT_LE(found.remaining, 1e-8);
            // Normals of floats are good to 2^-23 each; over the map that adds up.
            EXPECT_LE(greatest_difference(found.heights, waves.heights),
                      1.001 * waves.max_lost + 1e-3)
                << waves.heights.cols() << " x " << waves.heights.rows();
        }
    }
}

// The sum of the squared misses of all differences between neighbours.
double misses(const Grid<float>& heights, const Grid<glm::vec3>& normals) {
    double sum = 0.0;
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            const auto rise = [&](int c, int r, int axis) {
                const glm::dvec3 n(normals(c, r));
                return axis == 0 ? -n.x / n.z : n.y / n.z;
            };
            const auto miss = [&](int c, int r, int axis) {
                const double asked = 0.5 * (rise(col, row, axis) + rise(c, r, axis));
                return static_cast<double>(heights(c, r)) - heights(col, row) - asked;
            };
            sum += col + 1 < heights.cols() ? std::pow(miss(col + 1, row, 0), 2.0) : 0.0;
            sum += row + 1 < heights.rows() ? std::pow(miss(col, row + 1, 1), 2.0) : 0.0;
        }
    }
    return sum;
}

TEST(HeightIntegration, OfNormalsOfNoSurfaceNoOtherHeightsComeNearer) {
    Chance chance(2);
    Grid<glm::vec3> normals(23, 17);
    for (glm::vec3& normal : normals.samples()) {
        normal = {chance.between(-0.7, 0.7), chance.between(-0.7, 0.7), 1.0};
    }
    Grid<float> heights = material::heights_from_normals(normals.view()).heights;
    const double least = misses(heights, normals);
    for (int i = 0; i < 300; ++i) {
        float& height = heights(chance.whole(0, 22), chance.whole(0, 16));
        const float before = height;
        height += static_cast<float>(chance.between(-0.1, 0.1));
        EXPECT_GE(misses(heights, normals), least);
        height = before;
    }
}

TEST(HeightIntegration, ItTakesFewRoundsHoweverLargeTheMap) {
    Chance chance(3);
    for (const auto& [cols, rows] : {std::pair{64, 64}, {511, 130}, {300, 301}, {2000, 3}}) {
        Grid<glm::vec3> normals(cols, rows);
        for (glm::vec3& normal : normals.samples()) {
            normal = {chance.between(-0.7, 0.7), chance.between(-0.7, 0.7), 1.0};
        }
        const auto found = material::heights_from_normals(normals.view());
        EXPECT_LE(found.remaining, 1e-8);
        EXPECT_LE(found.rounds, 60) << cols << " x " << rows;
    }
}

TEST(HeightIntegration, ASlopeThatDoesNotCloseIsSpreadOutWhereItWraps) {
    const Grid<glm::vec3> normals(16, 16, glm::vec3(-0.5F, 0.25F, 1.0F));
    const auto wrapped =
        material::heights_from_normals(normals.view(), {.border = material::WrapMode::wrap})
            .heights;
    EXPECT_NEAR(wrapped(3, 4), 0.0F, 1e-6F);
    const auto clamped = material::heights_from_normals(normals.view()).heights;
    EXPECT_NEAR(clamped(15, 0) - clamped(0, 0), 0.5 * 15, 1e-4);
    EXPECT_NEAR(clamped(0, 15) - clamped(0, 0), 0.25 * 15, 1e-4);
}

TEST(HeightIntegration, NormalsThatAreNoneCountAsLevel) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Grid<glm::vec3> normals(9, 9, glm::vec3(0.0F, 0.0F, 1.0F));
    normals(2, 2) = glm::vec3(nan);
    normals(5, 5) = glm::vec3(0.0F);
    normals(7, 7) = glm::vec3(1.0F, 0.0F, -1.0F);
    const auto found = material::heights_from_normals(normals.view());
    for (const float height : found.heights.samples()) {
        EXPECT_EQ(height, 0.0F);
    }
    EXPECT_EQ(material::heights_from_normals(normals.view().window(0, 0, 1, 1)).heights.size(), 1U);
}

} // namespace
} // namespace reljef::terrain
